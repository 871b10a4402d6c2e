#include "coordinator_impl.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/coordinator/coordinator.h>

/// The loop of a run: its start, pacing, limits of WT, and its end. Each turn advances ST as far as
/// the barrier, the pace and the next due event allow, and then handles the messages that have
/// arrived. Messages are handled in incoming.cpp, replies in outgoing.cpp.
namespace tether::coordinator {

namespace {

// Steps between two polls of the sockets: about half a millisecond of WT in the embedded simulator.
constexpr int kStepsPerTurn = 64;
// How long the loop sleeps when there is nothing to do; a message wakes it at once.
constexpr Duration kIdleWait = std::chrono::milliseconds(20);
// A paced simulation may catch up this much ST after a late turn (rendering an image, say); two
// steps at least.
constexpr Duration kPaceCredit = std::chrono::milliseconds(50);
// How long a UAV without power may fall before the run ends.
constexpr Duration kFall = std::chrono::seconds(2);
// A SUT sends no more at once, unless it floods the coordinator.
constexpr int kMostPolls = 8;

// In free running the state at the next read is not known, and nothing is drawn ahead.
Sampler::Sensor make_sensor(const sim::Sensor& sensor, const std::string& uav,
                            const uav::SensorTiming& timing, const RunOptions& options) {
  const auto driver = [&](std::optional<Duration> period) {
    return uav::Driver(sensor.driver, period, options.seed, uav, sensor.name);
  };
  if (options.policy == sync::SyncPolicy::kFreeRunning)
    return {.name = sensor.name,
            .schedule = SensorSchedule::in_free_running(timing, driver(std::nullopt))};
  const auto* periodic = std::get_if<uav::PeriodicTiming>(&timing);
  return {.name = sensor.name,
          .schedule = {timing, options.seed, random_stream(uav, sensor.name, "delay"),
                       driver(periodic ? std::optional(periodic->period) : std::nullopt)},
          .is_drawn = sensor.kind() == uav::SensorKind::kCamera};
}

std::vector<Sampler> make_samplers(const sim::Simulator& simulator, const RunOptions& options) {
  std::vector<Sampler> samplers;
  for (const sim::Uav& uav : simulator.world().uavs) {
    const auto& timings = options.uavs[samplers.size()].timings;
    std::vector<Sampler::Sensor> sensors;
    for (const sim::Sensor& sensor : uav.sensors)
      sensors.push_back(make_sensor(sensor, uav.name, timings[sensors.size()], options));
    samplers.emplace_back(std::move(sensors), simulator.grid());
  }
  return samplers;
}

std::vector<std::optional<uav::SetpointLoss>> losses_of(const sim::Simulator& simulator,
                                                        const RunOptions& options) {
  std::vector<std::optional<uav::SetpointLoss>> losses;
  for (const UavOptions& uav : options.uavs) {
    const auto& loss = losses.emplace_back(uav.setpoint_loss);
    if (loss && loss->action == uav::LossAction::kHover && !simulator.takes_setpoints())
      throw Error(ErrorCode::kSetup,
                  "on_setpoint_loss = \"hover\" needs a simulator that takes positions, and this "
                  "one takes velocities only. Use \"brake\".");
  }
  return losses;
}

std::vector<Session> make_sessions(const sim::Simulator& simulator, const RunOptions& options) {
  const sim::World& world = simulator.world();
  std::vector<Session> sessions(world.uavs.size());
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    sessions[i].uav = i;
    sessions[i].uav_name = world.uavs[i].name;
    sessions[i].command_latency = options.uavs[i].command_latency;
    sessions[i].latency_key = {options.seed,
                               random_stream(world.uavs[i].name, "command", "latency")};
    if (simulator.takes_setpoints()) sessions[i].limits = flight_limits(world.uavs[i].airframe);
    sessions[i].limits.joints = world.uavs[i].joints;
    sessions[i].cores = options.uavs[i].cores;
    if (options.uavs[i].given_time) sessions[i].replay = options.uavs[i].given_time();
    sessions[i].recorded_image_at.resize(world.uavs[i].sensors.size());
  }
  return sessions;
}

std::vector<std::string> names_of(const sim::World& world) {
  std::vector<std::string> names;
  for (const sim::Uav& uav : world.uavs) names.push_back(uav.name);
  return names;
}

uav::Catalogue catalogue_of(const sim::World& world, const Session& session, bool has_battery) {
  const sim::Uav& uav = world.uavs[session.uav];
  uav::Catalogue catalogue = sim::make_catalogue(world, uav);
  if (has_battery) catalogue.battery_capacity_C = uav.energy->battery.capacity_C;
  catalogue.limits = session.limits;
  return catalogue;
}

RunOptions checked(RunOptions options, const sim::Simulator& simulator) {
  const sim::World& world = simulator.world();
  const auto require = [](bool condition, const char* what) {
    if (!condition) throw Error(ErrorCode::kInternal, std::string("coordinator options: ") + what);
  };
  require(options.uavs.size() == world.uavs.size(), "one entry per UAV of the world is needed");
  for (std::size_t i = 0; i < world.uavs.size(); ++i)
    require(options.uavs[i].timings.size() == world.uavs[i].sensors.size(),
            "one timing per sensor is needed");
  for (const UavOptions& uav : options.uavs)
    require(uav.cores >= 0 && uav.cores <= sync::kMostCores, "the number of cores is out of range");
  require(!options.token.empty(), "a token is needed");
  require(options.time_limit > Duration(0), "the time limit must be positive");
  require(options.ground_truth_period > Duration(0), "the ground truth's period must be positive");
  options.ground_truth_period = std::max(options.ground_truth_period, simulator.grid().dt());
  return options;
}

}  // namespace

