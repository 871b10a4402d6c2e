#include "drawing_threads.h"
#include "machine_watch.h"
#include "sizing_of.h"
#include "suts/local_sut.h"
#include "trial_run.h"
#include "warning_log.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <vector>

#include <fmt/format.h>

#include <tether/audit/audit.h>
#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/board/board.h>
#include <tether/os/child_process.h>
#include <tether/os/machine.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial.h>
#include <tether/runner/trial_folder.h>
#include <tether/sim_sdf/load_world.h>

/// One trial: checks options and files, claims the folder, starts the board and the simulator,
/// conducts the run (TrialRun), and writes the result, which is evaluated from its messages.
/// Failures after the checks are results, too.
namespace tether::runner {

namespace {

using coordinator::RunEnd;

/// Connects to the boards of the condition and reserves them.
Boards hold_boards(const TrialSpec& spec, const std::stop_token& stop) {
  Boards boards{.by_uav = std::vector<board::Board*>(spec.scenario.uavs.size()), .all = {}};
  std::map<std::string, board::Board*> at;
  for (std::size_t uav = 0; uav < boards.by_uav.size(); ++uav) {
    if (spec.sut_place(uav) != SutPlace::kBoard) continue;
    const scenario::SshAddress address = *computer_of(spec.condition, uav).target->ssh;
    board::Board*& board = at[scenario::to_string(address)];
    if (!board)
      board = boards.all.emplace_back(std::make_unique<board::Board>(address, stop)).get();
    boards.by_uav[uav] = board;
  }
  return boards;
}

std::vector<campaign::TaskEnd> task_ends(const TrialSpec& spec,
                                         const coordinator::RunReport& report) {
  std::vector<campaign::TaskEnd> ends;
  for (std::size_t i = 0; i < report.suts.size(); ++i) {
    const auto& [uav, sut, finish, et, looks, unqueued] = report.suts[i];
    if (!finish) continue;
    std::string outcome = finish->outcome;
    // A program as it is tells why in its output only.
    if (spec.scenario.uavs[i].sut.is_as_is && !finish->reached_goal) {
      const auto output = os::read_whole(spec.folder / fmt::format("sut-{}.log", uav));
      if (const std::string last = os::last_line(output); !last.empty())
        outcome += fmt::format("; the last line of its output: {}", printable(last));
    }
    ends.push_back({uav, finish->reached_goal, std::move(outcome), finish->details});
  }
  return ends;
}

/// The result of a trial whose run did not begin; its record is removed.
campaign::TrialResult setup_failure(const TrialSpec& spec, const std::string& reason,
                                    bool is_interrupted) {
  std::error_code ignored;
  std::filesystem::remove(spec.folder / kRecordFile, ignored);
  auto result = campaign::make_setup_failure(spec.scenario, spec.condition, spec.seed, reason);
  if (is_interrupted) result.end = campaign::kEndInterrupted;
  return result;
}

void write_margins(const TrialSpec& spec, const campaign::TrialResult& result) {
  std::vector<record::Margin> margins;
  for (const auto& clause : result.clauses)
    for (const auto& [at, margin] : clause.margins)
      margins.push_back({clause.uav, clause.name, at, margin, clause.unit});
  if (!margins.empty()) record::write_margins(spec.folder / kMarginsFile, std::move(margins));
}

/// The result of a run, from its messages. The record stays if there is too little memory for it.
/// If it could not be written to its end, the trial counts as not set up, so that a campaign
/// repeats it.
campaign::TrialResult evaluate(const TrialSpec& spec, const Conducted& conducted) try {
  const coordinator::RunReport& report = conducted.report;
  const std::filesystem::path file = spec.folder / kRecordFile;
  if (!report.began) return setup_failure(spec, report.reason, report.end == RunEnd::kInterrupted);
  if (!std::filesystem::exists(file))
    throw Error(ErrorCode::kSetup, {file.string()}, "the record was removed during the run");
  const bool is_recorded = report.end != RunEnd::kRecordFailed;
  auto result = campaign::make_result(spec.scenario, spec.condition, conducted.record,
                                      task_ends(spec, report));
  result.this_run.wall = report.wall;
  if (result.pace)
    for (const coordinator::SutReport& sut : report.suts)
      for (const auto& [sensor, count] : sut.unqueued)
        result.pace->unqueued.push_back({sut.uav, sensor, count});
  if (conducted.target && is_recorded)
    result.this_run.target = report_of(*conducted.target, conducted.target_after, result.reason);
  const audit::Verdict verdict = audit::audit(conducted.record);
  result.audit = {verdict.passed(), audit::to_line(verdict)};
  if (!is_recorded) {
    result.end = campaign::kEndSetupFailed;
    campaign::invalidate(
        result, fmt::format("{}; the run reached ST {:.3f} s, with {} interactions, and the record "
                            "has those before the error",
                            report.reason, to_seconds(verdict.reached), verdict.interactions));
  } else if (result.outcome == campaign::Outcome::kFailed) {
    // Of one that was cut, the report knows more than the record.
    if (report.end != RunEnd::kFinished) campaign::invalidate(result, report.reason);
  } else if (!verdict.passed()) {
    campaign::invalidate(result, "the record breaks the rules of time: " + result.audit->summary);
  }
  write_margins(spec, result);
  return result;
} catch (const std::bad_alloc&) {
  return campaign::make_setup_failure(
      spec.scenario, spec.condition, spec.seed,
      fmt::format("out of memory while evaluating the run, which ended with: {}. With more memory, "
                  "evaluate its record with: tether audit {}",
                  conducted.report.reason, (spec.folder / kRecordFile).string()));
}

SimulatorSetup simulator_setup(const TrialSpec& spec, const sim::World& world,
                               const TrialObserver& observer, WarningLog& warnings,
                               const std::stop_token& stop) {
  return {.answer_limit = spec.scenario.hang_limit,
          .log = spec.folder / kSimulatorLog,
          .warn = warnings.sink(),
          .threads_ahead = drawing_threads(spec, world, os::separate_cores()),
          .on_setup = observer.on_setup,
          .on_silence = observer.on_blocked,
          .stop = stop};
}

/// They are no doubts: the SUT's own threads may have waited for each other's processors.
void add_board_loads(campaign::ThisRun& run) {
  const auto add = [&run](const campaign::TargetReport& target) {
    if (const auto load = load_of_board(target)) run.loads.push_back(*load);
  };
  if (run.target) add(*run.target);
  std::ranges::for_each(run.more_targets, add);
}

/// @throws Error(kSetup) if the simulator, the board or a SUT cannot be started, or the simulator
/// is lost before the run.
campaign::TrialResult fly(const TrialSpec& spec, const StartSimulator& start,
                          const SimulatorSetup& setup, const TrialInputs& inputs,
                          const TrialObserver& observer, WarningLog& warnings,
                          const std::stop_token& stop) {
  const Boards boards = hold_boards(spec, stop);
  const auto simulator = start(setup);
  for (std::size_t uav = 0; uav < spec.scenario.uavs.size(); ++uav)
    if (const auto& energy = spec.scenario.uavs[uav].energy;
        energy && !simulator->get().battery(uav))
      warnings.sink()({Consequence::kMissing,
                       {energy->file.string(), 0},
                       "energy",
                       "is simulated by the embedded simulator only; this flight has no battery"});
  warnings.pass_on();
  try {
    Conducted conducted = TrialRun(spec, inputs, *simulator, boards, observer, stop).conduct();
    auto result = evaluate(spec, conducted);
    for (const MachineReadings& machine : conducted.others)
      result.this_run.more_targets.push_back(report_of(machine.info, machine.after, result.reason));
    result.this_run.notes = conducted.notes;
    result.this_run.stopped_program = conducted.stopped_program;
    result.this_run.doubts = conducted.doubts;
    std::ranges::move(of_other_arguments(inputs.replayed, conducted.record.header),
                      std::back_inserter(result.warnings));
    for (const std::string& exit : conducted.bad_exits)
      result.warnings.push_back(
          {Consequence::kDoubtful, {}, "after its program had finished:", exit});
    result.this_run.loads = conducted.loads;
    add_board_loads(result.this_run);
    const auto& notes = inputs.replayed.warnings;
    result.this_run.notes.insert(result.this_run.notes.end(), notes.begin(), notes.end());
    if (const auto work = simulator->get().work())
      result.this_run.simulator = {.stepping = work->stepping,
                                   .drawing = work->drawing,
                                   .pictures = work->pictures,
                                   .drawn_ahead = work->drawn_ahead,
                                   .drawn_in_vain = work->drawn_in_vain};
    result.versions["simulator"] = simulator->get().description();
    return result;
  } catch (const Error& e) {
    throw Error(e.code(), e.what() + simulator->post_mortem());
  }
}

/// Writes the result. @throws Error(kSetup) with the end of the run as well.
void keep(const TrialSpec& spec, const TrialFolder& folder, campaign::TrialResult& result) try {
  result.this_run.sut_files = folder.files_of_suts();
  result.this_run.sizing = sizing_of(spec, scenario::ShippedFiles::of_program(os::own_file()));
  if (!result.warnings.empty()) {
    os::write_file_atomically(spec.folder / kWarningsFile,
                              grouped(result.warnings, std::numeric_limits<std::size_t>::max()));
  }
  campaign::write_result(spec.folder, result);
} catch (const Error& e) {
  throw Error(ErrorCode::kSetup,
              fmt::format("{}; the run ended with: {}", e.what(), result.reason));
}

sim::World load_world(const TrialSpec& spec, const BackEnd& back_end, WarningLog& warnings) {
  std::vector<Warning> of_files;
  sim::WorldStore none;
  sim::World world = (spec.worlds ? *spec.worlds : none)
                         .load(scenario::world_request(spec.scenario, spec.seed),
                               [&](const Warning& warning) { of_files.push_back(warning); });
  for (Warning& warning : of_files) {
    if (back_end.reads_world && world.sdf_files.contains(warning.where.file))
      warning.can_change_verdict = false;
    warnings.sink()(warning);
  }
  return world;
}

/// Prepares the simulator. What is no mistake of the user's, such as too little memory, is thrown
/// by the start instead, so that it ends in a result.
StartSimulator prepare(const BackEnd& back_end, sim::World world, const WarningSink& warn) try {
  return back_end.prepare(std::move(world), warn);
} catch (const std::exception& e) {
  const auto* error = dynamic_cast<const Error*>(&e);
  if (error && exit_code(error->code()) == 2) throw;
  return [failure = std::current_exception()](
             const SimulatorSetup&) -> std::unique_ptr<RunningSimulator> {
    std::rethrow_exception(failure);
  };
}

}  // namespace

SutPlace TrialSpec::sut_place(std::size_t uav) const {
  const scenario::Computer& own = computer_of(condition, uav);
  if (waits_for_sut || own.by_hand) return SutPlace::kUnknown;
  return own.target && own.target->ssh ? SutPlace::kBoard : SutPlace::kThisMachine;
}

bool TrialSpec::has_sut_at(SutPlace place) const {
  for (std::size_t uav = 0; uav < scenario.uavs.size(); ++uav)
    if (sut_place(uav) == place) return true;
  return false;
}

campaign::TrialResult run_trial(const TrialSpec& spec, const FindBackEnd& find_back_end,
                                const TrialObserver& observer, const std::stop_token& stop) {
  // Errors in options and files are found before anything is written.
  const BackEnd back_end = find_back_end(spec.condition.simulator);
  scenario::require_clock(spec.scenario, spec.condition);
  WarningLog warnings(observer.on_warnings);
  sim::World world = load_world(spec, back_end, warnings);
  scenario::Resolved resolved = resolve_world(spec.scenario, spec.condition, spec.seed,
                                              back_end.reads_world, world, warnings.sink());
  const TrialInputs inputs{std::move(resolved.timings), replayed_time(spec)};
  const campaign::StepReport step{world.step, world.step_from};
  const SimulatorSetup setup = simulator_setup(spec, world, observer, warnings, stop);
  require_sut_programs(spec.scenario, spec.condition, spec.waits_for_sut);
  if (!spec.was_tried) try_suts(spec.scenario, spec.condition, spec.waits_for_sut);
  const StartSimulator start = prepare(back_end, std::move(world), warnings.sink());
  TrialFolder folder(spec.folder, spec.earlier, spec.scenario.file);

  const std::string started_at = os::utc_now();
  campaign::TrialResult result;
  try {
    result = fly(spec, start, setup, inputs, observer, warnings, stop);
  } catch (const Error& e) {
    result = setup_failure(spec, e.what(), stop.stop_requested());
  } catch (const std::bad_alloc&) {
    result = setup_failure(spec, "out of memory", stop.stop_requested());
  } catch (const std::exception& e) {
    result =
        setup_failure(spec, fmt::format("internal error: {}", e.what()), stop.stop_requested());
  }
  result.versions["tether"] = version();
  result.this_run.started_at = started_at;
  result.this_run.machine = os::describe_machine();
  const auto all = warnings.all();
  result.warnings.insert(result.warnings.begin(), all.begin(), all.end());
  result.step = step;
  result.varied = resolved.varied;
  folder.release_room();
  keep(spec, folder, result);
  return result;
}

}  // namespace tether::runner
