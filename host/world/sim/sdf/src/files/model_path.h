#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tether::sim {

/// Where the URIs of a world's files lead. The environment is read when it is made.
class ModelPath {
 public:
  /// @param world the world's or UAV's own file
  /// @param model_folders searched for model:// after the environment's
  ModelPath(const std::filesystem::path& world,
            const std::vector<std::filesystem::path>& model_folders);

  /// What of the environment decides where URIs lead.
  static std::string environment();

  /// The file or folder that `uri` means in the file `from`; none if there is nothing.
  ///
  /// A path is relative to `from`, else to the world, the folder above it, the environment's
  /// folders and the folders above these; one name alone is also that of a model. model://NAME is
  /// searched for in models/ and
  /// ../models/ next to these two, beside them, in the folders of GZ_SIM_RESOURCE_PATH,
  /// IGN_GAZEBO_RESOURCE_PATH, GAZEBO_MODEL_PATH and SDF_PATH, in the model folders, and in Fuel's
  /// caches (GZ_FUEL_CACHE_PATH, IGN_FUEL_CACHE_PATH, ~/.gz/fuel, ~/.ignition/fuel), which are the
  /// only place for https://HOST/1.0/OWNER/models/NAME[/VERSION[/files/FILE]]. Without VERSION, the
  /// highest one in the cache is meant.
  std::optional<std::filesystem::path> find(const std::string& uri,
                                            const std::filesystem::path& from) const;

  /// What to do about a URI in the file `from` that leads nowhere: the end of an error message,
  /// with the name that was probably meant.
  std::string advice_on_missing(const std::string& uri, const std::filesystem::path& from) const;

 private:
  std::vector<std::filesystem::path> folders_of_files(const std::filesystem::path& from) const;
  std::vector<std::filesystem::path> folders_of_models(const std::filesystem::path& from) const;

  std::filesystem::path world_;
  std::vector<std::filesystem::path> model_folders_;
  std::vector<std::filesystem::path> fuel_caches_;
};

/// The SDF file of a model's folder, of the latest version that libsdformat reads, as model.config
/// says; empty if there is none. @param version the latest, such as "1.9"
std::filesystem::path sdf_file_of(const std::filesystem::path& model_folder,
                                  const std::string& latest_version);

}  // namespace tether::sim
