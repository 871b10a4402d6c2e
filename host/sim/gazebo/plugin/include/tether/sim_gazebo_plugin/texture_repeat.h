#pragma once

#include <string>

#include <tether/uav/math.h>

namespace tether::gazebo_plugin {

struct TextureRepeat {
  double x = 1.0, y = 1.0;
};

/// How often a texture goes over one of Gazebo's unit shapes that is scaled to `size_m`, where it
/// is to repeat so often per metre of surface. Once over any other mesh, whose own coordinates
/// count.
TextureRepeat texture_repeat(const std::string& mesh, const uav::Vec3& size_m,
                             double repeat_x_per_m, double repeat_y_per_m);

}  // namespace tether::gazebo_plugin
