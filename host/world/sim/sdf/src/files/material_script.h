#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include <tether/uav/math.h>

namespace tether::sim {

/// A material of Gazebo's scripts (.material files, as Ogre has them): what its first technique
/// says of colours and its first texture. What it does not say is as in its base, else Ogre's.
struct ScriptMaterial {
  std::optional<uav::Vec3> ambient_rgb{}, diffuse_rgb{}, specular_rgb{}, emissive_rgb{};
  std::optional<double> alpha{};  ///< only if it blends
  std::string texture{};          ///< a file name; empty: none
  double texture_scale_x = 1.0;   ///< of the texture: 0.5 shows it twice
  double texture_scale_y = 1.0;
  bool is_double_sided = false;
};
using ScriptMaterials = std::map<std::string, ScriptMaterial, std::less<>>;

/// Adds the materials of a script's text to `materials`; a base is one of these or of Gazebo's own.
/// What cannot be read of it is skipped, as Ogre does.
void read_script(const std::string& text, ScriptMaterials& materials);

/// Gazebo's own material of that name ("Gazebo/Wood"); nullptr if it has none. Its `texture` is one
/// of the shipped model `textures`, and its colours are the mean ones, for where that is not found.
const ScriptMaterial* gazebo_material(const std::string& name);

}  // namespace tether::sim
