// A URI is split into its scheme and the names after it; each scheme has its list of places. Fuel's
// caches are compared by name without case and percent signs, since its tools changed both.

#include "files/model_path.h"

#include "files/lookups.h"
#include "files/sdf_version_number.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include <tinyxml2.h>

#include <tether/base/text.h>

namespace tether::sim {

namespace fs = std::filesystem;

namespace {

constexpr const char* kWithout =
    ". To fly without it, leave out --strict (in a UAV's model: use --tolerant)";

constexpr std::array kModelVariables = {"GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH",
                                        "GAZEBO_MODEL_PATH", "SDF_PATH"};
constexpr std::array kFuelVariables = {"GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH"};

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, separator);) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

/// Empty if `uri` has another scheme.
std::string after_scheme(const std::string& uri, std::string_view scheme) {
  return uri.starts_with(scheme) ? uri.substr(scheme.size()) : "";
}

bool is_on_fuel(const std::string& uri) {
  return uri.starts_with("https://") || uri.starts_with("http://");
}

/// "Ground%20Plane" and "ground plane" are one name of Fuel's.
std::string fuel_name(const std::string& text) {
  return lower_case(unescaped(text));
}

/// The subfolders of that name, in order; all of them if the name is empty.
std::vector<fs::path> subfolders(const fs::path& folder, const std::string& name) {
  std::vector<fs::path> found = entries_of(folder);
  std::erase_if(found, [&](const fs::path& path) {
    return !is_folder(path) || (!name.empty() && fuel_name(path.filename()) != fuel_name(name));
  });
  return found;
}

/// 0: not a version.
int version_of(const fs::path& folder) {
  const std::string text = folder.filename();
  int version = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), version);
  return error == std::errc() && end == text.data() + text.size() ? version : 0;
}

/// A model on Fuel. Empty owner: any; version 0: the highest.
struct FuelModel {
  std::string owner;
  std::string name;
  int version = 0;
  fs::path file{};  ///< in the model's folder; empty: the folder itself
};

std::optional<fs::path> find_in(const fs::path& models, const FuelModel& model) {
  std::vector<fs::path> versions;
  for (const fs::path& folder : subfolders(models, model.name)) {
    for (const fs::path& version : subfolders(folder, "")) {
      const int number = version_of(version);
      if (number > 0 && (model.version == 0 || number == model.version))
        versions.push_back(version);
    }
  }
  if (versions.empty()) return std::nullopt;
  const fs::path newest = *std::ranges::max_element(versions, {}, version_of);
  const fs::path file = model.file.empty() ? newest : newest / model.file;
  return is_there(file) ? std::optional(file) : std::nullopt;
}

/// Fuel's two host names are one server.
std::optional<fs::path> find_in_caches(const std::vector<fs::path>& caches,
                                       const FuelModel& model) {
  for (const fs::path& cache : caches)
    for (const fs::path& host : subfolders(cache, ""))
      for (const fs::path& owner : subfolders(host, model.owner))
        if (const auto found = find_in(owner / "models", model)) return found;
  return std::nullopt;
}

/// https://HOST/1.0/OWNER/models/NAME[/VERSION][/files/FILE]. None: another address.
std::optional<FuelModel> parse_fuel(const std::string& uri) {
  std::vector<std::string> parts = split(uri.substr(uri.find("//") + 2), '/');
  const auto kind = std::ranges::find(parts, "models");
  if (kind == parts.begin() || parts.end() - kind < 2) return std::nullopt;
  FuelModel model{*(kind - 1), *(kind + 1)};
  auto rest = kind + 2;
  if (rest != parts.end() && *rest != "files") model.version = version_of(*rest++);
  if (rest != parts.end() && *rest == "files") ++rest;
  for (; rest != parts.end(); ++rest) model.file /= *rest;
  return model;
}

void add_surroundings(const fs::path& file, std::vector<fs::path>& folders) {
  const fs::path folder = file.parent_path();
  folders.insert(folders.end(), {folder / "models", folder.parent_path() / "models",
                                 folder.parent_path(), folder});
}

std::optional<fs::path> first_existing(const std::vector<fs::path>& folders,
                                       const std::string& path) {
  for (const fs::path& folder : folders)
    if (is_there(folder / path)) return folder / path;
  return std::nullopt;
}

/// The name beside `missing` that is most like its own; empty: none is.
std::string similar(const fs::path& missing) {
  std::vector<std::string> names;
  for (const fs::path& entry : entries_of(missing.parent_path())) names.push_back(entry.filename());
  return std::string(nearest(missing.filename().string(),
                             std::vector<std::string_view>(names.begin(), names.end())));
}

/// The path to the name that is most like the first part of `path` that is missing in the folder.
/// Empty: nothing is missing, or no name is like it.
std::string nearest_in(const fs::path& folder, const fs::path& path) {
  fs::path there;
  for (const fs::path& part : path) {
    if (!is_there(folder / there / part)) {
      const std::string meant = similar(folder / there / part);
      return meant.empty() ? "" : (there / meant).string();
    }
    there /= part;
  }
  return "";
}

}  // namespace

