#pragma once

#include "private_folder.h"
#include "x_server.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include <tether/base/time.h>
#include <tether/os/child_process.h>
#include <tether/sim_gazebo/gazebo_install.h>
#include <tether/sim_protocol/connection.h>

namespace tether::sim {

/// What to start.
struct GazeboRun {
  GazeboInstall install;
  std::filesystem::path world;  ///< absolute
  bool draws = false;           ///< somebody may ask for a picture
  std::filesystem::path log;    ///< gets what gzserver and the X server print
  std::stop_token stop{};       ///< ends the waiting for it
};

/// A gzserver with Tether's plugin in it, and an X server where it draws, for one run. Several at
/// once do not meet. They end with the object, and with this process however that ends. Their
/// files are in a folder of /tmp; if this process is killed, the next run removes it. Not
/// thread-safe.
class GazeboServer {
 public:
  /// Starts them. @throws Error(kSetup) saying what is missing, or what happened.
  explicit GazeboServer(GazeboRun run);
  ~GazeboServer();
  GazeboServer(const GazeboServer&) = delete;
  GazeboServer& operator=(const GazeboServer&) = delete;

  /// Waits for the plugin. @throws Error(kSetup) when one of them ends, nobody answers in time
  /// (TETHER_GAZEBO_START_LIMIT_S), or a stop is requested.
  std::unique_ptr<protocol::Connection> connect();
  /// How long the plugin may still take to open the world.
  Duration start_limit() const;

  /// Why the world will not come up, as far as one can see that; none: it may.
  std::optional<std::string> why_not_up();

  /// How one of them ended; none while all run.
  std::optional<std::string> lost();
  /// After it failed: what came of them that `said` does not say yet, with "; " before; empty:
  /// nothing is known.
  std::string post_mortem(const std::string& said);
  /// To be called once the world is open.
  /// @throws Error(kSetup) when there was something in it that it could not read or load.
  void check_world();

 private:
  void start_gzserver();
  void wait_for_display();
  bool has_port_in_use();
  void look() const;
  std::optional<std::string> end_beyond(const std::string& said);
  std::string last_words(const os::ChildExit& exit) const;
  [[noreturn]] void fail(const std::string& what) const;

  GazeboRun run_;
  Duration limit_;
  std::string users_master_;  // URI, or empty
  std::chrono::steady_clock::time_point started_;
  PrivateFolder folder_;
  std::unique_ptr<XServer> x_server_;
  std::unique_ptr<os::ChildProcess> gzserver_;
  std::string master_;           // its URI
  std::size_t said_before_ = 0;  // size of the log when gzserver was started, or the world open
};

}  // namespace tether::sim
