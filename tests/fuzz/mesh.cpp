#include "meshes/mesh_file.h"
#include "picture.h"

/// Assimp forgets what it has read so far of a file that it refuses.
extern "C" const char* __lsan_default_suppressions() {  // NOLINT: the sanitizer's name
  return "leak:libassimp";
}

/// Meshes of strangers, up to a picture of them and the points of their collisions. Input: a letter
/// (o, s, d or g: OBJ, STL, COLLADA, binary glTF), then the file, which is also its own library of
/// materials.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::InputFolder folder;
  fuzz::Choices choices({data, size});
  const std::uint8_t kind = choices.byte();
  const char* const name = kind == 'o'   ? "a.obj"
                           : kind == 's' ? "a.stl"
                           : kind == 'g' ? "a.glb"
                                         : "a.dae";
  const auto bytes = choices.rest();
  sim::MeshGeometry mesh{folder.write(name, bytes), "", {1.0, 1.0, 1.0}};
  mesh.companions = {folder.write("a.mtl", bytes)};
  const sim::MeshFiles files;
  const auto warn = [](const Warning& warning) { fuzz::require_one_line(to_line(warning)); };
  auto loaded = fuzz::read_or_refuse([&] { return files.parts(mesh, warn); });
  if (!loaded) return 0;
  fuzz::require(!files.corners(mesh).empty(), "triangles without corners");
  raster::SceneParts parts;
  for (sim::MeshPart& part : *loaded) {
    const auto number = parts.meshes.size();
    raster::Material& material = parts.materials.emplace_back();
    const auto& [r, g, b] = part.look.material.diffuse_rgb;
    material.diffuse = {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
    if (part.look.picture) {
      material.texture = parts.textures.size();
      parts.textures.push_back(*part.look.picture);
    }
    parts.meshes.push_back(std::move(part.mesh));
    raster::Instance& instance = parts.instances.emplace_back();
    instance.mesh = instance.material = number;
  }
  fuzz::draw(parts);
  return 0;
}
