#pragma once

#include <tether/sim/world.h>
#include <tether/sim_raster/scene.h>
#include <tether/uav/math.h>

namespace tether::sim {

/// How a surface's texture is laid on it.
struct TextureScale {
  double repeat_x = 1.0;
  double repeat_y = 1.0;
  TextureRepeat over = TextureRepeat::kPerMetre;

  /// Repetitions over a length.
  double across(double length_m) const { return repeat_x * count(length_m); }
  double down(double length_m) const { return repeat_y * count(length_m); }

  /// Where the texture begins: repetitions over a face are counted from its middle, as OGRE does.
  double left() const { return begin(repeat_x); }
  double top() const { return begin(repeat_y); }

 private:
  double begin(double repeat) const {
    return over == TextureRepeat::kPerMetre ? 0.0 : 0.5 - 0.5 * repeat;
  }
  double count(double length_m) const { return over == TextureRepeat::kPerMetre ? length_m : 1.0; }
};

/// Each face carries its texture upright (seen from outside, with z up), starting at its upper left
/// corner. Top and bottom: with +y up; counted per face, as Gazebo has them, with +x and −x up.
raster::Mesh box_mesh(const uav::Vec3& size_m, const TextureScale& scale);
/// The side unrolled around z; the caps flat.
raster::Mesh cylinder_mesh(double radius_m, double length_m, const TextureScale& scale);
raster::Mesh capsule_mesh(double radius_m, double length_m, const TextureScale& scale);
/// Also a sphere, with equal radii.
raster::Mesh ellipsoid_mesh(const uav::Vec3& radii_m, const TextureScale& scale);
/// One-sided: seen from where `normal` points.
raster::Mesh plane_mesh(const PlaneGeometry& plane, const TextureScale& scale);

/// Adds the same triangles, seen from their other side.
void add_inside(raster::Mesh& mesh);

/// The rotation that turns z to `normal` (need not be unit; zero is taken as z).
uav::Quat rotation_from_z(const uav::Vec3& normal);

}  // namespace tether::sim
