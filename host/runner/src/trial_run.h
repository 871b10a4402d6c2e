#pragma once

#include "refusals.h"
#include "replayed_time.h"
#include "stall_watch.h"
#include "sut_environment.h"
#include "sut_processes.h"
#include "trial_end.h"

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/board/board.h>
#include <tether/coordinator/coordinator.h>
#include <tether/record/writer.h>
#include <tether/runner/back_end.h>
#include <tether/runner/trial.h>

namespace tether::runner {

/// One list per UAV of the world, in the order of its sensors.
using Timings = std::vector<std::vector<uav::SensorTiming>>;

/// What is read and checked before the folder of a trial is made.
struct TrialInputs {
  Timings timings;
  ReplayedTime replayed;
};

/// A run's report, and notes about it.
struct Conducted {
  coordinator::RunReport report;
  std::vector<std::string> notes;
  // Not in the record of a repeatable run.
  std::optional<record::TargetInfo> target;  ///< none if the user starts the SUTs
  record::Readings target_after;
};

/// One run of the coordinator with its SUTs, in phases: start the SUTs, fly, find the cause of a
/// failure, end the SUTs. The destructor closes the record. Not thread-safe.
class TrialRun {
 public:
  /// Opens the record and the server. The arguments must outlive the object; `board` is null if the
  /// SUTs run here. @throws Error(kSetup).
  TrialRun(const TrialSpec& spec, const TrialInputs& inputs, RunningSimulator& simulator,
           board::Board* board, const TrialObserver& observer, std::stop_token stop);

  /// Call it once. @throws Error(kSetup) if a SUT cannot be started, or the simulator is lost
  /// before the run.
  Conducted conduct();

 private:
  TrialEnd fly();
  std::optional<EarlyStop> early_stop();
  void watch(const coordinator::RunStatus& status, StallWatch& stalls);
  std::string explanation(const TrialEnd& end);
  std::string reach_hint(const TrialEnd& end);
  void end_suts(const TrialEnd& end);

  const TrialSpec& spec_;
  RunningSimulator& simulator_;
  board::Board* board_;
  const TrialObserver& observer_;
  std::stop_token stop_;
  std::string token_;
  std::optional<record::TargetInfo> target_;  // before the run
  std::unique_ptr<record::Recorder> recorder_;
  coordinator::Coordinator coordinator_;
  std::unique_ptr<link::Server> server_;
  SutRun sut_run_;
  SutProcesses suts_;
  Refusals refusals_;
  bool have_all_joined_ = false;
  record::Readings target_after_;
  std::vector<std::string> notes_;
};

}  // namespace tether::runner
