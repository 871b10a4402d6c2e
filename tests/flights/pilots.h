#pragma once

#include "vehicle/interacting_vehicle.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <semaphore>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <tether/link/server.h>

namespace tether::flights {

/// One end of a conversation in which exactly one side runs at a time.
struct Turns {
  std::binary_semaphore pilot{0}, host{0};
  std::optional<link::Request> said;    // by the pilot; none: it is done
  std::optional<link::Message> answer;  // of the host
};

/// The vehicle of the client library, without a socket: computes for as long as `computing` says
/// before each call.
class PilotVehicle final : public client::InteractingVehicle {
 public:
  PilotVehicle(const link::Welcome& welcome, Turns& turns, std::function<Duration()> computing)
      : InteractingVehicle(welcome.catalogue, welcome.peers),
        turns_(turns),
        computing_(std::move(computing)),
        free_running_(welcome.free_running),
        et_(welcome.start) {}

  ExecTime now() const override { return et_; }
  Status sleep_for(Duration duration) override {
    return client::status_of(interact(client::make_sleep(et_ + duration)));
  }
  Status sleep_until(ExecTime until) override {
    return client::status_of(interact(client::make_sleep(until)));
  }
  Status annotate(std::string_view, std::string_view) override { return ok_status(); }

 private:
  Result<link::Reply> interact(Body body) override {
    if (const Status good = usable(); !good) return good.failure();
    et_ += computing_();
    const link::Request request{.sequence = ++sequence_, .issued_at = et_, .body = std::move(body)};
    turns_.said = request;
    turns_.host.release();
    turns_.pilot.acquire();
    if (const auto* refusal = std::get_if<link::Refusal>(&*turns_.answer))
      return give_up(client::to_failure(*refusal));
    auto reply = std::get<link::Reply>(std::move(*turns_.answer));
    if (const Status good = client::check(reply, request, catalogue(), free_running_); !good)
      return give_up(good.failure());
    et_ = reply.resume_at;
    return reply;
  }
  void close() override {}

  Turns& turns_;
  std::function<Duration()> computing_;
  bool free_running_;
  ExecTime et_;
  std::uint64_t sequence_ = 0;
};

using Program = std::function<void(client::Vehicle&)>;

/// A server whose peers are programs, each in a thread of its own. Only one thread runs at a time,
/// and `choose` says which of the waiting messages comes next, so that a flight can be repeated.
class Pilots final : public link::Server {
 public:
  explicit Pilots(std::function<std::size_t(std::size_t)> choose) : choose_(std::move(choose)) {}
  ~Pilots() override {
    for (auto& [peer, pilot] : pilots_)
      if (pilot->thread.joinable()) {
        hand_over(*pilot, link::Refusal{link::Refusal::Reason::kRunEnded, "over"});
        pilot->thread.join();
      }
  }

  void add(const std::string& uav, std::function<Duration()> computing, Program program) {
    const link::PeerId peer = pilots_.size() + 1;
    pilots_[peer] = std::make_unique<Pilot>(std::move(computing), std::move(program));
    link::Hello hello{.sut = "pilot", .uav = uav, .token = "secret"};
    hello.clock.kind = computer::ClockKind::kScripted;
    waiting_.push_back({peer, link::Message(hello)});
  }

  link::Address address() const override { return {"flights", 0}; }
  std::span<link::Event> poll(Duration) override {
    if (waiting_.empty()) return {};
    const auto next = waiting_.begin() + static_cast<std::ptrdiff_t>(choose_(waiting_.size()));
    event_ = std::move(*next);
    waiting_.erase(next);
    return {&event_, 1};
  }
  void send(link::PeerId peer, link::Message message) override {
    Pilot& pilot = *pilots_.at(peer);
    if (const auto* welcome = std::get_if<link::Welcome>(&message)) {
      pilot.thread = std::thread([&pilot, welcome = *welcome] {
        PilotVehicle vehicle(welcome, pilot.turns, pilot.computing);
        pilot.program(vehicle);
        pilot.turns.said.reset();
        pilot.is_done = true;
        pilot.turns.host.release();
      });
    } else if (!pilot.thread.joinable()) {
      return;
    } else {
      pilot.turns.answer = std::move(message);
      pilot.turns.pilot.release();
    }
    listen(peer, pilot);
  }
  std::uint64_t moved_bytes(link::PeerId) override { return 0; }
  void close(link::PeerId) override {}

 private:
  struct Pilot {
    Pilot(std::function<Duration()> given, Program flown)
        : computing(std::move(given)), program(std::move(flown)) {}
    std::function<Duration()> computing;
    Program program;
    Turns turns;
    bool is_done = false;
    std::thread thread;
  };

  static void hand_over(Pilot& pilot, link::Message message) {
    while (!pilot.is_done) {
      pilot.turns.answer = message;
      pilot.turns.pilot.release();
      pilot.turns.host.acquire();
    }
  }
  void listen(link::PeerId peer, Pilot& pilot) {
    pilot.turns.host.acquire();
    if (pilot.is_done) return pilot.thread.join();
    waiting_.push_back({peer, link::Message(*pilot.turns.said)});
  }

  std::function<std::size_t(std::size_t)> choose_;
  std::map<link::PeerId, std::unique_ptr<Pilot>> pilots_;
  std::vector<link::Event> waiting_;
  link::Event event_;  // of the last poll
};

}  // namespace tether::flights
