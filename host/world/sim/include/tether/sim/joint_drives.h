#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tether/sim/world.h>

namespace tether::sim {

/// The joints of all UAVs: each turns at its rate to the angle that was commanded last. Their parts
/// weigh nothing, so that this is the same for every back end.
class JointDrives {
 public:
  explicit JointDrives(const World& world);

  void reset();
  /// @pre an angle for each joint of the UAV, within its limits
  void command(std::size_t uav, std::span<const double> angles_rad);
  void step();

  std::span<const double> angles_rad() const { return angles_rad_; }  ///< UAV by UAV
  std::span<const double> angles_rad(std::size_t uav) const;

 private:
  struct Drive {
    uav::Joint joint;
    double target_rad = 0.0;
  };
  std::vector<Drive> drives_;
  std::vector<double> angles_rad_;
  std::vector<std::size_t> first_;  // of each UAV, and the end
  double step_s_;
};

}  // namespace tether::sim
