#include "meshes/mesh_look.h"

#include "meshes/texture_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <locale>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <tether/base/error.h>
#include <tether/base/text.h>

namespace tether::sim {
namespace {

using uav::Vec3;

constexpr int kSteps = 64;         // of each channel of the palette
constexpr int kPaletteSize = 512;  // kSteps³ pixels

// Of a library of materials: colours, and how opaque or transparent a surface is.
const std::map<std::string, std::size_t, std::less<>> kNumbersOfLibraries = {
    {"Ka", 3}, {"Kd", 3}, {"Ks", 3}, {"Ke", 3}, {"d", 1}, {"Tr", 1}};

// Some writers have colours brighter than white, or no numbers.
double share(double value) {
  return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0;
}

Vec3 colour(const aiMaterial& material, const char* key, unsigned type, unsigned index,
            const Vec3& otherwise) {
  aiColor3D c;
  if (material.Get(key, type, index, c) != AI_SUCCESS) return otherwise;
  return {share(double{c.r}), share(double{c.g}), share(double{c.b})};
}

double number(const aiMaterial& material, const char* key, unsigned type, unsigned index,
              float otherwise) {
  float value = otherwise;
  static_cast<void>(material.Get(key, type, index, value));
  return share(double{value});
}

// "wood floor.png" of "C:\\pictures\\Wood%20Floor.png".
std::string file_name(std::string_view text) {
  return lower_case(unescaped(text.substr(text.find_last_of("/\\") + 1)));
}

// A picture that is a part of the file: as a PNG or JPEG file, or pixel by pixel.
raster::Texture embedded(const aiTexture& picture, const std::filesystem::path& file,
                         const WarningSink& warn) {
  if (picture.mHeight == 0)
    return decode_texture({reinterpret_cast<const char*>(picture.pcData), picture.mWidth}, file,
                          warn);
  raster::Texture out{static_cast<int>(picture.mWidth), static_cast<int>(picture.mHeight), {}};
  constexpr auto kMost = static_cast<unsigned>(raster::kMaxTextureSize_px);
  if (picture.mWidth > kMost || picture.mHeight > kMost)
    throw Error(ErrorCode::kBadFile, FileLocation{file.string()},
                "has a picture of more than 8192 pixels each way");
  for (std::size_t i = 0; i < std::size_t{picture.mWidth} * picture.mHeight; ++i) {
    const aiTexel& t = picture.pcData[i];
    out.rgba.insert(out.rgba.end(), {t.r, t.g, t.b, t.a});
  }
  return out;
}

bool is_gltf(const std::filesystem::path& file) {
  const std::string type = file_name(file.extension().string());
  return type == ".glb" || type == ".gltf";
}

bool is_collada(const std::filesystem::path& file) {
  return file_name(file.extension().string()) == ".dae";
}

// As Gazebo takes it: that of the file, which for COLLADA is 0.4 if there is none (Assimp then says
// 0.1), and 0 in a library of materials. glTF has none.
Vec3 ambient(const aiMaterial& material, const std::filesystem::path& file, const Vec3& diffuse) {
  if (is_gltf(file)) return diffuse;
  const Vec3 said = colour(material, AI_MATKEY_COLOR_AMBIENT, {});
  const auto is_default = [](double value) { return std::abs(value - 0.1) < 1e-6; };
  const bool is_missing = is_default(said.x) && is_default(said.y) && is_default(said.z);
  return is_missing && is_collada(file) ? Vec3{0.4, 0.4, 0.4} : said;
}

// Assimp's own, where a file has none.
bool is_of_reader(const aiMaterial& material) {
  aiString name;
  return material.Get(AI_MATKEY_NAME, name) == AI_SUCCESS &&
         std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME;
}

// That of the surface's colour; empty: none.
std::string picture_of(const aiMaterial& material) {
  aiString picture;
  const bool is_there = material.GetTexture(aiTextureType_DIFFUSE, 0, &picture) == AI_SUCCESS ||
                        material.GetTexture(aiTextureType_BASE_COLOR, 0, &picture) == AI_SUCCESS;
  return is_there ? picture.C_Str() : "";
}

}  // namespace

bool has_vertex_colours(const aiScene& scene, const aiMesh& mesh,
                        const std::filesystem::path& file) {
  if (!mesh.HasVertexColors(0)) return false;
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return true;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  return picture_of(material).empty() && (is_gltf(file) || is_of_reader(material));
}

const std::filesystem::path* find_companion(const MeshGeometry& mesh, std::string_view text) {
  const std::string wanted = file_name(text);
  const auto found = std::ranges::find_if(mesh.companions, [&](const auto& companion) {
    return file_name(companion.filename().string()) == wanted;
  });
  return found == mesh.companions.end() ? nullptr : &*found;
}

std::string clean_library(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  bool has_material = false;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    std::string key, rest;
    words >> key >> std::ws;
    if (key == "newmtl" && words >> rest) {
      has_material = true;
      out += "newmtl " + rest + "\n";
    } else if (has_material && key == "map_Kd" && std::getline(words, rest)) {
      // Behind options, the name is the last word.
      while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.back())) != 0)
        rest.pop_back();
      if (rest.starts_with('-')) rest = rest.substr(rest.find_last_of(" \t") + 1);
      if (!rest.empty()) out += "map_Kd " + rest + "\n";
    } else if (has_material) {
      const auto count = kNumbersOfLibraries.find(key);
      std::vector<double> numbers;
      for (double number = 0.0; words >> number;) numbers.push_back(number);
      if (count == kNumbersOfLibraries.end() || numbers.size() < count->second) continue;
      out += key;
      for (std::size_t i = 0; i < count->second; ++i)
        out += " " + std::to_string(share(numbers[i]));
      out += "\n";
    }
  }
  return out;
}

