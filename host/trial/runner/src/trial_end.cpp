#include "trial_end.h"

#include <algorithm>

namespace tether::runner {

using coordinator::RunEnd;

coordinator::Ending to_run_end(const EarlyStop& stop) {
  switch (stop.cause) {
    case StopCause::kInterrupted:
      return {RunEnd::kInterrupted, stop.reason};
    case StopCause::kSimulatorLost:
      return {RunEnd::kSimulatorLost, stop.reason};
    case StopCause::kBoardLost:
    case StopCause::kSutEnded:
      break;
  }
  return {RunEnd::kSutLost, stop.reason};
}

bool may_have_stopped_sut(const TrialEnd& end) {
  return end.report.end == RunEnd::kSutHung ||
         (end.report.end == RunEnd::kSutLost && !end.report.began);
}

bool has_unexplained_sut(const TrialEnd& end) {
  return end.report.end == RunEnd::kSutLost && !end.cause;
}

bool lacks_sut(const TrialEnd& end) {
  return has_unexplained_sut(end) && !end.report.began &&
         std::ranges::any_of(end.report.suts, [](const auto& sut) { return sut.sut.empty(); });
}

std::string with_causes(const coordinator::RunReport& report, const std::string& causes) {
  const std::size_t at = report.causes_at;
  if (causes.empty() || at >= report.reason.size()) return report.reason + causes;
  return report.reason.substr(0, at) + ": " + causes.substr(2) + "; " +
         report.reason.substr(at + 2);
}

}  // namespace tether::runner
