#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include <tether/sim/world.h>
#include <tether/sim_protocol/connection.h>
#include <tether/sim_protocol/messages.h>
#include <tether/uav/multirotor.h>

namespace tether::sim::testing {

/// An external simulator: UAVs approach their commanded velocity, every other moving body swings
/// along x, rays and pictures show collision boxes only. Serves one host over TCP from its own
/// thread. Does not check what it sends, so that any fault can be planted.
class FakeExternalSimulator {
 public:
  /// Returns what is sent in place of an answer; nothing: closes the connection.
  using Fault = std::function<std::optional<protocol::Reply>(const protocol::Request& request,
                                                             protocol::Reply answer)>;

  /// `world`: that of the host. `fault` is called before every answer, on the fake's thread.
  explicit FakeExternalSimulator(const World& world, Fault fault = {});
  ~FakeExternalSimulator();
  FakeExternalSimulator(const FakeExternalSimulator&) = delete;
  FakeExternalSimulator& operator=(const FakeExternalSimulator&) = delete;

  /// The host's end. Once.
  std::unique_ptr<protocol::Connection> take_connection() { return std::move(connection_); }

  /// All requests received so far. Any thread.
  std::vector<protocol::Request> requests() const;

 private:
  struct Flight {
    uav::BodyState body;
    uav::VelocityCommand command;
    protocol::Motion motion;
  };
  struct Box {
    std::optional<std::size_t> body;  ///< that it moves with
    uav::Pose X;                      ///< in its body; in W without one
    uav::Vec3 half_m;
  };

  void add_boxes(const Link& link, std::optional<std::size_t> body, const uav::Pose& X_WL);
  /// To the first box along the unit vector `ray_W`, but for those of body `without`.
  double distance_m(const uav::Vec3& origin_W, const uav::Vec3& ray_W,
                    std::span<const uav::Pose> X_WB, std::optional<std::uint32_t> without) const;
  void serve(int listening);
  protocol::Reply answer(const protocol::Open& open);
  protocol::Reply answer(const protocol::Reset& reset);
  protocol::Reply answer(const protocol::Advance& advance);
  protocol::Reply answer(const protocol::CastRays& cast);
  protocol::Reply answer(const protocol::Render& render);
  void step(Flight& flight) const;
  protocol::State state() const;

  World world_;
  std::vector<Box> boxes_;
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
