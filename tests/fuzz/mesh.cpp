#include "mesh_file.h"
#include "picture.h"

/// Assimp forgets what it has read so far of a file that it refuses.
extern "C" const char* __lsan_default_suppressions() {  // NOLINT: the sanitizer's name
  return "leak:libassimp";
}

/// Meshes of strangers, up to a picture of them and the points of their collisions. Input: a letter
/// (o, s or d: OBJ, STL, COLLADA), then the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::InputFolder folder;
  fuzz::Choices choices({data, size});
  const std::uint8_t kind = choices.byte();
  const char* const name = kind == 'o' ? "a.obj" : kind == 's' ? "a.stl" : "a.dae";
  const sim::MeshGeometry mesh{folder.write(name, choices.rest()), "", {1.0, 1.0, 1.0}};
  const sim::MeshFiles files;
  const auto warn = [](const Warning& warning) { fuzz::require_one_line(to_line(warning)); };
  auto loaded = fuzz::read_or_refuse([&] { return files.load(mesh, {1.0, 1.0}, warn); });
  if (!loaded) return 0;
  fuzz::require(!files.corners(mesh).empty(), "triangles without corners");
  raster::SceneParts parts;
  parts.materials.resize(1);
  parts.instances.resize(1);
  parts.meshes.push_back(std::move(*loaded));
  fuzz::draw(parts);
  return 0;
}
