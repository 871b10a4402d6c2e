#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tether/coordinator/coordinator.h>
#include <tether/record/messages.h>
#include <tether/runner/trial.h>
#include <tether/timing/replay.h>

namespace tether::runner {

/// What a condition with the clock "replayed" gives its SUTs.
struct ReplayedTime {
  std::vector<timing::Replay> replays;  ///< one for each UAV; empty: no time is replayed
  record::ReplayInfo from;
  /// Of the runs in which the time was measured.
  std::vector<campaign::Doubt> doubts;
  bool has_waits = false;             ///< it was wall time: what the program waited is in it
  std::vector<std::string> warnings;  ///< about the timing file, one line each
  /// Mode "resampled": the arguments and files with which the program of a UAV was recorded.
  std::map<std::string, timing::Build> arguments{};
};

/// The program that is given resampled times has other arguments or files than the one of which
/// they are. Other builds and libraries are expected: it may be of another architecture.
std::vector<Warning> of_other_arguments(const ReplayedTime& time, const record::Header& header);

/// Makes what gives a SUT that time, each time from its first call on.
std::function<std::unique_ptr<coordinator::GivenTime>()> giver_of(const timing::Replay& replay);

/// @throws Error(kBadFile) with the file if a timing file cannot be read, is of another scenario,
/// or has not what the condition asks for.
ReplayedTime replayed_time(const TrialSpec& spec);

}  // namespace tether::runner
