#pragma once

#include <string>

#include <tether/sim_raster/scene.h>

namespace tether::sim {

/// The text of an OBJ file of the ground whose height is the brightness of a picture: 1 × 1 m
/// around the origin, +x to the right and +y up in the picture, the brightest pixel 1 m high, black
/// 0. The picture's coordinates are those of a texture over the whole. At most 257 × 257 heights
/// are taken, evenly.
std::string obj_of_heights(const raster::Texture& picture);

}  // namespace tether::sim
