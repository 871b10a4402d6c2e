#include "convert/sdf_convert.h"
#include "files/lookups.h"
#include "files/material_script.h"

#include <set>
#include <vector>

namespace tether::sim {

namespace fs = std::filesystem;

using uav::Vec3;

namespace {

bool is_picture(const fs::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

void read_albedo_map(const SdfSource& source, const sdf::ElementPtr& element,
                     const WarningSink& warn, Material& material) {
  sdf::ElementPtr map = find_path(element, {"pbr", "metal", "albedo_map"});
  if (!map) map = find_path(element, {"pbr", "specular", "albedo_map"});
  if (!map || map->Get<std::string>().empty()) return;
  const fs::path file = source.find_resource(map, map->Get<std::string>());
  if (is_picture(file)) {
    material.albedo_map = file;
    material.albedo_map_at = source.where(map);
    return;
  }
  warn_at(source, map, Effect(Consequence::kLooksDifferent, true),
          "names '" + map->Get<std::string>() +
              (file.empty() ? "', which is not found; the colours are used"
                            : "', which is neither a PNG nor a JPEG file; the colours are used"),
          warn);
}

/// Where a <script> says that its materials and their pictures are.
struct ScriptPlaces {
  std::vector<fs::path> scripts;  ///< files
  std::vector<fs::path> folders;
};

ScriptPlaces places_of(const SdfSource& source, const sdf::ElementPtr& script) {
  ScriptPlaces places;
  for (sdf::ElementPtr uri = script->FindElement("uri"); uri; uri = uri->GetNextElement("uri")) {
    const auto found = source.find(uri, uri->Get<std::string>());
    if (!found) continue;  // as those of Gazebo's own materials
    const bool is_one = is_file(*found);
    if (is_one) places.scripts.push_back(*found);
    const fs::path folder = is_one ? found->parent_path() : *found;
    places.folders.push_back(folder);
    places.folders.push_back(folder.parent_path() / "textures");
    if (is_one) continue;
    for (const fs::path& entry : entries_of(folder))
      if (extension_of(entry) == ".material" && is_file(entry)) places.scripts.push_back(entry);
  }
  return places;
}

/// The picture of a script's material.
void read_texture(const SdfSource& source, const sdf::ElementPtr& script,
                  const ScriptMaterial& named, const ScriptPlaces& places, const WarningSink& warn,
                  Material& material) {
  for (const fs::path& folder : places.folders) {
    const fs::path file = folder / named.texture;
    if (!is_file(file) || !is_picture(file)) continue;
    material.albedo_map = source.use(file);
    material.albedo_map_at = source.where(script);
    return;
  }
  warn_at(source, script, Effect(Consequence::kLooksDifferent, true),
          "has the picture '" + named.texture +
              "', which is not found as a PNG or JPEG file; its colours are used",
          warn);
}

/// @return whether the material that a <script> names is found
bool read_script_material(const SdfSource& source, const sdf::ElementPtr& script,
                          const WarningSink& warn, Material& material) {
  const sdf::ElementPtr name = script->FindElement("name");
  if (!name) return false;
  const std::string wanted = name->Get<std::string>();
  const ScriptPlaces places = places_of(source, script);
  ScriptMaterials materials;
  for (const fs::path& file : places.scripts) read_script(source.read_resource(file), materials);
  const auto own = materials.find(wanted);
  const ScriptMaterial* const gazebo = gazebo_material(wanted);
  if (own == materials.end() && gazebo == nullptr) {
    warn_at(source, script, Effect(Consequence::kLooksDifferent, true),
            "names the material '" + wanted + "', which is not found", warn);
    return false;
  }
  const ScriptMaterial& named = own != materials.end() ? own->second : *gazebo;
  const Vec3 white{1.0, 1.0, 1.0};
  material.diffuse_rgb = named.diffuse_rgb.value_or(white);
  material.ambient_rgb = named.ambient_rgb.value_or(white);
  material.specular_rgb = named.specular_rgb.value_or(Vec3{});
  material.emissive_rgb = named.emissive_rgb.value_or(Vec3{});
  material.alpha = named.alpha.value_or(1.0);
  material.is_double_sided = named.is_double_sided;
  material.is_of_script = true;
  if (named.texture.empty()) return true;
  material.texture_repeat_x = 1.0 / named.texture_scale_x;
  material.texture_repeat_y = 1.0 / named.texture_scale_y;
  if (own != materials.end()) {
    read_texture(source, script, named, places, warn, material);
  } else if (const auto shipped = source.find(script, "model://textures/" + named.texture)) {
    material.albedo_map = source.use(*shipped);
    material.albedo_map_at = source.where(script);
  }
  return true;
}

void read_repeat(const SdfSource& source, const sdf::ElementPtr& element, Material& material) {
  if (!material.albedo_map.empty()) material.texture_repeat = TextureRepeat::kPerFace;
  const sdf::ElementPtr repeat = find_path(element, {"tether:texture_repeat"});
  if (!repeat) return;
  const std::vector<double> numbers = read_numbers(source, repeat, 2);
  if (numbers[0] <= 0.0 || numbers[1] <= 0.0) {
    refuse(source, repeat, "must be two numbers greater than 0: repetitions per metre");
  }
  material.texture_repeat = TextureRepeat::kPerMetre;
  material.texture_repeat_x = numbers[0];
  material.texture_repeat_y = numbers[1];
}

/// Colours not given: those of the script, else a texture shows as it is, an untextured surface is
/// grey, and ambient is diffuse.
/// @return whether it says anything about looks
bool read_material(const SdfSource& source, const sdf::Material& given, const WarningSink& warn,
                   Material& material) {
  const sdf::ElementPtr element = given.Element();
  const sdf::ElementPtr script = element->FindElement("script");
  const bool has_script = script && script->GetExplicitlySetInFile() &&
                          read_script_material(source, script, warn, material);
  read_albedo_map(source, element, warn, material);
  read_repeat(source, element, material);
  if (!has_script && !material.albedo_map.empty()) material.diffuse_rgb = {1.0, 1.0, 1.0};
  bool is_coloured = false;
  const auto take = [&](const char* name, const ignition::math::Color& colour, Vec3& rgb) {
    if (!element->HasElement(name)) return;
    rgb = to_vec3(colour);
    is_coloured = true;
  };
  take("diffuse", given.Diffuse(), material.diffuse_rgb);
  if (is_coloured) material.alpha = double{given.Diffuse().A()};
  if (!has_script) material.ambient_rgb = material.diffuse_rgb;
  take("ambient", given.Ambient(), material.ambient_rgb);
  take("specular", given.Specular(), material.specular_rgb);
  take("emissive", given.Emissive(), material.emissive_rgb);
  material.is_double_sided = material.is_double_sided || given.DoubleSided();
  return has_script || is_coloured || !material.albedo_map.empty();
}

}  // namespace

void read_look(const SdfSource& source, const sdf::Material* material, const WarningSink& warn,
               Visual& out) {
  const bool is_given = material != nullptr && read_material(source, *material, warn, out.material);
  const auto* const mesh = std::get_if<MeshGeometry>(&out.geometry);
  out.has_look_of_mesh = !is_given && mesh != nullptr && mesh->made == nullptr;
  if (out.has_look_of_mesh) out.material.diffuse_rgb = out.material.ambient_rgb = {1.0, 1.0, 1.0};
}

}  // namespace tether::sim
