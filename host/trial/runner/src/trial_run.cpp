#include "trial_run.h"

#include "controller_options.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/autopilot/flight_controller.h>
#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/board/target_probe.h>
#include <tether/judge/judge.h>
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

/// In whose time this machine measures that of SUTs, if it does.
std::optional<clockid_t> measuring_clock(const TrialSpec& spec) {
  std::optional<clockid_t> clock;
  for (std::size_t uav = 0; uav < spec.scenario.uavs.size(); ++uav) {
    if (spec.sut_place(uav) != SutPlace::kThisMachine) continue;
    const computer::Clock own = computer_of(spec.condition, uav).clock;
    if (own.kind == computer::ClockKind::kCpu) return CLOCK_THREAD_CPUTIME_ID;
    if (!own.repeats()) clock = CLOCK_MONOTONIC;
  }
  return clock;
}

/// Whether all programs of a run are this one's descendants.
bool starts_all_programs(const TrialSpec& spec) {
  const bool is_address = spec.condition.simulator.find(':') != std::string::npos;
  return !is_address && !spec.has_sut_at(SutPlace::kUnknown);
}

/// The state of a board, or of this machine.
record::Readings read_target(board::Board* board) {
  return board ? board::probe_board(board->connection(), board::ProbeDepth::kBrief)
               : board::probe_here(board::ProbeDepth::kBrief);
}

/// The machine of that UAV's SUT.
record::TargetInfo target_info(const TrialSpec& spec, board::Board* board, std::size_t uav) {
  const scenario::Computer& own = computer_of(spec.condition, uav);
  return {.name = !own.name.empty() ? own.name
                  : own.target      ? own.target->name
                                    : "host",
          .address = board ? scenario::to_string(board->connection().address()) : "",
          .before = read_target(board)};
}

/// The UAVs with whose SUTs the machines of a run are first used. Empty: the user starts all SUTs.
std::vector<std::size_t> first_on_machines(const TrialSpec& spec, const Boards& boards) {
  std::vector<std::size_t> uavs;
  for (std::size_t uav = 0; uav < boards.by_uav.size(); ++uav) {
    const bool is_known = std::ranges::any_of(
        uavs, [&](std::size_t other) { return boards.by_uav[other] == boards.by_uav[uav]; });
    if (!is_known && spec.sut_place(uav) != SutPlace::kUnknown) uavs.push_back(uav);
  }
  return uavs;
}

std::optional<record::TargetInfo> first_target(const TrialSpec& spec, const Boards& boards) {
  const auto machines = first_on_machines(spec, boards);
  if (machines.empty()) return std::nullopt;
  return target_info(spec, boards.by_uav[machines.front()], machines.front());
}

std::vector<MachineReadings> other_targets(const TrialSpec& spec, const Boards& boards) {
  std::vector<MachineReadings> others;
  for (const std::size_t uav : first_on_machines(spec, boards))
    others.push_back(
        {uav == 0 ? record::TargetInfo{} : target_info(spec, boards.by_uav[uav], uav), {}});
  if (!others.empty()) others.erase(others.begin());
  return others;
}

std::map<std::size_t, os::CountFile> count_files(const TrialSpec& spec) {
  std::map<std::size_t, os::CountFile> counts;
  for (std::size_t i = 0; i < spec.scenario.uavs.size(); ++i)
    if (const auto& target = computer_of(spec.condition, i).target; target && target->emulator)
      counts.try_emplace(i, *target->emulator);
  return counts;
}

/// The computers that several SUTs share.
void share_boards(const scenario::Condition& condition, coordinator::RunOptions& options) {
  for (const scenario::RealBoard& board : real_boards(condition, options.uavs.size())) {
    for (const std::size_t uav : board.uavs) options.uavs[uav].board = options.boards.size();
    options.boards.push_back({.name = board.name, .cores = 0, .is_real = true});
  }
  for (std::size_t i = 0; i < condition.computers.size(); ++i) {
    const bool is_real = condition.computers[i].clock.kind == computer::ClockKind::kWall;
    if (is_real || !is_shared(condition, i)) continue;
    for (std::size_t uav = 0; uav < options.uavs.size(); ++uav) {
      if (condition.seats[uav].computer != i) continue;
      options.uavs[uav].board = options.boards.size();
      options.uavs[uav].pinned_core = condition.seats[uav].pinned_core;
    }
    options.boards.push_back({condition.computers[i].name, condition.computers[i].cores});
  }
}

