#include <numbers>

#include <tether/sim_gazebo_plugin/shape_rays.h>

namespace tether::gazebo_plugin {

TextureRepeat texture_repeat(const std::string& mesh, const uav::Vec3& size_m,
                             double repeat_x_per_m, double repeat_y_per_m) {
  const double around_m = std::numbers::pi * size_m.x;
  if (mesh == "unit_plane") return {size_m.x * repeat_x_per_m, size_m.y * repeat_y_per_m};
  if (mesh == "unit_cylinder") return {around_m * repeat_x_per_m, size_m.z * repeat_y_per_m};
  if (mesh == "unit_sphere") return {around_m * repeat_x_per_m, 0.5 * around_m * repeat_y_per_m};
  return {};
}

}  // namespace tether::gazebo_plugin
