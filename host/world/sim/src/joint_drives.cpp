#include <tether/sim/bodies.h>

namespace tether::sim {

JointDrives::JointDrives(const World& world) : step_s_(to_seconds(world.step)) {
  for (const Uav& uav : world.uavs) {
    first_.push_back(drives_.size());
    for (const uav::Joint& joint : uav.joints) drives_.push_back({joint});
  }
  first_.push_back(drives_.size());
  angles_rad_.resize(drives_.size());
  reset();
}

void JointDrives::reset() {
  for (std::size_t i = 0; i < drives_.size(); ++i)
    angles_rad_[i] = drives_[i].target_rad = start_rad(drives_[i].joint);
}

void JointDrives::command(std::size_t uav, std::span<const double> angles_rad) {
  for (std::size_t i = 0; i < angles_rad.size(); ++i)
    drives_[first_[uav] + i].target_rad = angles_rad[i];
}

void JointDrives::step() {
  for (std::size_t i = 0; i < drives_.size(); ++i)
    angles_rad_[i] = turned_rad(drives_[i].joint, angles_rad_[i], drives_[i].target_rad, step_s_);
}

std::span<const double> JointDrives::angles_rad(std::size_t uav) const {
  return std::span(angles_rad_).subspan(first_[uav], first_[uav + 1] - first_[uav]);
}

}  // namespace tether::sim
