#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/os/child_process.h>
#include <tether/sim/simulator.h>
#include <tether/sim/world.h>

namespace tether::sim {

class GazeboServer;

/// How Gazebo is started.
struct GazeboSetup {
  Duration answer_limit{0};   ///< time limit of an answer
  std::filesystem::path log;  ///< for the output of its processes
  WarningSink warn;
  std::function<void(const std::string&)> on_silence{};  ///< called while an answer is late
  std::stop_token stop{};                                ///< ends all waiting
};

/// Gazebo 11 with a world open in it, for one run. Its processes end with the object. Not
/// thread-safe.
class GazeboSimulator {
 public:
  /// Starts it. @throws Error(kSetup) with the reason if it cannot be started.
  GazeboSimulator(World world, const GazeboSetup& setup);
  ~GazeboSimulator();
  GazeboSimulator(const GazeboSimulator&) = delete;
  GazeboSimulator& operator=(const GazeboSimulator&) = delete;

  Simulator& get() { return *simulator_; }
  /// How one of its processes ended; none while all run.
  std::optional<std::string> lost();
  /// After a failure: what is known of the end of its processes and was not reported by `lost` or
  /// an error of the simulator, with "; " before.
  std::string post_mortem();

 private:
  std::optional<std::string> why_give_up();

  std::stop_token stop_;
  std::unique_ptr<GazeboServer> server_;  // outlives the simulator, which is connected to it
  std::unique_ptr<Simulator> simulator_;
};

/// For a world that Gazebo 11 reads itself. @throws Error(kBadFile) with file, line and element for
/// the first element of its `sdf_files` that Gazebo reads differently from load_world, or that
/// violates a rule of time: a mesh or an <include> by a relative path, an <actor>, physics other
/// than ODE. The content of plugins is not checked.
void check_gazebo_world(const World& world);

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
