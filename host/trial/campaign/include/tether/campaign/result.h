#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/error.h>
#include <tether/base/time.h>
#include <tether/campaign/metrics.h>
#include <tether/computer/clock.h>
#include <tether/energy/meter.h>
#include <tether/judge/judge.h>
#include <tether/record/reader.h>
#include <tether/scenario/scenario.h>
#include <tether/timing/pace.h>
#include <tether/timing/timing.h>

/// The result of one trial and its file, `result.json` (docs/design.md section 5).
namespace tether::campaign {

inline constexpr int kResultSchemaVersion = 1;
inline constexpr std::string_view kResultFile = "result.json";
/// The report of a run or campaign in its folder, unless the user names another file.
inline constexpr std::string_view kReportFile = "report.html";
/// How each JUnit file begins that Tether writes; the user names it.
inline constexpr std::string_view kJunitBegin =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
bool is_junit(const std::filesystem::path& file);

enum class Outcome {
  kGoalReached,  ///< exit 0: every SUT finished with its goal reached, every metric within its
                 ///< limit, every clause met, no UAV hit anything harder than the scenario
                 ///< allows
  kGoalMissed,   ///< exit 1: the trial ran, but missed that
  kFailed,       ///< exit 3: simulator, link or SUT could not be set up, was lost or hung
};
/// "goal_reached", "goal_missed", "failed".
std::string_view name(Outcome outcome);
int exit_code(Outcome outcome);

/// `end` of a trial that was not set up, or whose SUT was lost before its first interaction; other
/// ends are as in record::Footer.
inline constexpr std::string_view kEndSetupFailed = "setup_failed";
/// `end` of a trial that the user stopped. It does not count as a result.
inline constexpr std::string_view kEndInterrupted = "interrupted";
inline constexpr std::string_view kEndFinished = "finished";
inline constexpr std::string_view kEndTimeLimit = "time_limit";
inline constexpr std::string_view kEndBatteryEmpty = "battery_empty";
inline constexpr std::string_view kEndKilled = "killed";  ///< by a clause that ends the flight

/// One SUT: its name and version, and what it reported about its task.
struct SutResult {
  std::string uav;
  std::string sut;  ///< name and version
  computer::Clock clock{};
  std::optional<ExecTime> et_at_end{};  ///< none if ET was not synchronised with ST
  bool finished = false;
  bool reached_goal = false;
  std::string outcome{};  ///< one line: why
  std::string details{};  ///< one JSON object, or empty
  bool as_is = false;     ///< it does not use Tether's library

  friend bool operator==(const SutResult&, const SutResult&) = default;
};

/// The stops of concurrent SUTs.
struct StopFigures {
  std::uint64_t count = 0;
  Duration largest_overshoot{0};  ///< by which a stop came after the reply that it was for

  friend bool operator==(const StopFigures&, const StopFigures&) = default;
};

/// The figures of the barrier; equal in every run with the same execution times.
struct SyncFigures {
  std::uint64_t interactions = 0;
  std::uint64_t causality_violations = 0;
  Duration largest_grid_error{0};
  SimTime st_at_end;
  std::optional<StopFigures> stops{};  ///< none without a concurrent SUT

  friend bool operator==(const SyncFigures&, const SyncFigures&) = default;
};

/// What a UAV touched, and how near it came to anything.
struct UavContacts {
  std::string uav;
  std::optional<std::uint64_t> count{};  ///< of any speed; none: the simulator reports none
  std::uint64_t hard = 0;                ///< of these, harder than the scenario allows
  std::optional<record::Contact> hardest{};
  std::optional<record::Clearance> nearest{};  ///< none: not measured

  friend bool operator==(const UavContacts&, const UavContacts&) = default;
};

struct AuditVerdict {
  bool passed = false;
  std::string summary;  ///< one line

  friend bool operator==(const AuditVerdict&, const AuditVerdict&) = default;
};

/// The state of the machine that the SUTs ran on, before and after the run.
struct TargetReport {
  std::string name;
  std::string address;  ///< "ssh://user@board"; empty: the host
  record::Readings before{}, after{};
  std::vector<std::string> warnings{};  ///< one line each
  bool is_spoiled = false;              ///< according to a warning, its times cannot be trusted

