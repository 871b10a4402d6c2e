#include "local_sut.h"
#include "trial_run.h"

#include <chrono>
#include <memory>
#include <new>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <tether/audit/audit.h>
#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/board/board.h>
#include <tether/os/machine.h>
#include <tether/record/reader.h>
#include <tether/runner/trial.h>
#include <tether/runner/trial_folder.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::runner {

namespace {

using coordinator::RunEnd;

/// The board that the condition names, connected and held; none where the SUTs run here.
std::unique_ptr<board::Board> hold_board(const TrialSpec& spec, const std::stop_token& stop) {
  const auto& target = spec.condition.target;
  if (spec.waits_for_sut || !target || !target->ssh) return nullptr;
  return std::make_unique<board::Board>(*target->ssh, stop);
}

std::vector<campaign::TaskEnd> task_ends(const coordinator::RunReport& report) {
  std::vector<campaign::TaskEnd> ends;
  for (const auto& sut : report.suts)
    if (sut.finish)
      ends.push_back({sut.uav, sut.finish->reached_goal, sut.finish->outcome, sut.finish->details});
  return ends;
}

/// A run that never began (no SUT joined) leaves no record worth reading.
campaign::TrialResult judge(const TrialSpec& spec, const coordinator::RunReport& report) {
  if (!report.began) {
    std::filesystem::remove(spec.folder / kRecordFile);
    auto result =
        campaign::make_setup_failure(spec.scenario, spec.condition, spec.seed, report.reason);
    if (report.end == RunEnd::kInterrupted) result.end = campaign::kEndInterrupted;
    return result;
  }
  if (!std::filesystem::exists(spec.folder / kRecordFile))
    throw Error(ErrorCode::kSetup, (spec.folder / kRecordFile).string() + " was removed meanwhile");
  const record::Record record = record::read_record(spec.folder / kRecordFile);
  auto result = campaign::make_result(spec.scenario, spec.condition, record, task_ends(report));
  const audit::Verdict verdict = audit::audit(record);
  result.audit = {verdict.passed(), audit::to_line(verdict)};
  if (result.outcome == campaign::Outcome::kFailed)
    campaign::invalidate(result, report.reason);
  else if (!verdict.passed())
    campaign::invalidate(result, "the record breaks the rules of time: " + result.audit->summary);
  return result;
}

/// The record stays where the run has ended but cannot be judged.
campaign::TrialResult judged(const TrialSpec& spec, const coordinator::RunReport& report) try {
  return judge(spec, report);
} catch (const std::bad_alloc&) {
  return campaign::make_setup_failure(
      spec.scenario, spec.condition, spec.seed,
      fmt::format("too little memory is free to judge the run, which ended with: {}; `tether audit "
                  "{}` reads its record where there is more",
                  report.reason, (spec.folder / kRecordFile).string()));
}

SimulatorSetup simulator_setup(const TrialSpec& spec, const TrialObserver& observer,
                               const std::stop_token& stop) {
  return {.answer_limit = spec.scenario.hang_limit,
          .log = spec.folder / kSimulatorLog,
          .warn = observer.warn,
          .on_setup = observer.on_setup,
          .on_silence = observer.on_blocked,
          .stop = stop};
}

/// A trial whose parts did not come together leaves no record.
campaign::TrialResult setup_failure(const TrialSpec& spec, const std::string& reason,
                                    const std::stop_token& stop) {
  std::error_code ignored;
  std::filesystem::remove(spec.folder / kRecordFile, ignored);
  auto result = campaign::make_setup_failure(spec.scenario, spec.condition, spec.seed, reason);
  if (stop.stop_requested()) result.end = campaign::kEndInterrupted;
  return result;
}

/// @throws Error(kSetup) when simulator, board or SUTs cannot be had, or the simulator is lost
/// before the run.
campaign::TrialResult fly(const TrialSpec& spec, const BackEnd& back_end, sim::World world,
                          const Timings& timings, const TrialObserver& observer,
                          const std::stop_token& stop) {
  const auto board = hold_board(spec, stop);
  const auto simulator = back_end.start(std::move(world), simulator_setup(spec, observer, stop));
  try {
    const auto [report, notes] =
        TrialRun(spec, timings, *simulator, board.get(), observer, stop).conduct();
    auto result = judged(spec, report);
    result.this_run.notes = notes;
    result.versions["simulator"] = simulator->get().description();
    return result;
  } catch (const Error& e) {
    throw Error(e.code(), e.what() + simulator->post_mortem(e.what()));
  }
}

/// @throws Error(kSetup) that tells how the trial ended as well.
void keep(const TrialSpec& spec, const campaign::TrialResult& result) try {
  campaign::write_result(spec.folder, result);
} catch (const Error& e) {
  throw Error(ErrorCode::kSetup,
              fmt::format("{}; the run itself ended with: {}", e.what(), result.reason));
}

std::string utc_now() {
  return fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

}  // namespace

campaign::TrialResult run_trial(const TrialSpec& spec, const FindBackEnd& find_back_end,
                                const TrialObserver& observer, const std::stop_token& stop) {
  // Whatever is wrong with the user's words and files shows before anything is written.
  const BackEnd back_end = find_back_end(spec.condition.simulator);
  scenario::require_clock(spec.scenario, spec.condition);
  sim::World world =
      sim::load_world(scenario::world_request(spec.scenario, spec.seed), observer.warn);
  back_end.require_readable(world);
  const Timings timings =
      scenario::resolve_sensors(spec.scenario, spec.condition, world, observer.warn);
  world.step = spec.scenario.step;
  if (is_local(spec)) require_sut_programs(spec.scenario, spec.condition);
  const TrialFolder folder(spec.folder);

  const std::string started_at = utc_now();
  campaign::TrialResult result;
  try {
    result = fly(spec, back_end, std::move(world), timings, observer, stop);
  } catch (const Error& e) {
    result = setup_failure(spec, e.what(), stop);
  } catch (const std::bad_alloc&) {
    result = setup_failure(spec, "too little memory is free for this run", stop);
  } catch (const std::exception& e) {
    result = setup_failure(spec, fmt::format("internal error: {}", e.what()), stop);
  }
  result.versions["tether"] = version();
  result.this_run.started_at = started_at;
  result.this_run.machine = os::describe_machine();
  keep(spec, result);
  return result;
}

}  // namespace tether::runner