std::string_view name(RunEnd end) {
  constexpr std::string_view kNames[] = {"finished",      "time_limit",     "sut_lost",
                                         "sut_hung",      "simulator_lost", "interrupted",
                                         "battery_empty", "record_failed",  "timing_differs",
                                         "flooded",       "killed"};
  return kNames[static_cast<std::size_t>(end)];
}

Coordinator::Coordinator(sim::Simulator& simulator, record::Recorder& recorder, RunOptions options,
                         std::function<WallTime()> host_clock)
    : impl_(
          std::make_unique<Impl>(simulator, recorder, std::move(options), std::move(host_clock))) {}
Coordinator::~Coordinator() = default;
RunReport Coordinator::run(link::Server& server, const RunHooks& hooks) {
  return impl_->run(server, hooks);
}

Coordinator::Impl::Impl(sim::Simulator& simulator, record::Recorder& recorder, RunOptions options,
                        std::function<WallTime()> host_clock)
    : options_(checked(std::move(options), simulator)),
      host_clock_(std::move(host_clock)),
      log_(recorder),
      times_(options_, simulator.grid()),
      stepper_(simulator, times_, log_, options_.ground_truth_period,
               make_samplers(simulator, options_), losses_of(simulator, options_)),
      sessions_(make_sessions(simulator, options_)),
      radio_(options_.radio, options_.seed, names_of(world()), log_),
      controllers_(options_, names_of(world()), stepper_, log_),
      watchdog_({.st = grid().ceil(SimTime(options_.time_limit)),
                 .connect = options_.connect_limit,
                 .hang = options_.hang_limit},
                sessions_.size(), host_clock_()),
      looks_(sessions_.size(), times_) {}

RunReport Coordinator::Impl::run(link::Server& server, const RunHooks& hooks) {
  peers_.begin(server, hooks.on_refused);
  hooks_ = hooks;
  watchdog_.moved(host_clock_());
  while (!ends_.is_over()) {
    try {
      turn();
      watch();
    } catch (const SimulatorFailure& e) {
      stop_if_asked();  // the caller may know a cause of the failure
      end({RunEnd::kSimulatorLost, e.what()});
    } catch (const RecordFailure& e) {
      end({RunEnd::kRecordFailed, e.what()});
    }
  }
  return close_run();
}