coordinator::RunOptions run_options(const TrialSpec& spec, const TrialInputs& inputs,
                                    const sim::Simulator& simulator, const std::string& token,
                                    const std::optional<record::TargetInfo>& target) {
  coordinator::RunOptions options;
  options.policy = spec.condition.policy == scenario::Policy::kFreeRunning
                       ? sync::SyncPolicy::kFreeRunning
                       : sync::SyncPolicy::kConservativeBarrier;
  options.uavs.resize(inputs.timings.size());
  for (std::size_t i = 0; i < options.uavs.size(); ++i) {
    coordinator::UavOptions& uav = options.uavs[i];
    uav.timings = inputs.timings[i];
    uav.command_latency = spec.scenario.uavs[i].command_latency;
    uav.setpoint_loss = spec.scenario.uavs[i].setpoint_loss;
    if (const auto& controller = spec.scenario.uavs[i].flight_controller)
      uav.controller = controller_options(*controller, simulator, i, spec.seed, spec.folder);
    uav.as_is = spec.scenario.uavs[i].sut.is_as_is;
    const scenario::Computer& own = computer_of(spec.condition, i);
    uav.clock = own.clock;
    uav.computer = own.name;
    if (own.target && !own.target->emulator)
      uav.launcher = fmt::format("{}", fmt::join(own.target->launcher, " "));
    // Another folder may have other files for the program. A board has its own in any case.
    if (own.target && !own.target->ssh && !own.target->program_folder.empty())
      uav.launcher += " in " + own.target->program_folder;
    uav.cores = spec.sut_place(i) == SutPlace::kThisMachine ? known_cores() : 0;
    if (inputs.replayed.replays.empty()) continue;
    uav.given_time = giver_of(inputs.replayed.replays[i]);
    uav.replayed_from = inputs.replayed.from;
  }
  share_boards(spec.condition, options);
  options.token = token;
  options.seed = spec.seed;
  options.real_time_factor = spec.condition.real_time_factor;
  options.time_limit = spec.scenario.time_limit;
  options.hang_limit = spec.scenario.hang_limit;
  options.connect_limit = spec.has_sut_at(SutPlace::kUnknown) ? Duration(std::chrono::hours(24))
                                                              : spec.scenario.connect_limit;
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

/// Where to listen. Boards without a tunnel must be able to reach the address.
link::Address listen_address(const TrialSpec& spec, const Boards& boards) {
  if (spec.listen) return *spec.listen;
  if (boards.all.empty() || spec.uses_tunnel) return {"127.0.0.1", 0};
  const std::string seen = boards.all.front()->host_address();
  const bool is_one = std::ranges::all_of(
      boards.all, [&](const auto& board) { return board->host_address() == seen; });
  return {is_one ? seen : "0.0.0.0", 0};
}

// Without descriptors, connections would wait until the time limit for SUTs to connect.
void allow_connections(std::size_t uavs) {
  constexpr std::size_t kOfRun = 48, kOfEach = 8;  // more than are used
  const std::size_t needed = kOfRun + kOfEach * uavs;
  const std::size_t allowed = os::allow_descriptors(needed);
  if (allowed < needed)
    throw Error(ErrorCode::kSetup, fmt::format("a run of {} UAVs needs {} open files, but only {} "
                                               "are allowed. Raise the hard limit (as root: ulimit "
                                               "-Hn {}, or nofile in /etc/security/limits.conf)",
                                               uavs, needed, allowed, needed));
}

std::unique_ptr<link::Server> listen(const TrialSpec& spec, const Boards& boards) try {
  return link::listen_tcp(listen_address(spec, boards), kHelloTimeout);
} catch (const Error& e) {
  if (boards.all.empty() || spec.listen || spec.uses_tunnel) throw;
  const std::string seen = boards.all.front()->host_address();
  throw Error(e.code(),
              fmt::format("{}; the board sees this machine at {}, which is not an address "
                          "of this machine. Use --tunnel, or --listen ADDRESS:PORT",
                          e.what(), seen))
      .about(seen);
}

/// The server's address for the SUTs on that board, or here.
std::string sut_address(const TrialSpec& spec, board::Board* board, const link::Server& server) {
  link::Address address = server.address();
  const bool is_any = address.host == "0.0.0.0" || address.host == "::";
  if (!board) {
    if (is_any && spec.has_sut_at(SutPlace::kBoard)) address.host = "127.0.0.1";
    return link::to_string(address);
  }
  if (spec.uses_tunnel)
    return fmt::format("127.0.0.1:{}", board->connection().forward_back(address.port));
  if (is_any) address.host = board->host_address();
  return link::to_string(address);
}

/// Each board's, by UAV.
std::map<std::size_t, std::string> addresses_of(const TrialSpec& spec, const Boards& boards,
                                                const link::Server& server) {
  std::map<std::size_t, std::string> addresses;
  for (const auto& board : boards.all) {
    const std::string address = sut_address(spec, board.get(), server);
    for (std::size_t uav = 0; uav < boards.by_uav.size(); ++uav)
      if (boards.by_uav[uav] == board.get()) addresses[uav] = address;
  }
  return addresses;
}

/// The groups of SUTs that share a real board. Their sockets are where only their user can connect:
/// in a private folder or, of SUTs that the user starts, with a name that nobody else can guess.
std::vector<SutGroup> groups_of(const TrialSpec& spec, const Boards& boards,
                                std::optional<os::TemporaryFolder>& folder) {
  constexpr std::size_t kLetters = 12;
  std::vector<SutGroup> groups;
  for (scenario::RealBoard& real : real_boards(spec.condition, spec.scenario.uavs.size())) {
    const std::size_t first = real.uavs.front();
    const board::Board* const board = boards.by_uav[first];
    const std::string name = "group" + std::to_string(groups.size());
    std::string socket = "/tmp/tether-" + link::make_token().substr(0, kLetters);
    if (board) {
      socket = board->folder() + "/" + name;
    } else if (spec.sut_place(first) == SutPlace::kThisMachine) {
      if (!folder) folder.emplace("tether-groups-");
      socket = *folder / name;
    }
    groups.push_back({std::move(real.name), std::move(real.uavs), std::move(socket)});
  }
  return groups;
}

}  // namespace

