#include "include_rules.h"

#include "code_scanner.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string_view>

namespace tether::layout {
namespace {

using Breaches = std::vector<std::string>;

std::string place(const SourceFile& file, int line) {
  return file.path + ":" + std::to_string(line) + ": ";
}

/// "tether/sim_testing/fake.h" → "sim_testing"; empty for what is not Tether's.
std::string own_library(const std::string& include) {
  constexpr std::string_view kPrefix = "tether/";
  if (!include.starts_with(kPrefix)) return {};
  // The headers that users install have no folder of their own.
  if (include.find('/', kPrefix.size()) == std::string::npos) return "client_c_api";
  return include.substr(kPrefix.size(), include.find('/', kPrefix.size()) - kPrefix.size());
}

std::string without_testing(std::string library) {
  constexpr std::string_view kSuffix = "_testing";
  if (library.ends_with(kSuffix)) library.resize(library.size() - kSuffix.size());
  return library;
}

bool is_fake(const std::string& include) {
  return own_library(include).ends_with("_testing") ||
         include.find("/testing/") != std::string::npos;
}

/// Headers of the standard library have neither a slash nor a dot, but for those of C; no third
/// party that we use goes without both.
bool is_standard(const std::string& include) {
  if (include == "stddef.h" || include == "stdint.h") return true;
  return include.find_first_of("./") == std::string::npos;
}

template <class Check>
Breaches for_each_include(const std::vector<SourceFile>& files, Check check) {
  Breaches breaches;
  for (const SourceFile& file : files) {
    for (const Include& include : includes(file.text)) {
      const std::string wrong = check(file, include);
      if (!wrong.empty()) breaches.push_back(place(file, include.line) + wrong);
    }
  }
  return breaches;
}

Breaches check_words(const SourceFile& file, const std::vector<std::string>& words,
                     const std::string& why) {
  Breaches breaches;
  const std::string code = strip(file.text);
  for (const std::string& word : words) {
    for (const int line : lines_with_word(code, word))
      breaches.push_back(place(file, line) + "'" + word + "': " + why);
  }
  return breaches;
}

void append(Breaches& to, const Breaches& more) {
  to.insert(to.end(), more.begin(), more.end());
}

std::map<std::string, std::set<std::string>> actual_dependencies(
    const std::vector<SourceFile>& files) {
  std::map<std::string, std::set<std::string>> edges;
  for (const SourceFile& file : files) {
    if (file.library.empty() || !file.is_product()) continue;
    for (const Include& include : includes(file.text)) {
      const std::string to = own_library(include.path);
      if (!to.empty() && to != file.library) edges[file.library].insert(to);
    }
  }
  return edges;
}

}  // namespace

const std::map<std::string, std::set<std::string>>& allowed_dependencies() {
  static const std::map<std::string, std::set<std::string>> kArrows = {
      {"base", {}},
      {"os", {"base"}},
      {"stats", {}},
      {"toml", {"base", "os"}},
      {"uav", {"base"}},
      {"sync", {"base"}},
      {"link", {"base", "uav"}},
      {"client", {"base", "os", "uav", "link"}},
      {"client_c_api", {"base", "uav", "link", "client"}},
      {"supervisor", {"base", "os", "link", "client"}},
      {"devices", {"base", "os", "uav", "client"}},
      {"vision", {"base", "uav"}},
      {"tasks", {"base", "stats", "uav", "client", "vision"}},
      {"calibration", {"base", "os", "stats", "toml", "uav", "client", "vision", "tasks"}},
      {"rig", {"base", "stats", "toml", "uav", "client", "vision", "tasks", "devices"}},
      {"record", {"base"}},
      {"audit", {"base", "record"}},
      {"sim", {"base", "uav"}},
      {"sim_sdf", {"base", "uav", "sim"}},
      {"sim_sensing", {"base", "uav", "sim"}},
      {"sim_mujoco", {"base", "uav", "sim", "sim_sdf", "sim_sensing"}},
      {"sim_protocol", {"base", "uav", "link"}},
      {"sim_gazebo_plugin", {"base", "uav", "sim_protocol"}},
      {"sim_remote", {"base", "uav", "link", "sim", "sim_sensing", "sim_protocol"}},
      {"sim_gazebo", {"base", "os", "link", "sim", "sim_protocol", "sim_remote", "uav"}},
      {"coordinator", {"base", "uav", "sync", "sim", "link", "record"}},
      {"scenario", {"base", "os", "toml", "uav", "sim", "sim_sdf"}},
      {"board", {"base", "os", "record", "scenario"}},
      {"campaign", {"base", "board", "os", "uav", "scenario", "record"}},
      {"runner",
       {"audit", "base", "board", "campaign", "coordinator", "link", "os", "record", "scenario",
        "sim", "sim_sdf", "sync", "uav"}},
      {"report", {"base", "os", "stats", "uav", "record", "scenario", "campaign"}},
  };
  return kArrows;
}

Breaches check_arrows(const std::vector<SourceFile>& files) {
  return for_each_include(files, [](const SourceFile& file, const Include& include) -> std::string {
    const std::string to = without_testing(own_library(include.path));
    if (is_fake(include.path) && file.is_product())
      return "product code includes the fake <" + include.path + ">";
    if (file.library.empty() || to.empty()) return {};
    const auto arrows = allowed_dependencies().find(file.library);
    if (arrows == allowed_dependencies().end())
      return "library '" + file.library + "' has no line in the table of arrows";
    if (to == file.library || arrows->second.contains(to)) return {};
    return "'" + file.library + "' may not include '" + to + "' (<" + include.path + ">)";
  });
}

Breaches check_cycles(const std::vector<SourceFile>& files) {
  const auto edges = actual_dependencies(files);
  Breaches breaches;
  std::vector<std::string> path;
  std::set<std::string> done;
  const std::function<void(const std::string&)> visit = [&](const std::string& library) {
    const auto seen = std::find(path.begin(), path.end(), library);
    if (seen != path.end()) {
      std::string cycle;
      for (auto it = seen; it != path.end(); ++it) cycle += *it + " -> ";
      breaches.push_back("cycle: " + cycle + library);
      return;
    }
    if (done.contains(library)) return;
    path.push_back(library);
    if (const auto next = edges.find(library); next != edges.end())
      std::for_each(next->second.begin(), next->second.end(), visit);
    path.pop_back();
    done.insert(library);
  };
  for (const auto& [library, next] : edges) visit(library);
  return breaches;
}

Breaches check_public_headers(const std::vector<SourceFile>& files) {
  Breaches breaches =
      for_each_include(files, [](const SourceFile& file, const Include& include) -> std::string {
        if (file.role != Role::kPublicHeader) return {};
        if (include.quoted)
          return "a public header quotes \"" + include.path + "\"; write <tether/...>";
        if (is_standard(include.path) || !own_library(include.path).empty()) return {};
        return "a public header shows the third-party <" + include.path + ">; keep it in src/";
      });
  for (const SourceFile& file : files) {
    if (file.is_header() && !file.text.starts_with("#pragma once"))
      breaches.push_back(place(file, 1) + "no #pragma once on line 1");
  }
  return breaches;
}

Breaches check_private_headers(const std::vector<SourceFile>& files) {
  std::set<std::string> paths;
  for (const SourceFile& file : files) paths.insert(file.path);
  return for_each_include(
      files, [&](const SourceFile& file, const Include& include) -> std::string {
        if (file.role == Role::kOther) return {};
        if (!include.quoted || include.path.ends_with("_generated.h")) return {};
        if (include.path.find("..") != std::string::npos)
          return "\"" + include.path + "\" climbs out of its folder";
        // Next to the file, or below src/ (which the library's tests see too), or below the folder
        // of the program.
        for (std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
             folder.has_relative_path(); folder = folder.parent_path()) {
          if (!folder.has_parent_path()) break;
          if (paths.contains((folder / include.path).generic_string())) return {};
          if (paths.contains((folder / "src" / include.path).generic_string())) return {};
        }
        return "\"" + include.path + "\" is no file of this folder";
      });
}

Breaches check_sync_is_pure(const std::vector<SourceFile>& files) {
  static const std::set<std::string> kBanned = {
      "thread",     "mutex",     "shared_mutex", "condition_variable",
      "future",     "semaphore", "latch",        "barrier",
      "stop_token", "atomic",    "fstream",      "iostream",
      "ostream",    "istream",   "sstream",      "cstdio",
      "filesystem", "ctime",     "random"};
  static const std::vector<std::string> kWords = {
      "steady_clock",  "system_clock", "high_resolution_clock",
      "clock_gettime", "sleep_for",    "sleep_until",
      "this_thread",   "printf",       "fopen",
      "socket",        "getenv",       "rand"};
  Breaches breaches =
      for_each_include(files, [](const SourceFile& file, const Include& include) -> std::string {
        if (file.library != "sync" || !file.is_product() || include.quoted) return {};
        if (is_standard(include.path) && !kBanned.contains(include.path)) return {};
        if (!own_library(include.path).empty()) return {};
        return "sync is pure logic; it has no use for <" + include.path + ">";
      });
  for (const SourceFile& file : files) {
    if (file.library == "sync" && file.is_product())
      append(breaches, check_words(file, kWords, "sync is pure logic"));
  }
  return breaches;
}

Breaches check_coordinator_is_neutral(const std::vector<SourceFile>& files) {
  static const std::vector<std::string> kWords = {
      "mujoco",     "Mujoco",           "MuJoCo",     "gazebo",
      "Gazebo",     "sim_mujoco",       "sim_gazebo", "make_mujoco_simulator",
      "FaceAnchor", "RelativePosition", "tasks",      "vision"};
  Breaches breaches;
  for (const SourceFile& file : files) {
    if (file.library != "coordinator" || !file.is_product()) continue;
    append(breaches, check_words(file, kWords, "the coordinator names no task and no back end"));
  }
  return breaches;
}

Breaches check_randomness(const std::vector<SourceFile>& files) {
  static const std::vector<std::string> kWords = {
      "rand",          "srand",     "mt19937",   "mt19937_64", "default_random_engine",
      "random_device", "getrandom", "getentropy"};
  Breaches breaches;
  for (const SourceFile& file : files) {
    const bool token = file.path.starts_with("common/link/src/token");
    if (file.is_product() && !token)
      append(breaches, check_words(file, kWords, "draw by key instead (tether/base/random.h)"));
  }
  return breaches;
}

}  // namespace tether::layout
