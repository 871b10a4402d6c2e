#pragma once

#include "process.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <tether/sim_protocol/connection.h>

namespace tether::system_test {

/// Why Gazebo and the plugin cannot be started; none: scripts/gazebo-root has made both. Where CI
/// is set, that is a failure of the test.
std::optional<std::string> no_gzserver();

/// An X server that draws by software, on a display of its own.
class XServer {
 public:
  /// @throws std::runtime_error when it does not come up.
  XServer();
  /// ":7"
  const std::string& display() const { return display_; }

 private:
  std::unique_ptr<Process> process_;
  std::string display_;
};

/// gzserver with Tether's plugin, in one world.
class Gzserver {
 public:
  /// `display` empty: none.
  Gzserver(const std::filesystem::path& world, const std::string& display);

  /// @throws std::runtime_error with the output of gzserver if it does not listen within a minute.
  std::unique_ptr<sim::protocol::Connection> connect();
  const std::filesystem::path& socket() const { return socket_; }
  Process& process() { return *process_; }

 private:
  ScratchFolder folder_;
  std::filesystem::path socket_;
  std::unique_ptr<Process> process_;
};

}  // namespace tether::system_test