void Coordinator::Impl::turn() {
  const bool moved = is_running() && advance();
  const Duration wait = pace_ ? std::min(kIdleWait, pace_->wait_for(grid().dt())) : kIdleWait;
  for (const link::Event& event :
       peers_.poll(moved ? Duration(0) : std::min(wait, looks_.until_due(host_clock_))))
    on_event(event);
  look_at_suts();
}

std::vector<std::string> Coordinator::Impl::peers_of(const Session& session) const {
  std::vector<std::string> peers = radio_.peers_of(session.uav);
  if (controllers_.has(session.uav)) peers.emplace_back(link::kAutopilot);
  return peers;
}

// Called when every SUT has joined. ST and every ET begin at 0.
void Coordinator::Impl::start() {
  stepper_.reset(options_.seed);
  const WallTime now = host_clock_();
  watchdog_.begin(now);
  for (const Session& session : sessions_)
    times_.begin(session.uav, session.hello, session.cores, now);
  const bool repeats = std::ranges::all_of(options_.uavs, [](const UavOptions& uav) {
    return !uav.controller || uav.controller->repeats;
  });
  began_ = now;
  log_.begin(make_header(), repeats && times_.repeats());
  if (options_.real_time_factor > 0.0)
    pace_.emplace(options_.real_time_factor, std::max(kPaceCredit, 2 * grid().dt()), now);
  for (const Session& session : sessions_) computes_from(session.uav, ExecTime{}, now);
  stepper_.act();
  log_.race_again();
  looks_.begin(hooks_.threads_of, now);
  const bool is_free = options_.policy == sync::SyncPolicy::kFreeRunning;
  for (const Session& session : sessions_)
    peers_.send(session.peer,
                link::Welcome{
                    .catalogue = catalogue_of(world(), session, stepper_.has_battery(session.uav)),
                    .free_running = is_free,
                    .start = ExecTime{},
                    .computing = session.time_given(),
                    .peers = peers_of(session),
                    .real_time_factor = is_free ? options_.real_time_factor : 1.0});
}

// Advances ST; false if it must not advance now.
bool Coordinator::Impl::advance() {
  const WallTime now = host_clock_();
  times_.read_timers(now);
  release_ready();
  const SimTime target = paced(next_stop(), now);
  if (target <= st()) return false;
  stepper_.advance_to(target);
  watchdog_.moved(now);
  release_ready();
  watch_flight();
  if (const auto over = watchdog_.over_time(st())) end(*over);
  return true;
}

// An end is far enough ahead that ST, which advances a turn at a time, cannot have passed it.
void Coordinator::Impl::watch_flight() {
  const auto plan = [this](SimTime cause, RunEnd how, std::string reason) {
    const SimTime at = grid().ceil(cause) + kStepsPerTurn * grid().dt();
    ends_.plan(at, {how, std::move(reason)});
  };
  if (const auto exhausted = ends_.is_planned() ? std::nullopt : stepper_.exhausted())
    plan(exhausted->at + kFall, RunEnd::kBatteryEmpty,
         fmt::format("the battery of UAV \"{}\" was empty at ST {:.3f} s",
                     world().uavs[exhausted->uav].name, to_seconds(exhausted->at)));
  if (hooks_.killed)
    if (auto killed = hooks_.killed())
      plan(killed->first, RunEnd::kKilled, std::move(killed->second));
  ends_.reached(st());
}

// How far ST may advance in this turn.
SimTime Coordinator::Impl::next_stop() const {
  return std::min({times_.limit(), watchdog_.st_limit(), ends_.limit(), stepper_.next_due(),
                   next_event_step(), st() + kStepsPerTurn * grid().dt()});
}

