#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <tether/base/result.h>
#include <tether/sim/world.h>
#include <tether/sim_protocol/connection.h>
#include <tether/sim_protocol/messages.h>
#include <tether/sim_remote_testing/box_scene.h>
#include <tether/uav/multirotor.h>

namespace tether::sim::testing {

/// A simulator outside: UAVs fly by uav::step as rigid bodies that touch nothing, every other
/// moving body swings along x, rays and pictures know boxes only. Serves one host over TCP from a
/// thread of its own, and checks nothing that it sends, so that any fault can be planted.
class FakeOutside {
 public:
  /// Stands in the place of an answer; nothing: hangs up without one.
  using Fault = std::function<std::optional<protocol::Reply>(const protocol::Request& request,
                                                             protocol::Reply answer)>;

  /// `world`: what the host has too. `fault` is asked before every answer, on the fake's thread.
  explicit FakeOutside(const World& world, Fault fault = {});
  ~FakeOutside();
  FakeOutside(const FakeOutside&) = delete;
  FakeOutside& operator=(const FakeOutside&) = delete;

  /// The host's end. Once.
  std::unique_ptr<protocol::Connection> take_connection() { return std::move(connection_); }

  /// All requests that have come so far. Any thread.
  std::vector<protocol::Request> requests() const;

 private:
  struct Flight {
    uav::BodyState body;
    uav::MultirotorState rotors;
    uav::VelocityCommand command;
    protocol::Motion motion;
  };

  void serve(int listening);
  protocol::Reply answer(const protocol::Request& request);
  protocol::Reply answer(const protocol::Open& open);
  protocol::Reply answer(const protocol::Reset& reset);
  protocol::Reply answer(const protocol::Advance& advance);
  protocol::Reply answer(const protocol::CastRays& cast);
  protocol::Reply answer(const protocol::Render& render);
  void step();
  void step(std::size_t uav);
  protocol::State state() const;
  uav::BodyState swinging(std::size_t body) const;

  World world_;
  BoxScene scene_;
  Fault fault_;
  protocol::Open open_;
  SimTime now_;
  std::vector<Flight> flights_;
  std::vector<uav::Pose> past_;

  std::unique_ptr<protocol::Connection> connection_;
  mutable std::mutex mutex_;
  std::vector<protocol::Request> requests_;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace tether::sim::testing
