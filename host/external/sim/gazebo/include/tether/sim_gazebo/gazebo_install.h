#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tether/os/child_process.h>

namespace tether::sim {

/// The installation of Gazebo 11 on this machine.
struct GazeboInstall {
  std::vector<std::string> command;  ///< starts gzserver; its options follow
  os::Environment environment;       ///< with which it finds its own files
  std::filesystem::path gzserver;
  std::filesystem::path plugin;
  /// The files that a result depends on.
  std::vector<std::filesystem::path> files() const { return {gzserver, plugin}; }
};

/// Uses a Debian root with Gazebo (docs/guide/gazebo.md): TETHER_GAZEBO_ROOT, else gazebo-root in
/// the folder of the builds, else /var/lib/tether/gazebo-root; its programs run with its own
/// loader. Without a root, this system's gzserver. The plugin: TETHER_GAZEBO_PLUGIN, else that of
/// the builds, else the installed one.
/// @throws Error(kSetup) about the missing part, with the places searched and how to install it.
GazeboInstall find_gazebo();

}  // namespace tether::sim