// How much of that the pace allows.
SimTime Coordinator::Impl::paced(SimTime target, WallTime now) {
  if (!pace_) return target;
  if (target <= st()) {
    pace_->idle(now);
    return target;
  }
  target = std::min(target, grid().floor(st() + pace_->allowance(now)));
  if (target > st()) pace_->spend(target - st());
  return target;
}

// Limits of WT, status and requests of the caller. No decision of the barrier depends on them.
void Coordinator::Impl::watch() {
  const WallTime now = host_clock_();
  if (!watchdog_.is_due(now)) return;
  if (is_running()) log_.flush(now);
  for (Session& session : sessions_) {
    if (!session.joined()) hear_emulated_start(session, now);
    if (!session.joined() || time_of(session).has_left()) continue;
    const std::uint64_t moved = peers_.moved_bytes(session.peer);
    if (std::exchange(session.moved_bytes, moved) != moved) watchdog_.heard(session.uav, now);
    if (!hooks_.computed_by || session.hello.clock.kind != computer::ClockKind::kCounted) continue;
    const Duration computed = hooks_.computed_by(session.uav);
    if (std::exchange(session.computed, computed) != computed) watchdog_.heard(session.uav, now);
    end_endless(session);
  }
  if (const auto overdue = watchdog_.overdue(parties(now), st())) end(*overdue);
  if (hooks_.on_status) hooks_.on_status(status(now));
  stop_if_asked();
}

// On a busy machine, an emulated program takes long to start. What it has computed is its time.
void Coordinator::Impl::hear_emulated_start(Session& session, WallTime now) {
  if (!hooks_.computed_by) return;
  const Duration computed = hooks_.computed_by(session.uav);
  if (std::exchange(session.computed, computed) != computed && computed < options_.connect_limit)
    watchdog_.heard(session.uav, now);
}

// A counted SUT sends no progress, so ST waits for it. Once it has computed beyond the time limit,
// whatever it requests next is too late, and ST advances to that limit.
void Coordinator::Impl::end_endless(Session& session) {
  constexpr Duration kMostUncharged = std::chrono::seconds(1);  // of the library, around a reply
  Timeline& time = time_of(session);
  const ExecTime bound = time.resumed_at();
  if (std::exchange(session.last_bound, bound) != bound || !time.is_computing())
    session.computed_before = session.computed;
  const auto limit = from_ns<ExecTime>(to_ns(watchdog_.st_limit()));
  const Duration computed = session.computed - session.computed_before - kMostUncharged;
  if (time.is_computing() && bound < limit && computed > limit - bound)
    time.progress({.reached = limit});
}

// A program that waits in small steps computes a little between them, and that is a sign of life.
void Coordinator::Impl::look_at_suts() {
  const auto looks = looks_.look(host_clock_);
  for (int i = 0; !looks.empty() && i < kMostPolls && !ends_.is_over(); ++i) {
    const auto events = peers_.poll(Duration(0));
    if (events.empty()) break;
    for (const link::Event& event : events) on_event(event);
  }
  for (const ThreadLooks::Look& look : looks)
    if (looks_.count(look) > options_.hang_limit)
      end({RunEnd::kSutHung,
           fmt::format("SUT \"{}\" of UAV \"{}\" timed out: after its last call it waited {} s "
                       "(hang_limit_s) on something that Tether does not see",
                       sessions_[look.uav].hello.sut, sessions_[look.uav].uav_name,
                       to_seconds(options_.hang_limit))});
}

void Coordinator::Impl::stop_if_asked() {
  if (ends_.is_over() || !hooks_.should_stop) return;
  if (const auto stop = hooks_.should_stop()) end(*stop);
}

Party Coordinator::Impl::party(const Session& session, WallTime now) const {
  Party party{.sut = session.hello.sut,
              .uav = session.uav_name,
              .joined = session.joined(),
              .computing = time_of(session).is_computing(),
              .bound = time_of(session).et(),
              .silence = watchdog_.silence(session.uav, now),
              .counted = session.hello.clock.kind == computer::ClockKind::kCounted,
              .received_bytes = session.received_bytes,
              .computer = options_.uavs[session.uav].computer,
              .as_is = options_.uavs[session.uav].as_is};
  for (const PendingInteraction& pending : session.open)
    party.reply_at = std::min(party.reply_at.value_or(ExecTime::max()), pending.entry.reply_at);
  return party;
}

