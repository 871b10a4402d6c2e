#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/error.h>
#include <tether/base/time.h>
#include <tether/campaign/result.h>
#include <tether/coordinator/coordinator.h>
#include <tether/link/channel.h>
#include <tether/link/server.h>
#include <tether/runner/trial_folder.h>
#include <tether/scenario/scenario.h>
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

namespace tether::sim {
class WorldStore;
}

namespace tether::runner {

/// Where a trial's SUTs run.
enum class SutPlace {
  kThisMachine,
  kBoard,
  kUnknown,  ///< the user starts them
};

/// One trial to run.
struct TrialSpec {
  scenario::Scenario scenario;
  scenario::Condition condition;
  std::uint64_t seed = 1;
  std::filesystem::path folder;              ///< for result.json, record.mcap and the logs of SUTs
  EarlierRun earlier = EarlierRun::kRefuse;  ///< one in the folder
  /// None: a free port of 127.0.0.1, or of the address at which the board sees this machine.
  std::optional<link::Address> listen{};
  /// Tunnel the connection of SUTs on the board through SSH.
  bool uses_tunnel = false;
  /// The user starts the SUT. Otherwise the command of the scenario is started on the target.
  bool waits_for_sut = false;
  sim::WorldStore* worlds = nullptr;  ///< that are in memory; null: none
  bool was_tried = false;  ///< before: by a campaign, that its SUTs understand what they are given

  /// Of that UAV's SUT.
  SutPlace sut_place(std::size_t uav) const;
  /// Whether some SUT is in that place.
  bool has_sut_at(SutPlace place) const;
};

/// Callbacks of a trial.
struct TrialObserver {
  std::function<void(const std::string&)> warn;  ///< one line each
  /// What of the world, the UAVs and the profiles is not simulated as written: all of it before the
  /// first status, then what the simulator notices during the run.
  std::function<void(const std::vector<Warning>&)> on_warnings;
  std::function<void(const coordinator::RunStatus&)> on_status;
  /// Nothing advances: which SUT blocks the run or has not joined; one line, once per stall.
  std::function<void(const std::string&)> on_blocked;
  /// What is being set up, before the first status.
  std::function<void(const std::string&)> on_setup;
  /// A rejected connection; one line. After the first twenty, only their number at the end.
  std::function<void(const std::string&)> on_refused;
  /// If `waits_for_sut`: the command lines that start the SUTs, with their environment.
  std::function<void(const std::string& instructions)> on_listening;
};

/// Runs one trial and writes its result to the folder, even if it fails. A stop request ends it as
/// interrupted.
/// @throws Error(kUsage) and Error(kBadFile) before anything is written, if an option, the world, a
///   model, a profile or the folder (see TrialFolder) cannot be used; Error(kSetup) if the folder
///   cannot be written.
campaign::TrialResult run_trial(const TrialSpec& spec, const FindBackEnd& find_back_end,
                                const TrialObserver& observer, const std::stop_token& stop);

}  // namespace tether::runner
