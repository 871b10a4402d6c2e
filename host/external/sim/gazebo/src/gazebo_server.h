#pragma once

#include "gazebo_log.h"
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
#include <tether/sim_gazebo/gazebo_simulator.h>
#include <tether/sim_protocol/connection.h>

namespace tether::sim {

/// What to start.
struct GazeboRun {
  GazeboInstall install;
  std::filesystem::path world;  ///< absolute
  bool draws = false;           ///< pictures may be requested
  std::filesystem::path log;    ///< for the output of gzserver and the X server
  std::stop_token stop{};       ///< ends all waiting
};

/// A gzserver with Tether's plugin, and an X server if it draws, for one run. Parallel ones are
/// independent. They end with the object, and with this process however that ends. Their files are
/// in a folder of /tmp; if this process is killed, the next run removes it. Not thread-safe.
class GazeboServer {
 public:
  /// Starts them. @throws Error(kSetup) with the missing part, or the reason.
  explicit GazeboServer(GazeboRun run);
  ~GazeboServer();
  GazeboServer(const GazeboServer&) = delete;
  GazeboServer& operator=(const GazeboServer&) = delete;

  /// Waits for the plugin. @throws Error(kSetup) if one of them ends, there is no answer in time
  /// (TETHER_GAZEBO_START_LIMIT_S), or a stop is requested.
  std::unique_ptr<protocol::Connection> connect();
  /// Time left for the plugin to open the world.
  Duration start_limit() const;

  /// The reason why the world will not open, if one is known.
  std::optional<std::string> why_not_up();

  /// How one of them ended; none while all run. The caller reports it.
  std::optional<std::string> lost();
  /// After a failure of the simulator's session: what is known of their end and was not reported by
  /// `lost` or `why_not_up`, with "; " before; empty: nothing.
  std::string post_mortem();
  /// To be called once the world is open.
  /// @throws Error(kSetup) if Gazebo could not read or load a part of it.
  void check_world();

 private:
  void start_gzserver();
  void wait_for_display();
  void look() const;
  /// Of everything, and since gzserver was started or the world was open.
  GazeboLog whole_log() const;
  GazeboLog new_log() const;
  /// What the failure of the session has reported already.
  enum class KnownReason { kNone, kOfPlugin };
  std::optional<std::string> describe_end(KnownReason known);
  [[noreturn]] void fail(const std::string& what) const;

  GazeboRun run_;
  Duration limit_;
  std::string users_master_;  // URI, or empty
  std::chrono::steady_clock::time_point started_;
  PrivateFolder folder_;
  std::unique_ptr<XServer> x_server_;
  std::unique_ptr<os::ChildProcess> gzserver_;
  std::string master_;         // its URI
  std::size_t log_begin_ = 0;  // size of the log when gzserver was started, or the world open
  bool is_end_reported_ = false;
};

}  // namespace tether::sim