ModelPath::ModelPath(const fs::path& world, const std::vector<fs::path>& model_folders)
    : world_(world) {
  for (const char* name : kModelVariables) {
    for (std::string& folder : split(variable(name), ':')) model_folders_.emplace_back(folder);
  }
  model_folders_.insert(model_folders_.end(), model_folders.begin(), model_folders.end());
  for (const char* name : kFuelVariables)
    if (const std::string cache = variable(name); !cache.empty()) fuel_caches_.emplace_back(cache);
  if (const fs::path home = variable("HOME"); !home.empty()) {
    fuel_caches_.push_back(home / ".gz/fuel");
    fuel_caches_.push_back(home / ".ignition/fuel");
  }
}

std::string ModelPath::environment() {
  std::string all = variable("HOME");
  for (const char* name : kModelVariables) all += '\n' + variable(name);
  for (const char* name : kFuelVariables) all += '\n' + variable(name);
  return all;
}

std::optional<fs::path> ModelPath::find(const std::string& uri, const fs::path& from) const {
  if (is_on_fuel(uri)) {
    const auto model = parse_fuel(uri);
    return model ? find_in_caches(fuel_caches_, *model) : std::nullopt;
  }
  std::string path = after_scheme(uri, "model://");
  if (path.empty()) path = after_scheme(uri, "package://");
  if (path.empty()) {
    const std::string file = uri.starts_with("file://") ? uri.substr(7) : uri;
    const auto found = first_existing(folders_of_files(from), file);
    if (found || uri.find('/') != std::string::npos) return found;
    path = uri;
  }
  if (const auto found = first_existing(folders_of_models(from), path)) return found;
  const std::size_t slash = std::min(path.find('/'), path.size());
  return find_in_caches(fuel_caches_, {"", path.substr(0, slash), 0,
                                       fs::path(path.substr(std::min(slash + 1, path.size())))});
}

/// Gazebo's resource path often has the folder above the models: "file://models/NAME/…".
std::vector<fs::path> ModelPath::folders_of_files(const fs::path& from) const {
  const fs::path world = world_.parent_path();
  std::vector<fs::path> folders{from.parent_path(), world, world.parent_path()};
  for (const fs::path& models : model_folders_) {
    folders.push_back(models);
    folders.push_back((models / "").parent_path().parent_path());
  }
  return folders;
}

std::vector<fs::path> ModelPath::folders_of_models(const fs::path& from) const {
  std::vector<fs::path> folders;
  add_surroundings(from, folders);
  add_surroundings(world_, folders);
  folders.insert(folders.end(), model_folders_.begin(), model_folders_.end());
  return folders;
}

std::string ModelPath::advice_on_missing(const std::string& uri, const fs::path& from) const {
  if (is_on_fuel(uri)) {
    return "Fuel models are not fetched. Download it with `gz fuel download -u \"" +
           uri.substr(0, uri.find("/files/")) + "\"`" + std::string(kWithout);
  }
  const std::size_t scheme = uri.find("://");
  if (scheme == std::string::npos) {
    const std::string name = similar(from.parent_path() / uri);
    return (name.empty() ? "Correct the path" : "Did you mean '" + name + "'? Correct the path") +
           kWithout;
  }
  const fs::path path = uri.substr(scheme + 3);
  for (const fs::path& folder : folders_of_models(from))
    if (const std::string meant = nearest_in(folder, path); !meant.empty())
      return "Did you mean '" + uri.substr(0, scheme + 3) + meant + "', in " + folder.string() +
             kWithout;
  return "Put it next to the world or into its models/, add its folder to GZ_SIM_RESOURCE_PATH, "
         "or download it with `gz fuel download`" +
         std::string(kWithout);
}

fs::path sdf_file_of(const fs::path& model_folder, const std::string& latest_version) {
  const auto latest = parse_sdf_version(latest_version.c_str());
  tinyxml2::XMLDocument config;
  for (const char* name : {"model.config", "manifest.xml"}) {
    note_file(model_folder / name);
    if (config.LoadFile((model_folder / name).c_str()) == tinyxml2::XML_SUCCESS) break;
  }
  const auto* model = config.FirstChildElement("model");
  const auto* first = model != nullptr ? model->FirstChildElement("sdf") : nullptr;
  const auto version_of = [](const tinyxml2::XMLElement* sdf) {
    return parse_sdf_version(sdf->Attribute("version")).value_or(SdfVersion{});
  };
  const tinyxml2::XMLElement* best = nullptr;
  for (const auto* sdf = first; sdf != nullptr; sdf = sdf->NextSiblingElement("sdf")) {
    const bool is_better = best == nullptr || version_of(sdf) > version_of(best);
    if (is_better && version_of(sdf) <= latest) best = sdf;
  }
  if (best == nullptr) best = first;
  if (best == nullptr || best->GetText() == nullptr) return {};
  return model_folder / best->GetText();
}

}  // namespace tether::sim
