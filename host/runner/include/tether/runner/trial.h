#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include <tether/campaign/result.h>
#include <tether/coordinator/coordinator.h>
#include <tether/link/channel.h>
#include <tether/link/server.h>
#include <tether/runner/back_end.h>
#include <tether/scenario/scenario.h>
#include <tether/sim/simulator.h>

namespace tether::runner {

/// One trial to run.
struct TrialSpec {
  scenario::Scenario scenario;
  scenario::Condition condition;
  std::uint64_t seed = 1;
  std::filesystem::path folder;  ///< gets result.json, record.mcap and the SUTs' logs
  /// None: a free port of loopback, or of the address at which the condition's board sees us.
  std::optional<link::Address> listen{};
  /// The board's SUTs come through its SSH connection.
  bool uses_tunnel = false;
  /// The user starts the SUT; else the scenario's command is started where the condition says.
  bool waits_for_sut = false;
};

/// Who is told what while a trial runs.
struct TrialObserver {
  std::function<void(const std::string&)> warn;  ///< one line each
  std::function<void(const coordinator::RunStatus&)> on_status;
  /// Nothing moves: who waits for whom, or for whose SUT to join; one line, once each time.
  std::function<void(const std::string&)> on_blocked;
  /// What is being set up, before there is a status.
  std::function<void(const std::string&)> on_setup;
  /// Somebody was not let in; one line. After twenty of them only their number, at the end.
  std::function<void(const std::string&)> on_refused;
  /// Waiting for the SUT: where to connect, and the environment that it needs.
  std::function<void(const std::string& instructions)> on_listening;
};

/// Runs one trial and leaves its result in the folder, whatever it was. An earlier trial's files
/// there are replaced. A stop request ends it as an interrupted one.
/// @throws Error(kUsage) and Error(kBadFile) before anything is written, when world, models or
/// profiles cannot be used; Error(kSetup) when the folder
///   cannot be written.
campaign::TrialResult run_trial(const TrialSpec& spec, const FindBackEnd& find_back_end,
                                const TrialObserver& observer, const std::stop_token& stop);

}  // namespace tether::runner
