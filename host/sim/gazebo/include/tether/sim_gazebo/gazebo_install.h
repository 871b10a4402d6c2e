#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tether/os/child_process.h>

namespace tether::sim {

/// Gazebo 11 as this machine has it.
struct GazeboInstall {
  std::vector<std::string> command;  ///< what starts gzserver, up to its own options
  os::Environment environment;       ///< that it needs to find what is its own
  std::filesystem::path gzserver;
  std::filesystem::path plugin;
  /// Both, for whoever asks what a result rests on.
  std::vector<std::filesystem::path> files() const { return {gzserver, plugin}; }
};

/// A Debian root with Gazebo in it (docs/guide/gazebo.md): TETHER_GAZEBO_ROOT, else gazebo-root in
/// the folder of the builds, else /var/lib/tether/gazebo-root; programs of it run by its own
/// loader. Where there is no root, this system's gzserver. The plugin: TETHER_GAZEBO_PLUGIN, else
/// that of the builds, else the installed one.
/// @throws Error(kSetup) saying what is missing, where it was looked for, and how to get it.
GazeboInstall find_gazebo();

}  // namespace tether::sim
