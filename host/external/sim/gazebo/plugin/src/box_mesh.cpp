#include <tether/sim_gazebo_plugin/shape_rays.h>

namespace tether::gazebo_plugin {
namespace {

using uav::Vec3;

// Both unit, along edges, seen from outside.
struct Face {
  Vec3 right;
  Vec3 down;
};

constexpr Vec3 kDown{0.0, 0.0, -1.0};
constexpr std::array<Face, 6> kFaces{{{{0.0, 1.0, 0.0}, kDown},
                                      {{0.0, -1.0, 0.0}, kDown},
                                      {{-1.0, 0.0, 0.0}, kDown},
                                      {{1.0, 0.0, 0.0}, kDown},
                                      {{1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}},
                                      {{-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}}}};

// From the upper left one on, counter-clockwise: shares of the width and the height.
constexpr std::array<std::array<double, 2>, 4> kCorners{
    {{0.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}}};

double along(const Vec3& direction, const Vec3& size_m) {
  return norm(Vec3{direction.x * size_m.x, direction.y * size_m.y, direction.z * size_m.z});
}

}  // namespace

BoxMesh textured_box(const Vec3& size_m, double repeat_x_per_m, double repeat_y_per_m) {
  BoxMesh mesh;
  for (const auto& [right, down] : kFaces) {
    const Vec3 normal = cross(down, right);
    const double width = along(right, size_m) * repeat_x_per_m;
    const double height = along(down, size_m) * repeat_y_per_m;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [x, y] : kCorners) {
      const Vec3 position = 0.5 * normal + (x - 0.5) * right + (y - 0.5) * down;
      mesh.vertices.push_back({position, normal, x * width, y * height});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

}  // namespace tether::gazebo_plugin
