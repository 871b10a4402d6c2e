#pragma once

#include "machine_watch.h"
#include "refusals.h"
#include "replayed_time.h"
#include "suts/stall_watch.h"
#include "suts/sut_environment.h"
#include "suts/sut_processes.h"
#include "suts/sut_watch.h"
#include "trial_end.h"

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/board/board.h>
#include <tether/coordinator/coordinator.h>
#include <tether/os/text_file.h>
#include <tether/record/writer.h>
#include <tether/runner/trial.h>

namespace tether::runner {

/// One list per UAV of the world, in the order of its sensors.
using Timings = std::vector<std::vector<uav::SensorTiming>>;

/// What is read and checked before the folder of a trial is made.
struct TrialInputs {
  Timings timings;
  ReplayedTime replayed;
};

/// The boards of a run.
struct Boards {
  std::vector<board::Board*> by_uav;               ///< null: its SUT is not on a board
  std::vector<std::unique_ptr<board::Board>> all;  ///< each once
};

/// One of the machines on which the SUTs run, before and after the run.
struct MachineReadings {
  record::TargetInfo info;
  record::Readings after;
};

/// A run's report, its messages, and notes about it.
struct Conducted {
  coordinator::RunReport report;
  record::Record record;  ///< as in the file
  std::vector<std::string> notes;
  std::string stopped_program;  ///< of these notes: campaign::ThisRun
  std::vector<campaign::Doubt> doubts;
  std::vector<campaign::MachineLoad> loads;
  // Not in the record of a repeatable run.
  std::optional<record::TargetInfo> target;  ///< none if the user starts the SUTs
  record::Readings target_after;
  std::vector<MachineReadings> others;   ///< further machines of a mixed fleet
  std::vector<std::string> bad_exits{};  ///< of programs that had reached their goals
};

/// One run of the coordinator with its SUTs, in phases: start the SUTs, fly, find the cause of a
/// failure, end the SUTs. The destructor closes the record. Not thread-safe.
class TrialRun {
 public:
  /// Opens the record and the server. The arguments must outlive the object; @throws Error(kSetup).
  TrialRun(const TrialSpec& spec, const TrialInputs& inputs, RunningSimulator& simulator,
           const Boards& boards, const TrialObserver& observer, std::stop_token stop);

  /// Call it once. @throws Error(kSetup) if a SUT cannot be started, or the simulator is lost
  /// before the run.
  Conducted conduct();

 private:
  TrialEnd fly(std::optional<MachineWatch>& machine);
  record::Readings read_targets();
  std::vector<campaign::Doubt> doubts(const coordinator::RunReport& report) const;
  std::optional<EarlyStop> early_stop();
  void watch(const coordinator::RunStatus& status, StallWatch& stalls);
  std::string explained(const TrialEnd& end);
  std::string reach_hint(const TrialEnd& end);
  void end_suts(const TrialEnd& end);

  const TrialSpec& spec_;
  const TrialInputs& inputs_;
  RunningSimulator& simulator_;
  const Boards& boards_;
  const TrialObserver& observer_;
  std::stop_token stop_;
  std::string token_;
  std::optional<record::TargetInfo> target_;  // before the run
  std::unique_ptr<record::Recorder> file_;
  record::RecordInMemory memory_;
  record::FanOut recorder_;
  coordinator::Coordinator coordinator_;
  std::unique_ptr<link::Server> server_;
  std::optional<os::TemporaryFolder> groups_folder_;  // for groups on this machine
  SutRun sut_run_;
  SutProcesses suts_;
  Refusals refusals_;
  std::vector<MachineReadings> others_;
  bool have_all_joined_ = false;
  record::Readings target_after_;
  std::vector<std::string> notes_;
  std::string stopped_program_;
  std::vector<std::string> bad_exits_;
};

}  // namespace tether::runner
