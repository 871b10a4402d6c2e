#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <tether/uav/math.h>

namespace tether::gazebo_plugin {

struct BoxVertex {
  uav::Vec3 position;  ///< of a box with edges of length 1 around the origin
  uav::Vec3 normal;
  double u = 0.0, v = 0.0;
};

struct BoxMesh {
  std::vector<BoxVertex> vertices;
  /// Counter-clockwise, seen from outside.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A unit box to be scaled to `size_m`. Its texture begins in the upper left corner of each face,
/// seen from outside (top and bottom: at the ends of −x and of +y), with the given repetitions per
/// metre.
BoxMesh textured_box(const uav::Vec3& size_m, double repeat_x_per_m, double repeat_y_per_m);

struct TextureRepeat {
  double x = 1.0, y = 1.0;
};

/// The repetitions of a texture over one of Gazebo's unit shapes that is scaled to `size_m`, for
/// the given repetitions per metre of surface. 1 for any other mesh, which has its own coordinates.
TextureRepeat texture_repeat(const std::string& mesh, const uav::Vec3& size_m,
                             double repeat_x_per_m, double repeat_y_per_m);

}  // namespace tether::gazebo_plugin
