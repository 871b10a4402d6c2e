#include "build_id.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/link/codec.h>
#include <tether/os/text_file.h>

namespace tether::client {
namespace {

namespace fs = std::filesystem;
using Parts = std::vector<link::BuildPart>;

/// Larger files are known by their size only: to read them would take seconds.
constexpr std::uintmax_t kLargestRead = 256u << 20;
/// How far the folder of a script is searched for modules.
constexpr int kMostVisited = 2000, kDeepest = 4;
constexpr std::array<std::string_view, 6> kScripts = {".py", ".lua", ".js", ".rb", ".pl", ".jl"};

/// None: it is not a regular file that can be read.
std::optional<std::string> content_of(const fs::path& file) try {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return std::nullopt;
  if (size > kLargestRead) return std::to_string(size) + " bytes";
  return os::digest_of_file(file);
} catch (const Error&) {
  return std::nullopt;
}

/// A text of the limited length that still differs if the whole one does.
std::string shortened(const std::string& text) {
  constexpr std::size_t kShown = link::kMaxNameBytes - 32;
  if (text.size() <= link::kMaxNameBytes) return printable(text);
  return printable(text.substr(0, kShown)) + "... " + os::digest_of(text);
}

/// Files with the script's ending in its folder and below, as they are named there.
Parts modules_of(const fs::path& script) {
  Parts modules;
  std::error_code error;
  fs::path folder = script.parent_path();
  if (folder.empty()) folder = ".";
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error);
  for (int visited = 0;
       !error && at != fs::recursive_directory_iterator() && visited < kMostVisited;
       at.increment(error), ++visited) {
    const std::string name = at->path().filename();
    if (name.starts_with('.') || at.depth() >= kDeepest) at.disable_recursion_pending();
    std::error_code ignored;
    if (at->path().extension() != script.extension() || fs::equivalent(*at, script, ignored))
      continue;
    if (const auto content = content_of(*at))
      modules.push_back({"module " + shortened(at->path().lexically_relative(folder)), *content});
  }
  std::ranges::sort(modules, {}, &link::BuildPart::name);
  return modules;
}

/// `fly.py` and `--model=net.onnx` name files.
std::optional<link::BuildPart> file_in(const std::string& argument, fs::path& file) {
  for (const std::string& name : {argument, argument.substr(argument.find('=') + 1)}) {
    const auto content = content_of(name);
    if (!content) continue;
    file = name;
    const std::string before = argument.substr(0, argument.size() - name.size());
    return link::BuildPart{
        "", shortened(before + "file " + file.filename().string()) + ", content " + *content};
  }
  return std::nullopt;
}

/// Puts what is beyond the limits into one part.
Parts within_limits(Parts parts) {
  std::size_t bytes = 0, kept = 0;
  for (; kept < parts.size() && kept + 1 < link::kMaxBuildParts; ++kept) {
    bytes += parts[kept].name.size() + parts[kept].value.size();
    if (bytes > link::kMaxBuildBytes) break;
  }
  if (kept == parts.size()) return parts;
  std::string rest;
  for (std::size_t i = kept; i < parts.size(); ++i) rest += parts[i].name + parts[i].value + '\n';
  parts.resize(kept);
  parts.push_back({"further files and libraries", os::digest_of(rest)});
  return parts;
}

}  // namespace

std::vector<std::string> own_arguments() {
  std::vector<std::string> words;
  std::string all = os::read_whole("/proc/self/cmdline");
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find('\0', at), all.size());
    words.push_back(all.substr(at, end - at));
    at = end + 1;
  }
  if (!words.empty()) words.erase(words.begin());
  return words;
}

Parts build_parts(const std::vector<std::string>& arguments,
                  const std::vector<LoadedLibrary>& libraries) {
  Parts parts = {{"number of arguments", std::to_string(arguments.size())}}, modules;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    link::BuildPart part{"", shortened(arguments[i])};
    fs::path file;
    if (auto named = file_in(arguments[i], file)) part = std::move(*named);
    part.name = "argument " + std::to_string(i + 1);
    parts.push_back(std::move(part));
    if (modules.empty() && std::ranges::count(kScripts, file.extension().string()) > 0)
      modules = modules_of(file);
  }
  parts.insert(parts.end(), modules.begin(), modules.end());
  for (const LoadedLibrary& library : libraries) {
    std::string name = shortened("library " + fs::path(library.file).filename().string());
    if (std::ranges::count(parts, name, &link::BuildPart::name) > 0)
      name = shortened("library " + library.file);
    const std::string id =
        library.build_id.empty() ? content_of(library.file).value_or("unknown") : library.build_id;
    parts.push_back({std::move(name), id});
  }
  return within_limits(std::move(parts));
}

}  // namespace tether::client
