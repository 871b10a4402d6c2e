#include "trial_run.h"

#include <chrono>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/board/target_probe.h>
#include <tether/os/machine.h>
#include <tether/runner/trial_folder.h>
#include <tether/sync/clock_plausibility.h>

/// Sets up the coordinator, its server and its record, and conducts the run. While it runs, hooks
/// of the coordinator look for a reason to end it early. Causes that only processes show (an exit
/// code, a stopped process) are added to the report afterwards.
namespace tether::runner {

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
    throw Error(
        ErrorCode::kSetup,
        fmt::format("TETHER_TOKEN is too long ({} bytes). At most {} bytes are allowed; if it "
                    "is not set, the run generates a token",
                    token.size(), link::kMaxNameBytes))
        .about("TETHER_TOKEN");
  return token;
}

/// 0: not known, or out of range.
int known_cores() {
  const int cores = os::machine_cores();
  return cores <= sync::kMostCores ? cores : 0;
}

/// The state of the SUTs' machine; empty if the user starts the SUTs.
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

std::vector<os::CountFile> count_files(const TrialSpec& spec) {
  std::vector<os::CountFile> counts;
  const auto& target = spec.condition.target;
  if (target && target->emulator)
    for (std::size_t i = 0; i < spec.scenario.uavs.size(); ++i)
      counts.emplace_back(*target->emulator);
  return counts;
}

coordinator::RunOptions run_options(const TrialSpec& spec, const TrialInputs& inputs,
                                    const std::string& token,
                                    const std::optional<record::TargetInfo>& target) {
  coordinator::RunOptions options;
  options.policy = spec.condition.policy == scenario::Policy::kFreeRunning
                       ? sync::SyncPolicy::kFreeRunning
                       : sync::SyncPolicy::kConservativeBarrier;
  const coordinator::ClockSetting clock = clock_of(spec.condition);
  options.uavs.resize(inputs.timings.size());
  for (std::size_t i = 0; i < options.uavs.size(); ++i) {
    coordinator::UavOptions& uav = options.uavs[i];
    uav.timings = inputs.timings[i];
    uav.command_latency = spec.scenario.uavs[i].command_latency;
    uav.clock = clock;
    uav.cores = spec.sut_place() == SutPlace::kThisMachine ? known_cores() : 0;
    if (inputs.replayed.replays.empty()) continue;
    uav.replay = inputs.replayed.replays[i];
    uav.replayed_from = inputs.replayed.from;
  }
  options.token = token;
  options.seed = spec.seed;
  options.real_time_factor = spec.condition.real_time_factor;
  options.time_limit = spec.scenario.time_limit;
  options.hang_limit = spec.scenario.hang_limit;
  options.connect_limit =
      spec.waits_for_sut ? Duration(std::chrono::hours(24)) : spec.scenario.connect_limit;
  options.ground_truth_period = spec.scenario.ground_truth_period;
  options.record_images = spec.scenario.record_images;
  options.image_period = spec.scenario.image_period;
  options.radio = spec.condition.radio.value_or(spec.scenario.radio);
  options.header.tether_version = version();
  options.header.scenario = spec.scenario.name;
  options.header.condition = spec.condition.name;
  options.header.machine = os::describe_machine();
  options.header.target = target;
  options.header.emulator = campaign::emulator_of(spec.condition);
  return options;
}

/// Renders an image of each camera while the processes of the SUTs start, because the first one
/// takes by far the longest (start of GL, shaders).
void warm_up_cameras(sim::Simulator& simulator) {
  sim::Snapshot snapshot;
  simulator.capture(snapshot);
  for (std::size_t u = 0; u < simulator.world().uavs.size(); ++u) {
    const auto& sensors = simulator.world().uavs[u].sensors;
    for (std::size_t s = 0; s < sensors.size(); ++s)
      if (sensors[s].kind() == uav::SensorKind::kCamera) simulator.measure(snapshot, u, s, 0);
  }
}

/// Where to listen. A board without a tunnel must be able to reach the address.
link::Address listen_address(const TrialSpec& spec, const board::Board* board) {
  if (spec.listen) return *spec.listen;
  return {board && !spec.uses_tunnel ? board->host_address() : "127.0.0.1", 0};
}

std::unique_ptr<link::Server> listen(const TrialSpec& spec, const board::Board* board) try {
  return link::listen_tcp(listen_address(spec, board), kHelloTimeout);
} catch (const Error& e) {
  if (!board || spec.listen || spec.uses_tunnel) throw;
  throw Error(e.code(),
              fmt::format("{}; the board sees this machine at {}, which is not an address "
                          "of this machine. Use --tunnel, or --listen ADDRESS:PORT",
                          e.what(), board->host_address()))
      .about(board->host_address());
}

/// The server's address for the SUTs.
std::string sut_address(const TrialSpec& spec, board::Board* board, const link::Server& server) {
  link::Address address = server.address();
  if (!board) return link::to_string(address);
  if (spec.uses_tunnel)
    return fmt::format("127.0.0.1:{}", board->connection().forward_back(address.port));
  const bool is_any = address.host == "0.0.0.0" || address.host == "::";
  if (is_any) address.host = board->host_address();
  return link::to_string(address);
}

}  // namespace