  friend bool operator==(const TargetReport&, const TargetReport&) = default;
};

/// What the embedded simulator computed during a run. Times are CPU time.
struct SimulatorFigures {
  Duration stepping{0};
  Duration drawing{0};
  std::uint64_t pictures = 0;       ///< drawn, those in vain among them
  std::uint64_t drawn_ahead = 0;    ///< of these, begun before the SUT asked for them
  std::uint64_t drawn_in_vain = 0;  ///< of these, not read

  friend bool operator==(const SimulatorFigures&, const SimulatorFigures&) = default;
};

/// What a flight took from the battery of a UAV, until its SUT finished.
struct UavEnergy {
  struct OfTask {
    std::string task;
    energy::Energies_J spent_J{};
    friend bool operator==(const OfTask&, const OfTask&) = default;
  };
  std::string uav;
  energy::Energies_J spent_J{};  ///< by energy::Cause
  double charge_from = 0.0;      ///< share of the capacity, at ST 0
  double charge_to = 0.0;
  double least_voltage_V = 0.0;
  std::vector<OfTask> tasks{};  ///< of its mission, in the order in which they began

  /// How many more such flights the charge that is left is enough for; none if none was used.
  std::optional<double> more_flights() const;
  /// From when on it gave no power, because its voltage fell too low, or it was asked for more than
  /// it has, as the record shows; never: SimTime::max().
  SimTime cut_off_at = SimTime::max();
  bool is_empty() const { return charge_to <= 0.0 || cut_off_at != SimTime::max(); }
  friend bool operator==(const UavEnergy&, const UavEnergy&) = default;
};
double total_J(const energy::Energies_J& spent_J);

using timing::Doubt;

/// How far a machine on which execution time was measured was from idle and even during a run.
struct MachineLoad {
  std::string machine;        ///< "host", or the name of a board
  double block_spread = 0.0;  ///< of a fixed block of work: usual over shortest time, less 1
  double others = 0.0;  ///< share of its processors' time that other programs and other virtual
                        ///< machines took; 0 also if the user started programs of the run. Of a
                        ///< board: share of the run for which programs waited for a processor

  friend bool operator==(const MachineLoad&, const MachineLoad&) = default;
};

/// What `tether size` flies to find how slow the computer of a trial may be.
struct Sizing {
  std::string scenario;   ///< name of a shipped one, or a file
  std::string condition;  ///< of the scenario
  std::string target{};   ///< the file of one that the command line gave; empty: none
  /// Slowdowns around that of the trial; none: it was not slowed down.
  std::optional<std::pair<double, double>> between{};

  friend bool operator==(const Sizing&, const Sizing&) = default;
};

/// Everything that may differ between two runs of the same trial with the same execution times.
struct ThisRun {
  std::string started_at;  ///< ISO 8601, UTC
  std::string machine;
  Duration wall{0};
  Duration largest_lag{0};                   ///< depends on how far the simulator had advanced
  int attempts = 1;                          ///< more: the machine failed in the earlier ones
  std::string first_failure;                 ///< the reason of the first one
  std::optional<TargetReport> target{};      ///< none if it was not read
  std::vector<TargetReport> more_targets{};  ///< further machines of a mixed fleet
  std::vector<std::string> notes{};          ///< unintended stalls of the run, one line each
  /// The note on the first program that a signal or a debugger stopped; empty: none was.
  std::string stopped_program{};
  std::vector<Doubt> doubts{};           ///< in the order of their kinds and subjects
  std::vector<MachineLoad> loads{};      ///< of machines whose clock was read; also if normal
  std::vector<std::string> sut_files{};  ///< written by SUTs; paths in the trial's folder, sorted
  std::optional<SimulatorFigures> simulator{};  ///< none: not measured
  std::optional<Sizing> sizing{};               ///< none: not possible

  friend bool operator==(const ThisRun&, const ThisRun&) = default;
};

/// The step of the simulation.
struct StepReport {
  Duration step{0};
  std::string from;  ///< who set it: "scenario", "world" or, if neither did, "default"

  friend bool operator==(const StepReport&, const StepReport&) = default;
};

/// The time of the SUTs was replayed: from what, how old, and how.
struct ReplayReport {
  record::ReplayInfo from;
  std::vector<std::string>
      unknown_stages{};  ///< computed under, but not in the timing file; sorted

