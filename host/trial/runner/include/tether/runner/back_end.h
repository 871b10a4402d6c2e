#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/simulator.h>

/// The interface between a trial and simulators. The program decides which simulators there are.
namespace tether::runner {

/// Settings of a simulator.
struct SimulatorSetup {
  Duration answer_limit{0};   ///< maximum time for a reply of an external simulator
  std::filesystem::path log;  ///< output of the simulator's processes
  sim::WarningSink warn;
  int threads_ahead = 0;  ///< that may draw before a picture is asked for; 0: none may
  std::function<void(const std::string&)> on_setup{};    ///< called with what is being started
  std::function<void(const std::string&)> on_silence{};  ///< called if a reply takes long
  std::stop_token stop{};                                ///< a stop request ends all waiting for it
};

/// The simulator of one run with its processes, which end with the object. Not thread-safe.
class RunningSimulator {
 public:
  virtual ~RunningSimulator() = default;

  virtual sim::Simulator& get() = 0;
  /// Why its processes are lost; none if they are not.
  virtual std::optional<std::string> lost() { return std::nullopt; }
  /// After it failed: what no error has reported about its end yet, starting with "; ".
  virtual std::string post_mortem() { return ""; }
};

/// Starts a simulator with its world, or connects to it; called once at most.
/// @throws Error(kSetup).
using StartSimulator = std::function<std::unique_ptr<RunningSimulator>(const SimulatorSetup&)>;

/// A simulator that a condition can select.
struct BackEnd {
  /// Reads what this program needs of the files that a world names, and checks that the simulator
  /// has the world's sensors, to which all profiles have been applied. Starts nothing.
  /// @throws Error(kBadFile) with file and line; Error(kSetup) if the simulator cannot hold it.
  std::function<StartSimulator(sim::World, const sim::WarningSink&)> prepare;
  /// Files of the simulator that a result depends on. @throws Error(kSetup) if one is missing.
  std::function<std::vector<std::filesystem::path>()> files;
  /// It reads the world's files itself: what the embedded simulator leaves out of them is there.
  bool reads_world = false;
};

/// Returns the simulator of that name. @throws Error(kUsage) if it is unknown.
using FindBackEnd = std::function<BackEnd(const std::string& name)>;

}  // namespace tether::runner
