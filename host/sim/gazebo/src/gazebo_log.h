#pragma once

#include <string>
#include <vector>

/// What gzserver says, on one line each, without colours.
namespace tether::sim {

/// The last line that may say why it ended: neither a message, nor a warning, nor what is said
/// where there is no sound card. Empty: none.
std::string last_words_of_gazebo(const std::string& log);

/// Why it goes on without a plugin, Tether's or one of the world's; empty: it does not.
std::string plugin_error(const std::string& log);

/// Why it cannot draw; empty: it has not said so. Xlib ends a program from within after an error,
/// and Gazebo may hang in that.
std::string drawing_error(const std::string& log);

/// What Gazebo could not read, of the world and what it includes: SDF and meshes.
std::vector<std::string> reading_errors(const std::string& log);

}  // namespace tether::sim
