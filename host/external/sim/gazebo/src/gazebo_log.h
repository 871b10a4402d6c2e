#pragma once

#include <string>
#include <vector>

namespace tether::sim {

/// The output of gzserver as data. Only its parser knows how Gazebo and its libraries write. All
/// texts are one line without colours; empty: there is none.
struct GazeboLog {
  enum class Writer { kGazebo, kPlugin, kSdfReader };
  /// The last line that may be the reason why it ended: no message, no warning, and nothing about a
  /// missing sound card. Without the prefix of Tether's plugin.
  std::string last_line;
  Writer last_writer = Writer::kGazebo;
  /// Why it continues without a plugin, Tether's or one of the world's.
  std::string plugin_error;
  /// Why it cannot draw. Xlib ends a program from within after an error, and Gazebo may hang then.
  std::string drawing_error;
  /// What it could not read of the world and its includes: SDF and meshes.
  std::vector<std::string> reading_errors;
  /// Whether it could not bind the port of its master.
  bool has_port_in_use = false;
};

GazeboLog parse_gazebo_log(const std::string& text);

}  // namespace tether::sim
