// A file is a companion if its name occurs in the mesh file, whatever the format.

#include "files/mesh_companions.h"

#include "files/lookups.h"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include <tether/base/text.h>

namespace tether::sim {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kLargestMesh = std::uintmax_t{1} << 29;
const std::set<std::string, std::less<>> kTypes = {".png", ".jpg", ".jpeg", ".mtl", ".bin"};

/// As a URI has it.
std::string without_blanks(const std::string& name) {
  std::string uri;
  for (const char c : name) uri += c == ' ' ? "%20" : std::string(1, c);
  return uri;
}

std::vector<fs::path> folders_around(const fs::path& mesh) {
  const fs::path own = mesh.parent_path(), above = own.parent_path();
  std::vector<fs::path> folders{own};
  for (const fs::path& entry : entries_of(own))
    if (is_folder(entry)) folders.push_back(entry);
  for (const fs::path& base : {above, above.parent_path()}) {
    folders.push_back(base / "materials/textures");
    folders.push_back(base / "textures");
  }
  folders.push_back(above);
  return folders;
}

void add_named(const std::string& text, const std::vector<fs::path>& folders,
               std::vector<fs::path>& found) {
  std::set<std::string> names;
  for (const fs::path& folder : folders) {
    for (const fs::path& file : entries_of(folder)) {
      const std::string name = lower_case(file.filename().string());
      if (!kTypes.contains(lower_case(file.extension().string())) || names.contains(name)) continue;
      const bool is_named = text.find(name) != std::string::npos ||
                            text.find(without_blanks(name)) != std::string::npos;
      if (!is_named || !is_file(file)) continue;
      names.insert(name);
      if (std::ranges::find(found, file) == found.end()) found.push_back(file);
    }
  }
}

}  // namespace

std::vector<fs::path> mesh_companions(const fs::path& mesh) {
  std::vector<fs::path> found;
  if (lower_case(mesh.extension().string()) == ".stl") return found;  // names no files
  const std::vector<fs::path> folders = folders_around(mesh);
  add_named(lower_case(read_file(mesh, kLargestMesh)), folders, found);
  for (std::size_t i = 0; i < found.size(); ++i)
    if (lower_case(found[i].extension().string()) == ".mtl")
      add_named(lower_case(read_file(found[i], kLargestMesh)), folders, found);
  return found;
}

}  // namespace tether::sim