TrialRun::TrialRun(const TrialSpec& spec, const TrialInputs& inputs, RunningSimulator& simulator,
                   board::Board* board, const TrialObserver& observer, std::stop_token stop)
    : spec_(spec),
      simulator_(simulator),
      board_(board),
      observer_(observer),
      stop_(std::move(stop)),
      token_(token_of_run()),
      target_(target_info(spec, board)),
      recorder_(record::make_mcap_recorder(spec.folder / kRecordFile)),
      coordinator_(simulator.get(), *recorder_, run_options(spec, inputs, token_, target_),
                   host_now),
      server_(listen(spec, board)),
      sut_run_{sut_address(spec, board, *server_), token_, spec.condition, count_files(spec)},
      refusals_(observer.on_refused) {}

Conducted TrialRun::conduct() {
  if (board_ || !spec_.waits_for_sut) suts_.start(spec_.scenario, sut_run_, spec_.folder, board_);
  warm_up_cameras(simulator_.get());
  if (spec_.waits_for_sut && observer_.on_listening)
    observer_.on_listening(sut_instructions(spec_.scenario, sut_run_));
  TrialEnd end = fly();
  end.report.reason += explanation(end);
  end_suts(end);
  return {std::move(end.report), std::move(notes_), target_, target_after_};
}

TrialEnd TrialRun::fly() {
  TrialEnd end;
  StallWatch stalls([&] { return suts_.stopped(); }, host_clocks());
  coordinator::RunHooks hooks;
  hooks.should_stop = [&]() -> std::optional<coordinator::Ending> {
    const auto stop = early_stop();
    if (!stop) return std::nullopt;
    end.cause = stop->cause;
    return to_run_end(*stop);
  };
  hooks.on_status = [&](const coordinator::RunStatus& status) { watch(status, stalls); };
  hooks.on_refused = [&](const std::string& address, const std::string& reason) {
    refusals_.add(address, reason, !spec_.waits_for_sut && !have_all_joined_);
  };
  hooks.read_target = [&] { return target_after_ = read_target(spec_, board_); };
  if (!sut_run_.counts.empty())
    hooks.computed_by = [&](std::size_t uav) { return sut_run_.counts[uav].computed(); };
  end.report = coordinator_.run(*server_, hooks);
  refusals_.close();
  notes_ = stalls.notes(host_clocks());
  return end;
}

std::optional<EarlyStop> TrialRun::early_stop() {
  if (stop_.stop_requested()) return EarlyStop{StopCause::kInterrupted, "interrupted by the user"};
  if (const auto why = simulator_.lost()) return EarlyStop{StopCause::kSimulatorLost, *why};
  if (const auto why = suts_.lost()) return EarlyStop{StopCause::kBoardLost, *why};
  const auto ended = have_all_joined_ ? std::nullopt : suts_.early_end();
  if (!ended) return std::nullopt;
  // Most programs print the reason for which they were rejected: it is part of their end.
  const std::string why = refusals_.take_last();
  const bool is_known = ended->find(why) != std::string::npos;
  return EarlyStop{StopCause::kSutEnded,
                   *ended + (is_known ? "" : "; its connection was refused: " + why)};
}

void TrialRun::watch(const coordinator::RunStatus& status, StallWatch& stalls) {
  have_all_joined_ = status.joined == spec_.scenario.uavs.size();
  if (observer_.on_status) observer_.on_status(status);
  const std::string stall = stalls.check(status, host_clocks());
  // on_listening has already asked the user to start the SUTs.
  const bool is_known = spec_.waits_for_sut && status.joined == 0;
  if (!stall.empty() && !is_known && observer_.on_blocked) observer_.on_blocked(stall);
}

/// What else is known about the end, each part after "; ".
std::string TrialRun::explanation(const TrialEnd& end) {
  std::string text;
  if (may_have_stopped_sut(end))
    if (const auto stopped = suts_.stopped()) text += "; " + *stopped;
  if (has_unexplained_sut(end)) text += suts_.post_mortem();
  if (end.report.end == RunEnd::kSimulatorLost) text += simulator_.post_mortem();
  return text + reach_hint(end);
}

/// What to try if a SUT on a board could not reach this machine.
std::string TrialRun::reach_hint(const TrialEnd& end) {
  if (!board_ || spec_.uses_tunnel || end.report.began) return "";
  const bool is_unreached = lacks_sut(end) || (end.report.end == RunEnd::kSutLost &&
                                               suts_.has_failed_to_connect(sut_run_.address));
  if (!is_unreached) return "";
  return fmt::format(
      "; if the board cannot reach {} (a firewall on this machine?), open a port and pass it with "
      "--listen, or use --tunnel",
      sut_run_.address);
}

void TrialRun::end_suts(const TrialEnd& end) {
  if (end.report.end == RunEnd::kFinished)
    for (std::string& note : suts_.await_exit()) notes_.push_back(std::move(note));
  for (const std::string& warning : suts_.bring_back())
    if (observer_.warn) observer_.warn(warning);
}

}  // namespace tether::runner
