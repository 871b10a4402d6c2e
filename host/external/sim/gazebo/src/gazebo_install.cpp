// Finds gzserver and Tether's plugin: variables of the user first, then the folder of the builds,
// then installed files. A Debian root's programs run with its own loader and libraries.

#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/os/child_process.h>
#include <tether/sim_gazebo/gazebo_simulator.h>

namespace tether::sim {

namespace {

namespace fs = std::filesystem;

constexpr const char* kGetIt = "scripts/gazebo-root of Tether's sources installs it";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// The list, followed by the user's value of the variable.
std::string before_users(const std::string& list, const char* name) {
  const std::string given = variable(name);
  return given.empty() ? list : list + ":" + given;
}

[[noreturn]] void fail(const std::string& subject, const std::string& what) {
  throw Error(ErrorCode::kSetup, what).about(subject);
}

fs::path own_folder() {
  return os::own_file().parent_path();
}

/// The folder of the builds: programs are in <builds>/<preset>/bin.
fs::path builds() {
  return own_folder().parent_path().parent_path();
}

bool is_file(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

/// The loader of the root's programs, in the folder of its machine's libraries; empty: none.
fs::path find_loader(const fs::path& root) {
  std::error_code error;
  for (fs::directory_iterator machine(root / "lib", error), end; !error && machine != end;
       machine.increment(error)) {
    std::error_code ignored;
    for (fs::directory_iterator file(machine->path(), ignored), last; !ignored && file != last;
         file.increment(ignored))
      if (file->path().filename().string().starts_with("ld-linux")) return file->path();
  }
  return {};
}

/// Debian's folders of libraries.
std::string library_path(const fs::path& root, const fs::path& machine) {
  const fs::path libraries = root / "usr/lib" / machine;
  std::vector<std::string> folders = {libraries, root / "lib" / machine, root / "usr/lib"};
  for (const char* inner :
       {"gazebo-11/plugins", "blas", "lapack", "OGRE-1.9.0", "pulseaudio", "libarmadillo"})
    folders.push_back(libraries / inner);
  folders.push_back(root / "usr/lib/libarmadillo");
  return fmt::format("{}", fmt::join(folders, ":"));
}

/// The root's gzserver with the root's loader, so that it uses none of this system's libraries.
GazeboInstall in_root(const fs::path& root, const fs::path& loader) {
  const fs::path gzserver = root / "usr/bin/gzserver", machine = loader.parent_path().filename();
  const fs::path libraries = root / "usr/lib" / machine;
  return {
      .command = {loader, "--library-path", library_path(root, machine), gzserver},
      .environment = {{"GAZEBO_RESOURCE_PATH",
                       before_users(root / "usr/share/gazebo-11", "GAZEBO_RESOURCE_PATH")},
                      {"GAZEBO_PLUGIN_PATH",
                       before_users(libraries / "gazebo-11/plugins", "GAZEBO_PLUGIN_PATH")},
                      {"OGRE_RESOURCE_PATH", libraries / "OGRE-1.9.0"},
                      {"LIBGL_DRIVERS_PATH", libraries / "dri"},
                      {"SDF_PATH", root / "usr/share/sdformat9"},
                      {"LD_LIBRARY_PATH", ""},
                      {"LD_PRELOAD", ""}},
      .gzserver = gzserver,
      .plugin = {},
  };
}

std::optional<GazeboInstall> try_root(const fs::path& root) {
  const fs::path loader = find_loader(root);
  if (loader.empty() || !is_file(root / "usr/bin/gzserver")) return std::nullopt;
  return in_root(fs::absolute(root).lexically_normal(), fs::absolute(loader).lexically_normal());
}

GazeboInstall on_system(const std::vector<fs::path>& roots) try {
  const fs::path gzserver = os::find_program("gzserver");
  return {.command = {gzserver}, .environment = {}, .gzserver = gzserver, .plugin = {}};
} catch (const Error&) {
  std::vector<std::string> places;
  for (const auto& root : roots) places.push_back(root.string());
  fail("gzserver",
       fmt::format("Gazebo 11 was not found: gzserver is neither in PATH nor in {}; {}, or set "
                   "TETHER_GAZEBO_ROOT",
                   fmt::join(places, " or "), kGetIt));
}

GazeboInstall find_gzserver() {
  if (const std::string given = variable("TETHER_GAZEBO_ROOT"); !given.empty()) {
    if (auto install = try_root(given)) return *install;
    fail("TETHER_GAZEBO_ROOT",
         fmt::format("TETHER_GAZEBO_ROOT is {}, which has no usr/bin/gzserver with its loader; {}",
                     given, kGetIt));
  }
  const std::vector<fs::path> roots = {builds() / "gazebo-root", "/var/lib/tether/gazebo-root"};
  for (const auto& root : roots)
    if (auto install = try_root(root)) return *install;
  return on_system(roots);
}

fs::path find_plugin() {
  constexpr const char* kPlugin = "libtether_gazebo.so";
  const std::string given = variable("TETHER_GAZEBO_PLUGIN");
  if (!given.empty() && is_file(given)) return fs::absolute(given);
  if (!given.empty())
    fail("TETHER_GAZEBO_PLUGIN",
         fmt::format("TETHER_GAZEBO_PLUGIN is {}, which does not exist", given));
  const fs::path built = builds() / "gazebo/lib" / kPlugin;
  const fs::path installed = own_folder().parent_path() / "lib/tether" / kPlugin;
  if (is_file(built)) return built;
  if (is_file(installed)) return installed;
  fail(kPlugin,
       fmt::format("Tether's plugin for Gazebo was not found: neither {} nor {} exists; {}",
                   built.string(), installed.string(), kGetIt));
}

}  // namespace

GazeboInstall find_gazebo() {
  GazeboInstall install = find_gzserver();
  install.plugin = find_plugin();
  return install;
}

}  // namespace tether::sim
