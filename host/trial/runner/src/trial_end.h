#pragma once

#include <optional>
#include <string>
#include <utility>

#include <tether/coordinator/coordinator.h>

/// How a trial's run ended, as data. The search for causes afterwards depends on it.
namespace tether::runner {

/// Why the runner ends a run before the coordinator does.
enum class StopCause {
  kInterrupted,    ///< requested by the user
  kSimulatorLost,  ///< one of the simulator's processes ended
  kBoardLost,      ///< the board with the SUTs is out of reach
  kSutEnded,       ///< a SUT's process ended before every SUT had joined
};

struct EarlyStop {
  StopCause cause;
  std::string reason;  ///< one line
};
/// In the coordinator's terms.
coordinator::Ending to_run_end(const EarlyStop& stop);

struct TrialEnd {
  coordinator::RunReport report;
  std::optional<StopCause> cause{};  ///< none: the coordinator ended the run
};

/// A SUT was silent, so its process may be stopped.
bool may_have_stopped_sut(const TrialEnd& end);
/// A SUT was lost, and it is not known how its process ended.
bool has_unexplained_sut(const TrialEnd& end);
/// The run did not begin because a SUT did not join.
bool lacks_sut(const TrialEnd& end);

/// The reason of an end, with causes that were found afterwards, each after "; ": before what the
/// coordinator noticed of it.
std::string with_causes(const coordinator::RunReport& report, const std::string& causes);

}  // namespace tether::runner