  friend bool operator==(const ReplayReport&, const ReplayReport&) = default;
};
struct TrialResult {
  std::string scenario;
  std::string condition;
  std::uint64_t seed = 0;
  std::string policy;
  computer::Clock clock{};
  std::optional<ReplayReport> replay{};  ///< of clock "replayed"
  double real_time_factor = 0.0;
  std::optional<StepReport> step{};  ///< none: the result is of an earlier version
  std::string target{};              ///< its name; empty: the host as it is
  record::EmulatorInfo emulator{};   ///< of a counted target
  /// Values of the scenario's file that were replaced (`tether run --set`, sweeps).
  std::map<std::string, std::string> settings{};
  std::vector<scenario::Varied> varied{};  ///< what this flight's seed drew
  /// Names of the profiles in use, in the order of their layers: a later one overrides an earlier.
  std::vector<std::string> profiles;
  Outcome outcome = Outcome::kFailed;
  std::string end;     ///< see kEnd…
  std::string reason;  ///< one line: why this outcome
  std::vector<MetricValue> metrics;
  /// Of the missions, one UAV after the other; empty if no SUT has one.
  std::vector<judge::TaskSpan> tasks{};
  std::vector<judge::ClauseVerdict> clauses{};
  std::vector<UavEnergy> energy{};  ///< of each UAV with a model of energy
  /// None: the run was not synchronised or failed, its programs reported no stages, or the result
  /// is of an earlier version.
  std::optional<timing::Pace> pace{};
  std::vector<SutResult> suts;
  SyncFigures sync;
  /// See copies.h; empty: there is no ground truth, or the result is of an earlier version.
  std::string flight_digest{};
  /// Of each UAV; empty: the trial did not run, or the result is of an earlier version.
  std::vector<UavContacts> contacts;
  std::optional<AuditVerdict> audit;
  std::vector<Warning> warnings{};              ///< what of the files is not simulated as written
  std::map<std::string, std::string> versions;  ///< of everything that took part, by its name
  ThisRun this_run;

  /// Programs waited or computed in ways that Tether does not see.
  bool has_unseen_time() const;

  /// nullptr if there is no metric of that name.
  const MetricValue* find_metric(std::string_view metric) const;

  friend bool operator==(const TrialResult&, const TrialResult&) = default;
};
/// Of a command: that of the outcome; 3 as well if the trial has unseen time.
int exit_code(const TrialResult& result);

/// "replayed (resampled) from board.timing, recorded 2026-11-20T10:00:00Z (3 days before) on pi";
/// empty if no time was replayed.
std::string describe_replay(const TrialResult& result);

/// What a SUT reported when it finished; not part of the record's header.
struct TaskEnd {
  std::string uav;
  bool reached_goal = false;
  std::string outcome;
  std::string details;
};

/// The result of a trial from its record: metrics, figures and the outcome with its reason. A
/// record without a footer is a failed trial. Metrics have values only if the trial did not fail
/// and the SUT reached its own goal (but those of any flight, scenario::MetricKind). The caller
/// adds audit, more versions, `started_at`.
TrialResult make_result(const scenario::Scenario& scenario, const scenario::Condition& condition,
                        const record::Record& record, const std::vector<TaskEnd>& task_ends);

/// For a trial that ran but whose numbers cannot be trusted: it counts as failed for `reason`, and
/// no metric keeps its value, nor the pace.
void invalidate(TrialResult& result, const std::string& reason);

/// Why the outcome does not follow from the rest of the result, as if it was edited by hand; empty:
/// it does.
std::string contradiction_in(const TrialResult& result);

/// What counts the work of the condition's SUTs; without a program if nothing does.
record::EmulatorInfo emulator_of(const scenario::Condition& condition);

/// The result of a trial without a record, because it could not be set up.
TrialResult make_setup_failure(const scenario::Scenario& scenario,
                               const scenario::Condition& condition, std::uint64_t seed,
                               const std::string& reason);

/// The content of `result.json`. Equal results give equal text; everything that may differ from run
/// to run is in the member "this_run".
std::string to_json(const TrialResult& result);
/// @throws Error(kBadFile), located at `file`, if the text is not a complete result (truncated,
/// wrong
///   types, newer schema); about the member, if one is wrong.
TrialResult result_from_json(const std::string& text, const std::filesystem::path& file);

/// Writes `folder`/result.json completely or not at all, even if the machine loses power.
/// @throws Error(kSetup) if the file system refuses.
void write_result(const std::filesystem::path& folder, const TrialResult& result);
/// @throws Error(kBadFile) as `result_from_json`, or if there is no file.
TrialResult read_result(const std::filesystem::path& folder);

}  // namespace tether::campaign
