#pragma once

#include "scripted_server.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/coordinator/coordinator.h>
#include <tether/sim_testing/fake_simulator.h>

namespace tether::coordinator {

inline constexpr std::uint32_t kCamera = 0, kImu = 1, kRange = 2;
inline constexpr uav::PeriodicTiming kCameraTiming{
    std::chrono::milliseconds(33), Duration(0),
    uav::ConstantDelay{std::chrono::microseconds(10'400)}};
inline constexpr uav::PeriodicTiming kImuTiming{std::chrono::milliseconds(50), Duration(0),
                                                uav::ConstantDelay{Duration(0)}};
inline constexpr uav::OnDemandTiming kRangeTiming{
    uav::ConstantDelay{std::chrono::microseconds(97'700)}};

inline ExecTime us(std::int64_t value) {
  return ExecTime(std::chrono::microseconds(value));
}
inline SimTime st_ms(std::int64_t value) {
  return SimTime(std::chrono::milliseconds(value));
}

inline link::Hello hello(const std::string& uav = "",
                         computer::ClockKind clock = computer::ClockKind::kScripted) {
  link::Hello h;
  h.sut = "script";
  h.uav = uav;
  h.clock.kind = clock;
  h.token = "secret";
  return h;
}

inline link::Request request(std::uint64_t sequence, ExecTime at,
                             decltype(link::Request::body) body) {
  return {.sequence = sequence, .issued_at = at, .body = std::move(body)};
}
inline Act read(Duration compute, std::uint32_t sensor, bool latest = false) {
  return {compute, link::ReadSensor{sensor, latest}};
}
inline Act turn(Duration compute, double yaw_rate_rad_s) {
  return {compute, link::SetVelocity{{.velocity_H_m_s = {}, .yaw_rate_rad_s = yaw_rate_rad_s}}};
}
inline Act sleep(Duration compute, Duration duration) {
  return {compute, duration};
}
inline Act send(Duration compute, std::string to = "", std::size_t bytes = 10) {
  return {compute, link::SendMessage{std::move(to), std::vector<std::uint8_t>(bytes, 7)}};
}
inline Act receive(Duration compute, Duration timeout, std::uint32_t most = 1) {
  return {compute, link::ReceiveMessage{timeout, {}, most}};
}
inline Act finish(Duration compute) {
  return {compute, link::Finish{true, "done", "{}"}};
}

/// Everything in a record that must not depend on wall time. The arrival of a concurrent SUT's
/// requests may.
inline std::string without_wall(const MemoryRecorder& recorder) {
  std::string text;
  const bool concurrent = recorder.header.suts.at(0).concurrent;
  for (const auto& i : recorder.interactions) {
    text += std::to_string(i.sequence) + ":" + i.sensor;
    for (const std::int64_t v :
         {to_ns(i.request_at), to_ns(i.reply_at), concurrent ? 0 : to_ns(i.st_at_arrival),
          to_ns(i.st_at_release), to_ns(i.sample_state_at.value_or(SimTime::min())),
          to_ns(i.effect_at.value_or(SimTime::min())), static_cast<std::int64_t>(i.sample_index)})
      text += " " + std::to_string(v);
  }
  for (const auto& stop : recorder.stops)
    text += "\n" + std::to_string(to_ns(stop.at)) + " " +
            std::to_string(to_ns(stop.reply_at.value_or(ExecTime::min())));
  for (const auto& g : recorder.ground_truth)
    text += "\n" + std::to_string(g.p_WB_m[0]) + " " + std::to_string(to_ns(g.at));
  return text;
}

/// A coordinator over a fake simulator of `uavs` UAVs, with a clock that advances by `tick_` per
/// reading.
class CoordinatorTest : public testing::Test {
 protected:
  void make(std::size_t uavs = 1, Duration step = std::chrono::milliseconds(1)) {
    make(sim::make_fake_world(uavs, step));
  }
  void make(sim::World world) {
    const std::size_t uavs = world.uavs.size();
    recorder_ = {};
    simulator_ = std::make_unique<sim::FakeSimulator>(std::move(world));
    options_.token = "secret";
    options_.uavs.assign(
        uavs,
        {{kCameraTiming, kImuTiming, kRangeTiming}, uav::ConstantDelay{latency_}, clock_, cores_});
    remake();
    server_ = std::make_unique<ScriptedServer>();
  }
  /// With the options as they are now.
  void remake() {
    coordinator_ = std::make_unique<Coordinator>(*simulator_, recorder_, options_,
                                                 [this] { return now_ += tick_; });
  }
  void set_free_running(double real_time_factor) {
    options_.policy = sync::SyncPolicy::kFreeRunning;
    options_.real_time_factor = real_time_factor;
  }
  /// With the SUTs added so far.
  RunReport run() { return coordinator_->run(*server_, hooks_); }
  /// With one SUT; makes a coordinator if there is none.
  RunReport run(ScriptedServer::Script script) {
    if (!coordinator_) make();
    server_->add_sut(hello(), std::move(script));
    return run();
  }
  /// A SUT that sends only what the test delivers.
  link::PeerId add_silent(bool concurrent = false, const std::string& uav = "") {
    link::Hello h = hello(uav);
    h.concurrent = concurrent;
    return server_->add_sut(h, {});
  }
  const link::Refusal& refusal(link::PeerId peer) {
    return std::get<link::Refusal>(server_->sent.at(peer).back());
  }
  std::string name_of(std::size_t i) const { return simulator_->world().uavs[i].name; }
  std::vector<link::Reply> replies_to(link::PeerId peer) {
    std::vector<link::Reply> found;
    for (const link::Message& message : server_->sent[peer])
      if (const auto* reply = std::get_if<link::Reply>(&message)) found.push_back(*reply);
    return found;
  }

  RunOptions options_;
  Duration latency_{0};
  std::optional<computer::Clock> clock_;
  int cores_ = 0;
  Duration tick_ = std::chrono::milliseconds(1);
  WallTime now_{};
  RunHooks hooks_;
  MemoryRecorder recorder_;
  std::unique_ptr<sim::FakeSimulator> simulator_;
  std::unique_ptr<Coordinator> coordinator_;
  std::unique_ptr<ScriptedServer> server_;
};

}  // namespace tether::coordinator