std::vector<Party> Coordinator::Impl::parties(WallTime now) const {
  std::vector<Party> parties;
  for (const Session& session : sessions_) parties.push_back(party(session, now));
  return parties;
}

RunStatus Coordinator::Impl::status(WallTime now) const {
  RunStatus status{.st = st(),
                   .et = std::nullopt,
                   .wall = began_ ? now - *began_ : Duration(0),
                   .interactions = log_.footer().interactions,
                   .images = log_.images(),
                   .waiting_for = {},
                   .blocked = ends_.is_over() ? "" : watchdog_.blocked(parties(now), st(), now)};
  for (const Session& session : sessions_)
    if (session.joined()) ++status.joined;
  ExecTime least = ExecTime::max();
  for (const Session& session : sessions_) {
    const auto et = time_of(session).et();
    if (!et) continue;
    status.et = std::max(status.et.value_or(*et), *et);
    if (!time_of(session).is_computing() || *et >= least) continue;
    least = *et;
    status.waiting_for = session.uav_name;
  }
  return status;
}

// Notifies the SUTs that are still connected, then completes the record.
RunReport Coordinator::Impl::close_run() {
  const Ending& ended = ends_.how();
  if (is_running() && ended.how != RunEnd::kSimulatorLost) stepper_.log_contacts();
  if (is_running()) {
    radio_.log_in_transit(st(), grid());
    controllers_.log_in_transit(st(), grid());
  }
  record::Footer& footer = log_.footer();
  RunReport report{.end = ended.how,
                   .reason = ended.seen.empty() ? ended.reason : ended.reason + ": " + ended.seen,
                   .causes_at = ended.reason.size(),
                   .st = st(),
                   .began = is_running(),
                   .wall = began_ ? host_clock_() - *began_ : Duration(0),
                   .interactions = footer.interactions,
                   .images = log_.images(),
                   .causality_violations = footer.causality_violations,
                   .largest_lag = footer.largest_lag,
                   .largest_grid_error = footer.largest_grid_error,
                   .stops = footer.stops,
                   .largest_overshoot = footer.largest_overshoot,
                   .suts = {},
                   .lost_uav = ended.lost_uav};
  for (const Session& session : sessions_) {
    if (session.joined() && !time_of(session).has_left())
      refuse(session.peer, link::Refusal::Reason::kRunEnded, "the run has ended: " + report.reason);
    report.suts.push_back({.uav = session.uav_name,
                           .sut = session.hello.sut,
                           .finish = session.finish,
                           .et = time_of(session).bound(),
                           .looks = looks_.of(session.uav),
                           .unqueued = stepper_.sampler(session.uav).unqueued()});
  }
  if (!is_running()) return report;

  footer.end = name(report.end);
  footer.reason = report.reason;
  footer.st_at_end = st();
  footer.wall = report.wall;
  for (const SutReport& sut : report.suts) footer.et_at_end.push_back(sut.et);
  for (const Session& session : sessions_)
    if (const Timeline& time = time_of(session);
        time.et() && time.facts().loads_one_core() && time.is_computing())
      footer.computing.push_back(session.uav_name);
  if (hooks_.read_target) footer.target_after = hooks_.read_target();
  if (report.end == RunEnd::kRecordFailed) return report;
  try {
    for (const Session& session : sessions_)
      for (const record::Annotation& note : session.notes)
        if (same_instant(note.at) <= st()) log_.annotation(st(), note);
    log_.end();
  } catch (const RecordFailure& e) {
    report.reason = fmt::format("{}; the run ended with: {}", e.what(), report.reason);
    report.end = RunEnd::kRecordFailed;
  }
  return report;
}

}  // namespace tether::coordinator
