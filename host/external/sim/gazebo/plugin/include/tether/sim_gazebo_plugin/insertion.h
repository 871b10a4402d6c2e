#pragma once

#include <string>

namespace tether::gazebo_plugin {

/// The SDF of a UAV with an inactive camera sensor added to its only link: Gazebo maintains a scene
/// only for a world with a camera. Unchanged without a link.
std::string with_idle_camera(const std::string& sdf);

}  // namespace tether::gazebo_plugin