TrialRun::TrialRun(const TrialSpec& spec, const TrialInputs& inputs, RunningSimulator& simulator,
                   const Boards& boards, const TrialObserver& observer, std::stop_token stop)
    : spec_(spec),
      inputs_(inputs),
      simulator_(simulator),
      boards_(boards),
      observer_(observer),
      stop_(std::move(stop)),
      token_(token_of_run()),
      target_(first_target(spec, boards)),
      file_(record::make_mcap_recorder(spec.folder / kRecordFile)),
      recorder_({file_.get(), &memory_}),
      coordinator_(simulator.get(), recorder_,
                   run_options(spec, inputs, simulator.get(), token_, target_), host_now),
      server_((allow_connections(spec.scenario.uavs.size()), listen(spec, boards))),
      sut_run_{sut_address(spec, nullptr, *server_),
               token_,
               spec.condition,
               count_files(spec),
               addresses_of(spec, boards, *server_),
               groups_of(spec, boards, groups_folder_)},
      refusals_(observer.on_refused),
      others_(other_targets(spec, boards)) {}

Conducted TrialRun::conduct() {
  std::optional<MachineWatch> machine;
  const auto clock = measuring_clock(spec_);
  if (clock) machine.emplace(machine_reader(*clock));
  if (!spec_.waits_for_sut) suts_.start(spec_.scenario, sut_run_, spec_.folder, boards_.by_uav);
  warm_up_cameras(simulator_.get());
  if (spec_.has_sut_at(SutPlace::kUnknown) && observer_.on_listening)
    observer_.on_listening(sut_instructions(spec_.scenario, sut_run_, spec_.waits_for_sut));
  TrialEnd end = fly(machine);
  end.report.reason = explained(end);
  end_suts(end);
  std::vector<campaign::Doubt> doubted = doubts(end.report);
  std::vector<campaign::MachineLoad> loads;
  if (machine) {
    loads.push_back(machine->load(starts_all_programs(spec_)));
    if (auto doubt = doubt_of(loads.back(), *clock == CLOCK_MONOTONIC))
      doubted.push_back(std::move(*doubt));
  }
  return {
      std::move(end.report), memory_.take(),       std::move(notes_), std::move(stopped_program_),
      std::move(doubted),    std::move(loads),     target_,           target_after_,
      std::move(others_),    std::move(bad_exits_)};
}

