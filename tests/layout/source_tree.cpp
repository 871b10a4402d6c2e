#include "source_tree.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>

namespace tether::layout {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  for (const fs::path& part : fs::path(path)) parts.push_back(part.string());
  return parts;
}

/// Folders of libraries: those of both sides, of the target's and of the host's.
bool is_side(const std::string& folder) {
  return folder == "common" || folder == "target" || folder == "host";
}

std::optional<Role> library_role(const std::string& folder) {
  if (folder == "include") return Role::kPublicHeader;
  if (folder == "src") return Role::kSource;
  if (folder == "testing") return Role::kTesting;
  if (folder == "test") return Role::kTest;
  return std::nullopt;
}

bool is_skipped_folder(const std::string& name) {
  static const std::set<std::string> kSkipped = {"build", "out", "node_modules"};
  return kSkipped.contains(name) || name.starts_with("build-") ||
         (name.starts_with('.') && name != ".ci");
}

bool is_text(const fs::path& file) {
  static const std::set<std::string> kExtensions = {
      "",     ".h",  ".hpp",  ".c",   ".cpp",  ".cmake", ".txt", ".md",   ".toml", ".sdf", ".fbs",
      ".mjs", ".js", ".json", ".yml", ".yaml", ".in",    ".map", ".supp", ".1",    ".3"};
  return kExtensions.contains(file.extension().string());
}

template <class Keep>
std::vector<fs::path> walk(const fs::path& root, Keep keep) {
  std::vector<fs::path> found;
  for (auto it = fs::recursive_directory_iterator(root); it != fs::recursive_directory_iterator();
       ++it) {
    if (it->is_directory() && is_skipped_folder(it->path().filename().string())) {
      it.disable_recursion_pending();
    } else if (it->is_regular_file() && keep(it->path())) {
      found.push_back(it->path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

SourceFile classify(const std::string& path) {
  SourceFile file;
  file.path = path;
  const std::vector<std::string> parts = parts_of(path);
  if (parts.front() == "apps") {
    const bool is_test = std::find(parts.begin(), parts.end(), "test") != parts.end();
    file.role = is_test ? Role::kTest : Role::kProgram;
  }
  if (!is_side(parts.front())) return file;
  // The library's name is the folders between its side and the first of include, src, test,
  // testing.
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (const auto role = library_role(parts[i])) {
      file.role = *role;
      break;
    }
    file.library += (file.library.empty() ? "" : "_") + parts[i];
  }
  return file;
}

std::vector<SourceFile> read_sources(const fs::path& root) {
  std::vector<SourceFile> sources;
  for (const char* top : {"apps", "bench", "common", "host", "target", "tests"}) {
    const auto keep = [](const fs::path& file) {
      return file.extension() == ".h" || file.extension() == ".hpp" || file.extension() == ".cpp";
    };
    if (!fs::exists(root / top)) continue;
    for (const fs::path& file : walk(root / top, keep)) {
      sources.push_back(classify(fs::relative(file, root).generic_string()));
      sources.back().text = read_text(file);
    }
  }
  return sources;
}

std::vector<fs::path> text_files(const fs::path& root) {
  return walk(root, is_text);
}

std::string one_per_line(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& text : texts) joined += "\n" + text;
  return joined;
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace tether::layout
