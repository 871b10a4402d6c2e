#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/warning.h>
#include <tether/campaign/result.h>
#include <tether/coordinator/coordinator.h>
#include <tether/link/channel.h>
#include <tether/link/server.h>
#include <tether/runner/back_end.h>
#include <tether/runner/trial_folder.h>
#include <tether/scenario/scenario.h>
#include <tether/sim/simulator.h>

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