TrialEnd TrialRun::fly(std::optional<MachineWatch>& machine) {
  TrialEnd end;
  StallWatch stalls([&] { return suts_.stopped(); }, host_clocks());
  coordinator::RunHooks hooks;
  hooks.should_stop = [&]() -> std::optional<coordinator::Ending> {
    const auto stop = early_stop();
    if (!stop) return std::nullopt;
    end.cause = stop->cause;
    return to_run_end(*stop);
  };
  hooks.on_status = [&](const coordinator::RunStatus& status) {
    watch(status, stalls);
    if (machine) machine->during_run(host_now());
  };
  hooks.on_refused = [&](const std::string& address, const std::string& reason) {
    refusals_.add(address, reason, !spec_.waits_for_sut && !have_all_joined_);
  };
  SutWatch watched(server_->address().port);
  hooks.on_joined = [&](std::size_t uav, const std::string& address, std::uint32_t process) {
    // Of processes on one core, none computes beside another, and tether-exec sees all waits.
    if (!spec_.scenario.uavs[uav].sut.has_all_processes) watched.joined(uav, address, process);
  };
  std::vector<judge::FlightWatch> watches;
  for (const auto& uav : spec_.scenario.uavs)
    if (uav.sut.mission &&
        std::ranges::any_of(uav.sut.mission->clauses, &mission::Clause::ends_flight))
      watches.emplace_back(*uav.sut.mission, uav.placement.name, memory_.so_far());
  if (!watches.empty())
    hooks.killed = [&] {
      std::optional<std::pair<SimTime, std::string>> first;
      for (judge::FlightWatch& watched_flight : watches)
        if (const auto miss = watched_flight.look(); miss && (!first || miss->at < first->first))
          first.emplace(miss->at, miss->reason);
      return first;
    };
  hooks.threads_of = [&](std::size_t uav) { return watched.states(uav); };
  hooks.read_target = [&] { return read_targets(); };
  if (!sut_run_.counts.empty())
    hooks.computed_by = [&](std::size_t uav) {
      const auto counts = sut_run_.counts.find(uav);
      return counts == sut_run_.counts.end() ? Duration(0) : counts->second.computed();
    };
  end.report = coordinator_.run(*server_, hooks);
  if (machine) machine->end_of_run();
  refusals_.close();
  notes_ = stalls.notes(host_clocks());
  stopped_program_ = stalls.stopped_program();
  for (const coordinator::SutReport& sut : end.report.suts)
    for (const auto& [sensor, count] : sut.unqueued)
      notes_.push_back(fmt::format("{}{} measurements of '{}' of {} had no place in its queue",
                                   spec_.condition.policy == scenario::Policy::kFreeRunning
                                       ? "in free running nothing waits: "
                                       : "",
                                   count, sensor, sut.uav));
  return end;
}

std::vector<campaign::Doubt> TrialRun::doubts(const coordinator::RunReport& report) const {
  std::vector<campaign::Doubt> doubts = inputs_.replayed.doubts;
  for (std::size_t uav = 0; uav < report.suts.size(); ++uav)
    std::ranges::copy(doubts_of(report.suts[uav], computer_of(spec_.condition, uav).clock,
                                inputs_.replayed.has_waits, spec_.scenario.uavs[uav].sut.is_as_is),
                      std::back_inserter(doubts));
  std::ranges::stable_sort(doubts, {}, &campaign::Doubt::kind);
  return doubts;
}

/// The first one is for the record.
record::Readings TrialRun::read_targets() {
  const auto machines = first_on_machines(spec_, boards_);
  for (std::size_t i = 0; i < machines.size(); ++i)
    (i == 0 ? target_after_ : others_[i - 1].after) = read_target(boards_.by_uav[machines[i]]);
  return target_after_;
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
  const bool is_known = spec_.has_sut_at(SutPlace::kUnknown) && status.joined == 0;
  if (!stall.empty() && !is_known && observer_.on_blocked) observer_.on_blocked(stall);
}

/// The reason of the end, with what else is known about it.
std::string TrialRun::explained(const TrialEnd& end) {
  std::string causes;
  if (may_have_stopped_sut(end))
    if (const auto stopped = suts_.stopped()) causes += "; " + *stopped;
  if (has_unexplained_sut(end)) causes += suts_.post_mortem(end.report.reason, end.report.lost_uav);
  if (end.report.end == RunEnd::kSimulatorLost) causes += simulator_.post_mortem();
  return with_causes(end.report, causes) + reach_hint(end);
}

/// What to try if a SUT on a board could not reach this machine.
std::string TrialRun::reach_hint(const TrialEnd& end) {
  if (boards_.all.empty() || spec_.uses_tunnel || end.report.began) return "";
  const std::string& address = sut_run_.addresses.begin()->second;
  const bool is_unreached = lacks_sut(end) || (end.report.end == RunEnd::kSutLost &&
                                               suts_.has_failed_to_connect(address));
  if (!is_unreached) return "";
  return fmt::format(
      "; if the board cannot reach {} (a firewall on this machine?), open a port and pass it with "
      "--listen, or use --tunnel",
      address);
}

void TrialRun::end_suts(const TrialEnd& end) {
  if (end.report.end == RunEnd::kFinished) bad_exits_ = suts_.await_exit(end.report.suts);
  for (const std::string& warning : suts_.bring_back())
    if (observer_.warn) observer_.warn(warning);
  if (std::ranges::any_of(spec_.scenario.uavs, [](const scenario::UavSetup& uav) {
        return uav.flight_controller &&
               uav.flight_controller->ground_station == autopilot::GroundStation::kCommands;
      }))
    notes_.emplace_back("a ground station could command: the flight need not repeat");
}

}  // namespace tether::runner
