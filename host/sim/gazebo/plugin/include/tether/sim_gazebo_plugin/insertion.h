#pragma once

#include <string>

namespace tether::gazebo_plugin {

/// The SDF of a UAV with a camera sensor that never works on its only link: Gazebo keeps a scene,
/// and calls who draws in it, only where a world has a sensor of pictures. Unchanged where there is
/// no link.
std::string with_idle_camera(const std::string& sdf);

}  // namespace tether::gazebo_plugin
