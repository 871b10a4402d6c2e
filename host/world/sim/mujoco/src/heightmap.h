#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tether/sim/world.h>
#include <tether/sim_raster/scene.h>

namespace tether::sim {

/// The text of an OBJ file of the ground whose height is the brightness of a picture: 1 × 1 m
/// around the origin, +x to the right and +y up in the picture, the brightest pixel 1 m high, black
/// 0. The picture's coordinates are those of a texture over the whole. At most 257 × 257 heights
/// are taken, evenly.
std::string obj_of_heights(const raster::Texture& picture);

/// Whether a shape is a heightmap, or a piece of one: its mesh is a picture.
bool is_heightmap(const Geometry& geometry);

/// The same mesh as the physics engine has it: it then finds contacts and rays exactly. The
/// diagonals of its cells are those of `obj_of_heights`.
struct Heights {
  std::size_t rows = 0;  ///< from the least y on
  std::size_t columns = 0;
  std::vector<float> shares{};  ///< of `top_m`, row by row
  float half_x_m = 0.0F;
  float half_y_m = 0.0F;
  float top_m = 1e-3F;
};
Heights heights_of(const raster::Mesh& mesh);

}  // namespace tether::sim
