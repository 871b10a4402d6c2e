#include "trial.h"

#include "local_sut.h"
#include "refusals.h"
#include "running_simulator.h"
#include "stall_watch.h"
#include "sut_processes.h"
#include "trial_folder.h"

#include <chrono>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <tether/audit/audit.h>
#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/board/board.h>
#include <tether/board/target_probe.h>
#include <tether/os/machine.h>
#include <tether/record/reader.h>
#include <tether/record/writer.h>
#include <tether/sync/clock_witness.h>

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
  if (!given || !*given) return link::make_token();
  std::string token = given;
  if (token.size() > link::kMaxNameBytes)
    throw Error(ErrorCode::kSetup,
                fmt::format("TETHER_TOKEN is longer than {} bytes; leave it unset, and the run "
                            "makes one of its own",
                            link::kMaxNameBytes));
  return token;
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

/// 0: not known, or more than a run can tell.
int cores_for_witness() {
  const int cores = os::machine_cores();
  return cores <= sync::kMostCores ? cores : 0;
}

/// The condition's SUTs are started on this machine.
bool is_local(const TrialSpec& spec) {
  return !spec.waits_for_sut && !(spec.condition.target && spec.condition.target->ssh);
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
    options.uavs.push_back({timings[i], spec.scenario.uavs[i].command_latency, clock,
                            is_local(spec) ? cores_for_witness() : 0});
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
  options.header.machine = os::describe_machine();
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

/// The board that the condition names, connected and held; none where the SUTs run here.
std::unique_ptr<board::Board> hold_board(const TrialSpec& spec, const std::stop_token& stop) {
  const auto& target = spec.condition.target;
  if (spec.waits_for_sut || !target || !target->ssh) return nullptr;
  return std::make_unique<board::Board>(*target->ssh, stop);
}

/// Where the SUTs' machine is read; who starts SUTs on another one by hand has to look himself.
record::Readings read_target(const TrialSpec& spec, board::Board* board) {
  if (spec.waits_for_sut) return {};
  return board ? board::probe_board(board->connection(), board::ProbeDepth::kBrief)
               : board::probe_here(board::ProbeDepth::kBrief);
}

std::optional<record::TargetInfo> target_info(const TrialSpec& spec, board::Board* board) {
  if (spec.waits_for_sut) return std::nullopt;
  const auto& target = spec.condition.target;
  return record::TargetInfo{
      .name = target ? target->name : "host",
      .address = board ? scenario::to_string(board->connection().address()) : "",
      .before = read_target(spec, board)};
}

/// Where to listen: a board that may not come through its SSH connection has to reach us.
link::Address listen_address(const TrialSpec& spec, const board::Board* board) {
  if (spec.listen) return *spec.listen;
  return {board && !spec.uses_tunnel ? board->host_address() : "127.0.0.1", 0};
}

std::unique_ptr<link::Server> listen(const TrialSpec& spec, const board::Board* board,
                                     link::ServerEvents& events) try {
  return link::listen_tcp(listen_address(spec, board), kHelloTimeout, events);
} catch (const Error& e) {
  if (!board || spec.listen || spec.uses_tunnel) throw;
  throw Error(e.code(), fmt::format("{}; the board sees this machine as {}, which is none of its "
                                    "addresses: give --tunnel, or --listen ADDRESS:PORT",
                                    e.what(), board->host_address()));
}

/// The server as the SUTs reach it.
std::string sut_address(const TrialSpec& spec, board::Board* board, const link::Server& server) {
  link::Address address = server.address();
  if (!board) return link::to_string(address);
  if (spec.uses_tunnel)
    return fmt::format("127.0.0.1:{}", board->connection().forward_back(address.port));
  const bool is_any = address.host == "0.0.0.0" || address.host == "::";
  if (is_any) address.host = board->host_address();
  return link::to_string(address);
}

/// What to try when a board's SUT could not reach us.
std::string reach_hint(const TrialSpec& spec, const std::string& address,
                       const std::string& reason) {
  const bool is_unreached = reason.find("cannot connect to " + address) != std::string::npos ||
                            reason.find("no SUT joined") != std::string::npos;
  if (spec.uses_tunnel || !is_unreached) return "";
  return fmt::format(
      "; if the board cannot reach {} (a firewall on this machine?), open that port "
      "and name it with --listen, or give --tunnel",
      address);
}

/// A run's report, and what else is to be known of it.
struct Conducted {
  coordinator::RunReport report;
  std::vector<std::string> notes;
};

/// Why a SUT may have been silent; "; " before it, empty: nothing is known.
std::string who_is_stopped(const coordinator::RunReport& report, const SutProcesses& suts) {
  const bool is_silent =
      report.end == RunEnd::kSutHung || (report.end == RunEnd::kSutLost && !report.began);
  const auto stopped = is_silent ? suts.stopped() : std::nullopt;
  return stopped ? "; " + *stopped : "";
}

/// The coordinator's run with its SUTs, up to the closed record.
Conducted conduct(const TrialSpec& spec, RunningSimulator& simulator, board::Board* board,
                  const Timings& timings, const TrialObserver& observer,
                  const std::stop_token& stop) {
  const std::string token = token_of_run();
  const auto recorder = record::make_mcap_recorder(spec.folder / kRecordFile);
  auto options = run_options(spec, timings, token);
  options.header.target = target_info(spec, board);
  coordinator::Coordinator coordinator(simulator.get(), *recorder, std::move(options), host_now);
  const auto server = listen(spec, board, coordinator.events());
  const SutRun sut_run{sut_address(spec, board, *server), token, spec.condition};
  SutProcesses suts;
  if (board) {
    suts.start_on(*board, spec.scenario, sut_run, spec.folder);
  } else if (!spec.waits_for_sut) {
    suts.start(spec.scenario, sut_run, spec.folder);
  }
  warm_up_cameras(simulator.get());
  if (spec.waits_for_sut && observer.on_listening)
    observer.on_listening(sut_instructions(spec.scenario, sut_run));

  StallWatch stalls([&] { return suts.stopped(); }, host_clocks());
  bool joined = false, left_early = false;
  Refusals refusals(observer.on_refused);
  coordinator::RunHooks hooks;
  hooks.should_stop = [&]() -> std::optional<std::pair<RunEnd, std::string>> {
    if (stop.stop_requested())
      return std::pair(RunEnd::kInterrupted, std::string("interrupted by the user"));
    if (const auto why = simulator.lost()) return std::pair(RunEnd::kSimulatorLost, *why);
    if (const auto why = suts.lost()) {
      left_early = true;
      return std::pair(RunEnd::kSutLost, *why);
    }
    if (!joined)
      if (const auto end = suts.early_end()) {
        left_early = true;
        return std::pair(RunEnd::kSutLost,
                         *end + (refusals.last().empty() ? "" : "; " + refusals.last()));
      }
    return std::nullopt;
  };
  hooks.on_status = [&](const coordinator::RunStatus& status) {
    joined = status.joined == spec.scenario.uavs.size();
    if (observer.on_status) observer.on_status(status);
    const std::string stall = stalls.look(status, host_clocks());
    // Who starts the SUTs himself has been told that they are waited for.
    const bool is_told = spec.waits_for_sut && status.joined == 0;
    if (!stall.empty() && !is_told && observer.on_blocked) observer.on_blocked(stall);
  };
  hooks.on_refused = [&](const std::string& text) { refusals.add(text); };
  hooks.read_target = [&] { return read_target(spec, board); };
  auto report = coordinator.run(*server, hooks);
  refusals.close();
  report.reason += who_is_stopped(report, suts);
  if (report.end == RunEnd::kSutLost && !left_early) report.reason += suts.post_mortem();
  if (report.end == RunEnd::kSimulatorLost) report.reason += simulator.post_mortem(report.reason);
  std::vector<std::string> notes = stalls.notes(host_clocks());
  if (report.end == RunEnd::kFinished)
    for (std::string& note : suts.let_leave()) notes.push_back(std::move(note));
  if (board && !report.began) report.reason += reach_hint(spec, sut_run.address, report.reason);
  for (const std::string& warning : suts.bring_back())
    if (observer.warn) observer.warn(warning);
  return {std::move(report), std::move(notes)};
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
campaign::TrialResult fly(const TrialSpec& spec, const SimulatorOption& option, sim::World world,
                          const Timings& timings, const TrialObserver& observer,
                          const std::stop_token& stop) {
  const auto board = hold_board(spec, stop);
  RunningSimulator simulator(option, std::move(world), simulator_setup(spec, observer, stop));
  try {
    const auto [report, notes] = conduct(spec, simulator, board.get(), timings, observer, stop);
    auto result = judged(spec, report);
    result.this_run.notes = notes;
    result.versions["simulator"] = simulator.get().description();
    return result;
  } catch (const Error& e) {
    throw Error(e.code(), e.what() + simulator.post_mortem(e.what()));
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

campaign::TrialResult run_trial(const TrialSpec& spec, const TrialObserver& observer,
                                const std::stop_token& stop) {
  // Whatever is wrong with the user's words and files shows before anything is written.
  const SimulatorOption simulator = parse_simulator_option(spec.condition.simulator);
  scenario::require_clock(spec.scenario, spec.condition);
  sim::World world =
      sim::load_world(scenario::world_request(spec.scenario, spec.seed), observer.warn);
  require_readable(world, simulator);
  const Timings timings =
      scenario::resolve_sensors(spec.scenario, spec.condition, world, observer.warn);
  world.step = spec.scenario.step;
  if (is_local(spec)) require_sut_programs(spec.scenario, spec.condition);
  const TrialFolder folder(spec.folder);

  const std::string started_at = utc_now();
  campaign::TrialResult result;
  try {
    result = fly(spec, simulator, std::move(world), timings, observer, stop);
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

}  // namespace tether::app
