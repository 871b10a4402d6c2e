#include "trial.h"

#include "interrupt.h"
#include "local_sut.h"
#include "machine.h"
#include "sut_processes.h"
#include "trial_folder.h"

#include <chrono>
#include <cstdlib>
#include <memory>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <tether/audit/audit.h>
#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/record/reader.h>
#include <tether/record/writer.h>
#include <tether/sim_mujoco/mujoco_simulator.h>

namespace tether::app {

namespace {

using coordinator::RunEnd;

constexpr Duration kHelloTimeout = std::chrono::seconds(5);

WallTime host_now() {
  return WallTime(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

std::string token_of_run() {
  const char* given = std::getenv("TETHER_TOKEN");
  return given && *given ? given : link::make_token();
}

/// One list per UAV of the world, in the order of its sensors.
using Timings = std::vector<std::vector<uav::SensorTiming>>;

link::ClockKind kind_of(scenario::Clock clock) {
  switch (clock) {
    case scenario::Clock::kWall:
      return link::ClockKind::kWall;
    case scenario::Clock::kCpu:
      return link::ClockKind::kCpu;
    case scenario::Clock::kScripted:
      return link::ClockKind::kScripted;
  }
  return link::ClockKind::kWall;
}

coordinator::RunOptions run_options(const TrialSpec& spec, const Timings& timings,
                                    const std::string& token) {
  coordinator::RunOptions options;
  options.policy = spec.condition.policy == scenario::Policy::kFreeRunning
                       ? sync::SyncPolicy::kFreeRunning
                       : sync::SyncPolicy::kConservativeBarrier;
  const coordinator::ClockSetting clock{kind_of(spec.condition.clock), spec.condition.cpu_factor,
                                        spec.condition.computing};
  for (std::size_t i = 0; i < timings.size(); ++i)
    options.uavs.push_back({timings[i], spec.scenario.uavs[i].command_latency, clock});
  options.token = token;
  options.seed = spec.seed;
  options.real_time_factor = spec.condition.real_time_factor;
  options.time_limit = spec.scenario.time_limit;
  options.hang_limit = spec.scenario.hang_limit;
  if (spec.waits_for_sut) options.connect_limit = std::chrono::hours(24);
  options.ground_truth_period = spec.scenario.ground_truth_period;
  options.record_images = spec.scenario.record_images;
  options.image_period = spec.scenario.image_period;
  options.header.tether_version = version();
  options.header.scenario = spec.scenario.name;
  options.header.condition = spec.condition.name;
  options.header.machine = describe_machine();
  return options;
}

/// A camera's first image costs the most by far (GL start-up, shaders); it is made while the SUTs'
/// processes start.
void warm_up_cameras(sim::Simulator& simulator) {
  sim::Snapshot snapshot;
  simulator.capture(snapshot);
  for (std::size_t u = 0; u < simulator.world().uavs.size(); ++u) {
    const auto& sensors = simulator.world().uavs[u].sensors;
    for (std::size_t s = 0; s < sensors.size(); ++s)
      if (sensors[s].kind() == uav::SensorKind::kCamera) simulator.measure(snapshot, u, s, 0);
  }
}

/// The coordinator's run with its SUTs, up to the closed record.
coordinator::RunReport conduct(const TrialSpec& spec, sim::Simulator& simulator,
                               const Timings& timings, const TrialObserver& observer) {
  const std::string token = token_of_run();
  const auto recorder = record::make_mcap_recorder(spec.folder / kRecordFile);
  coordinator::Coordinator coordinator(simulator, *recorder, run_options(spec, timings, token),
                                       host_now);
  const auto server = link::listen_tcp(spec.listen, kHelloTimeout, coordinator.events());
  const SutRun sut_run{link::to_string(server->address()), token, spec.condition};
  SutProcesses suts;
  if (!spec.waits_for_sut) suts.start(spec.scenario, sut_run, spec.folder);
  warm_up_cameras(simulator);
  if (spec.waits_for_sut && observer.on_listening)
    observer.on_listening(sut_instructions(spec.scenario, sut_run));

  bool joined = false, left_early = false;
  coordinator::RunHooks hooks;
  hooks.should_stop = [&]() -> std::optional<std::pair<RunEnd, std::string>> {
    if (interrupted())
      return std::pair(RunEnd::kInterrupted, std::string("interrupted by the user"));
    if (!joined)
      if (const auto end = suts.early_end()) {
        left_early = true;
        return std::pair(RunEnd::kSutLost, *end);
      }
    return std::nullopt;
  };
  hooks.on_status = [&](const coordinator::RunStatus& status) {
    joined = status.joined == spec.scenario.uavs.size();
    if (observer.on_status) observer.on_status(status);
  };
  hooks.on_refused = observer.on_refused;
  auto report = coordinator.run(*server, hooks);
  if (report.end == RunEnd::kSutLost && !left_early) report.reason += suts.post_mortem();
  if (report.end == RunEnd::kFinished) suts.let_leave();
  return report;
}

std::vector<experiment::TaskEnd> task_ends(const coordinator::RunReport& report) {
  std::vector<experiment::TaskEnd> ends;
  for (const auto& sut : report.suts)
    if (sut.finish)
      ends.push_back({sut.uav, sut.finish->reached_goal, sut.finish->outcome, sut.finish->details});
  return ends;
}

/// A run that never began (no SUT joined) leaves no record worth reading.
experiment::TrialResult judge(const TrialSpec& spec, const coordinator::RunReport& report) {
  if (!report.began) {
    std::filesystem::remove(spec.folder / kRecordFile);
    auto result =
        experiment::make_setup_failure(spec.scenario, spec.condition, spec.seed, report.reason);
    if (report.end == RunEnd::kInterrupted) result.end = experiment::kEndInterrupted;
    return result;
  }
  const record::Record record = record::read_record(spec.folder / kRecordFile);
  auto result = experiment::make_result(spec.scenario, spec.condition, record, task_ends(report));
  const audit::Verdict verdict = audit::audit(record);
  const std::string text = audit::to_text(verdict, 0);
  result.audit = {verdict.passed(), text.substr(0, text.find('\n'))};
  if (result.outcome == experiment::Outcome::kFailed)
    experiment::invalidate(result, report.reason);
  else if (!verdict.passed())
    experiment::invalidate(result, "the record breaks the rules of time: " + result.audit->summary);
  return result;
}

std::string utc_now() {
  return fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

}  // namespace

experiment::TrialResult run_trial(const TrialSpec& spec, const TrialObserver& observer) {
  // Whatever is wrong with the user's files shows before anything is written.
  sim::World world =
      sim::load_world(scenario::world_request(spec.scenario, spec.seed), observer.warn);
  const Timings timings =
      scenario::resolve_sensors(spec.scenario, spec.condition, world, observer.warn);
  world.step = spec.scenario.step;
  if (!spec.waits_for_sut) require_sut_programs(spec.scenario, spec.condition);
  const TrialFolder folder(spec.folder);

  const std::string started_at = utc_now();
  experiment::TrialResult result;
  try {
    const auto simulator = sim::make_mujoco_simulator(std::move(world), observer.warn);
    result = judge(spec, conduct(spec, *simulator, timings, observer));
    result.versions["simulator"] = simulator->description();
  } catch (const Error& e) {
    result = experiment::make_setup_failure(spec.scenario, spec.condition, spec.seed, e.what());
  }
  result.versions["tether"] = version();
  result.this_run.started_at = started_at;
  result.this_run.machine = describe_machine();
  experiment::write_result(spec.folder, result);
  return result;
}

}  // namespace tether::app
