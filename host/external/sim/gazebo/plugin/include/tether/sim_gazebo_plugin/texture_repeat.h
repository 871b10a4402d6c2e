#pragma once

#include <string>

#include <tether/uav/math.h>

namespace tether::gazebo_plugin {

struct TextureRepeat {
  double x = 1.0, y = 1.0;
};

/// The repetitions of a texture over one of Gazebo's unit shapes that is scaled to `size_m`, for
/// the given repetitions per metre of surface. 1 for any other mesh, which has its own coordinates.
TextureRepeat texture_repeat(const std::string& mesh, const uav::Vec3& size_m,
                             double repeat_x_per_m, double repeat_y_per_m);

}  // namespace tether::gazebo_plugin
