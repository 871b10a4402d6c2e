#pragma once

#include "scripted_server.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

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
                         link::ClockKind clock = link::ClockKind::kScripted) {
  link::Hello h;
  h.sut = "script";
  h.uav = uav;
  h.clock = clock;
  h.token = "secret";
  return h;
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
inline Act finish(Duration compute) {
  return {compute, link::Finish{true, "done", "{}"}};
}

/// A coordinator over a fake simulator of `uavs` UAVs, on a clock that moves a millisecond per
/// reading.
class CoordinatorTest : public testing::Test {
 protected:
  void make(std::size_t uavs = 1) {
    simulator_ = std::make_unique<sim::FakeSimulator>(sim::make_fake_world(uavs));
    options_.token = "secret";
    options_.uavs.assign(uavs,
                         {{kCameraTiming, kImuTiming, kRangeTiming}, latency_, clock_, cores_});
    coordinator_ = std::make_unique<Coordinator>(*simulator_, recorder_, options_,
                                                 [this] { return now_ += tick_; });
    server_ = std::make_unique<ScriptedServer>();
  }
  RunReport run(ScriptedServer::Script script) {
    if (!coordinator_) make();
    server_->add_sut(hello(), std::move(script));
    return coordinator_->run(*server_, hooks_);
  }
  const link::Refusal& refusal(link::PeerId peer) {
    return std::get<link::Refusal>(server_->sent.at(peer).back());
  }

  RunOptions options_;
  Duration latency_{0};
  std::optional<ClockSetting> clock_;
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
