#include "meshes/texture_file.h"
#include "meshes/triangle_mesh.h"
#include "picture.h"

/// Textures of strangers, up to a picture of a wall with them. Input: a PNG or JPEG file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::InputFolder folder;
  const auto file = folder.write("texture", fuzz::Bytes{data, size});
  const auto warn = [](const Warning& warning) { fuzz::require_one_line(to_line(warning)); };
  auto loaded = fuzz::read_or_refuse([&] { return sim::load_texture(file, warn); });
  // A large one takes long to draw, and nothing else.
  if (!loaded || loaded->rgba.size() > std::size_t{1} << 22) return 0;
  raster::SceneParts parts;
  parts.materials.resize(1);
  parts.materials[0].texture = 0;
  parts.instances.resize(1);
  parts.meshes.push_back(sim::box_mesh({1.0, 1.0, 1.0}, {1.0, 1.0}));
  parts.textures.push_back(std::move(*loaded));
  fuzz::draw(parts);
  return 0;
}
