#pragma once

#include "ode_bodies.h"
#include "ode_rays.h"
#include "pictures.h"
#include "space_order.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gazebo/physics/PhysicsTypes.hh>

#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {

/// The world that gzserver has loaded. All calls in the thread of its physics, before a step.
class GazeboSimulation : public Simulation {
 public:
  /// `main_thread` must outlive it. Waiting for it ends when `give_up` returns true.
  GazeboSimulation(::gazebo::physics::WorldPtr world, MainThread& main_thread,
                   std::function<bool()> give_up);
  ~GazeboSimulation() override;

  void open(const protocol::Open& open) override;
  bool is_ready() override;
  std::string description() const override;
  void reset(std::uint64_t seed) override;
  std::vector<uav::BodyState> bodies() const override;
  void push(std::size_t uav, const uav::Vec3& force_W, const uav::Vec3& torque_W) override;
  std::vector<TouchedPoint> touched_points() const override;
  protocol::Distances cast(const protocol::CastRays& rays) override;
  protocol::Picture render(const protocol::Render& view) override;

 private:
  using Clock = std::chrono::steady_clock;

  void check(const protocol::Open& open) const;
  std::vector<std::string> missing_models() const;
  std::vector<std::string> missing_visuals();
  bool must_wait_for(const std::vector<std::string>& missing) const;
  /// False: the main thread has not begun it.
  bool prepare_pictures();
  bool warm_up_in_main_thread(const std::function<void()>& job);
  bool in_main_thread(const std::function<void()>& job);

  ::gazebo::physics::WorldPtr world_;
  MainThread& main_thread_;
  std::function<bool()> give_up_;
  protocol::Open open_;
  Clock::time_point deadline_;
  OdeBodies bodies_;
  std::optional<OdeRays> rays_;
  SpaceOrder order_;
  std::unique_ptr<Pictures> pictures_;
};

}  // namespace tether::gazebo_plugin