MeshLook read_look(const aiScene& scene, const aiMaterial& material, const MeshGeometry& mesh,
                   const WarningSink& warn) {
  MeshLook look;
  Material& out = look.material;
  if (is_of_reader(material)) {
    out.diffuse_rgb = out.ambient_rgb = {1.0, 1.0, 1.0};
    return look;
  }
  const std::string picture = picture_of(material);
  out.diffuse_rgb = colour(material, AI_MATKEY_COLOR_DIFFUSE, out.diffuse_rgb);
  out.specular_rgb = colour(material, AI_MATKEY_COLOR_SPECULAR, {});
  out.emissive_rgb = colour(material, AI_MATKEY_COLOR_EMISSIVE, {});
  out.alpha = number(material, AI_MATKEY_OPACITY, 1.0F);
  if (out.alpha == 0.0) out.alpha = 1.0;
  int is_double_sided = 0;
  static_cast<void>(material.Get(AI_MATKEY_TWOSIDED, is_double_sided));
  out.is_double_sided = is_double_sided != 0;
  if (!picture.empty()) {
    const aiTexture* inside = scene.GetEmbeddedTexture(picture.c_str());
    if (inside != nullptr) {
      try {
        look.picture = std::make_shared<raster::Texture>(embedded(*inside, mesh.file, warn));
      } catch (const Error& error) {
        if (error.code() != ErrorCode::kBadFile) throw;
        warn({Consequence::kLooksDifferent,
              {mesh.file.string()},
              "mesh",
              std::string("has a picture that cannot be read; its colours are used: ") +
                  error.what(),
              true});
      }
    } else if (const auto* file = find_companion(mesh, picture)) {
      out.albedo_map = *file;
    } else {
      warn({Consequence::kLooksDifferent,
            {mesh.file.string()},
            "mesh",
            "names the picture '" + picture +
                "', which is not found beside it as a PNG or JPEG file; its colours are used",
            true});
    }
    // In COLLADA, it takes the place of the colour.
    const bool is_shown = look.picture || !out.albedo_map.empty();
    if (is_shown && is_collada(mesh.file)) out.diffuse_rgb = {1.0, 1.0, 1.0};
  }
  out.ambient_rgb = ambient(material, mesh.file, out.diffuse_rgb);
  return look;
}

std::shared_ptr<const raster::Texture> palette() {
  static const std::shared_ptr<const raster::Texture> colours = [] {
    raster::Texture texture{kPaletteSize, kPaletteSize, {}};
    const auto byte = [](int step) {
      return static_cast<std::uint8_t>((step * 255 + kSteps / 2) / (kSteps - 1));
    };
    for (int i = 0; i < kPaletteSize * kPaletteSize; ++i)
      texture.rgba.insert(texture.rgba.end(), {byte(i / kSteps / kSteps), byte(i / kSteps % kSteps),
                                               byte(i % kSteps), std::uint8_t{255}});
    return std::make_shared<const raster::Texture>(std::move(texture));
  }();
  return colours;
}

std::array<float, 2> place_in_palette(const aiMesh& mesh, std::span<const unsigned> corners) {
  double r = 0.0, g = 0.0, b = 0.0;
  for (const unsigned corner : corners) {
    const aiColor4D& c = mesh.mColors[0][corner];
    r += share(double{c.r}) / static_cast<double>(corners.size());
    g += share(double{c.g}) / static_cast<double>(corners.size());
    b += share(double{c.b}) / static_cast<double>(corners.size());
  }
  const auto step = [](double value) {
    return std::min(kSteps - 1, static_cast<int>(std::lround(value * (kSteps - 1))));
  };
  const int index = (step(r) * kSteps + step(g)) * kSteps + step(b);
  const auto middle = [](int at) {
    return (static_cast<float>(at) + 0.5F) / static_cast<float>(kPaletteSize);
  };
  return {middle(index % kPaletteSize), middle(index / kPaletteSize)};
}

}  // namespace tether::sim
