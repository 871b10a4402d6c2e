#include "admission.h"
#include "coordinator_impl.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <tether/base/printable.h>

/// Messages from SUTs: Hello, requests, progress, annotations, and the end of a connection. Each
/// message is validated first; a protocol violation ends the run. A valid request is planned
/// (accept), held at the barrier, and answered by release_ready() in outgoing.cpp.
namespace tether::coordinator {

namespace {

/// In the order of Request's body.
constexpr const char* kKinds[] = {"sensor", "command", "sleep",  "finish",
                                  "send",   "receive", "battery"};

}  // namespace

Session* Coordinator::Impl::find(link::PeerId peer) {
  const auto joined = joined_.find(peer);
  return joined == joined_.end() ? nullptr : &sessions_[joined->second];
}

void Coordinator::Impl::refuse(link::PeerId peer, link::Refusal::Reason reason,
                               const std::string& message) {
  if (hooks_.on_refused && reason != link::Refusal::Reason::kRunEnded)
    hooks_.on_refused(remote_[peer], printable(message));
  server_->send(peer, link::Refusal{reason, printable(message)});
  server_->close(peer);
  remote_.erase(peer);  // no more events from it
}

void Coordinator::Impl::on_event(const link::Event& event) {
  if (const auto* connected = std::get_if<link::Connected>(&event.what))
    remote_[event.peer] = connected->remote_address;
  if (const auto* message = std::get_if<link::Message>(&event.what); message && !ended_)
    on_message(event.peer, *message);
  if (const auto* closed = std::get_if<link::Closed>(&event.what))
    on_closed(event.peer, closed->failure);
}

void Coordinator::Impl::on_message(link::PeerId peer, const link::Message& message) {
  Session* session = find(peer);
  if (const auto* hello = std::get_if<link::Hello>(&message); hello && !session)
    return join(peer, *hello);
  if (!session)
    return refuse(peer, link::Refusal::Reason::kBadMessage, "the first message must be a Hello");
  if (session->left) return;
  const WallTime now = host_clock_();
  if (shows_life(message, standing(*session), session->hello.clock.kind))
    watchdog_.heard(session->uav, now);
  const auto* progress = std::get_if<link::Progress>(&message);
  session->received_bytes = progress ? progress->received_bytes : 0;
  if (session->received_bytes > 0) return;
  if (const auto* request = std::get_if<link::Request>(&message))
    return on_request(*session, *request, now);
  if (progress) return on_progress(*session, *progress, now);
  if (const auto* note = std::get_if<link::Annotation>(&message))
    return on_annotation(*session, *note);
  if (const auto* refusal = std::get_if<link::Refusal>(&message))
    return on_refusal(*session, *refusal);
  break_off(*session, link::Refusal::Reason::kBadMessage, fault_of_other(message));
}

// The SUT's side cannot go on, and says why.
void Coordinator::Impl::on_refusal(Session& session, const link::Refusal& refusal) {
  server_->close(session.peer);
  remote_.erase(session.peer);
  session.left = true;
  end({RunEnd::kSutLost, fmt::format("the SUT of UAV \"{}\" ended the run: {}", session.uav_name,
                                     printable(refusal.message))});
}

// Ends the run because of a protocol violation.
void Coordinator::Impl::break_off(Session& session, link::Refusal::Reason reason,
                                  const Fault& fault) {
  refuse(session.peer, reason, fault.what);
  session.left = true;
  end({RunEnd::kSutLost,
       fmt::format("the SUT of UAV \"{}\" sent {}", session.uav_name, fault.what)});
}

// Its Finish has arrived, and it is stopped. Nothing that it still does can change the result, so
// it may disconnect before or after ST has caught up.
bool Coordinator::Impl::awaits_only_confirmation(const Session& session) const {
  if (boards_.has_finish(session.uav)) return true;
  return session.finish && !is_computing(session);
}

void Coordinator::Impl::on_closed(link::PeerId peer, const Failure& failure) {
  const Session* session = find(peer);
  if (!session && hooks_.on_refused && failure.kind != Failure::Kind::kDisconnected)
    hooks_.on_refused(remote_[peer], failure.message);
  remote_.erase(peer);
  if (!session || session->left) return;
  if (failure.kind == Failure::Kind::kDisconnected && awaits_only_confirmation(*session)) return;
  const std::string where =
      running_ && is_synchronised() ? describe_state(party(*session, host_clock_())) + "; " : "";
  end({RunEnd::kSutLost, fmt::format("lost the SUT of UAV \"{}\"", session->uav_name),
       where + failure.message});
}

void Coordinator::Impl::join(link::PeerId peer, const link::Hello& hello) {
  std::vector<bool> taken;
  for (const Session& session : sessions_) taken.push_back(session.joined());
  const auto admitted = admit(hello, options_.token, uav_names_, taken);
  if (const auto* refusal = std::get_if<link::Refusal>(&admitted))
    return refuse(peer, refusal->reason, refusal->message);

  Session& session = sessions_[std::get<std::size_t>(admitted)];
  if (const auto fault = clock_fault(hello, options_.uavs[session.uav].clock))
    return refuse(peer, link::Refusal::Reason::kBadRequest, *fault);
  if (!hello.concurrent && stops_with_others(session.uav))
    return refuse(peer, link::Refusal::Reason::kBadRequest,
                  "the SUT shares its board with others, so it must be stopped together with them: "
                  "start all of them under tether-exec --group");
  if (const auto fault = build_fault(hello, session.replay))
    return refuse(peer, link::Refusal::Reason::kBadRequest, *fault);
  session.peer = peer;
  joined_[peer] = session.uav;
  session.hello = hello;
  session.hello.token.clear();
  session.hello.sut = printable(hello.sut);
  if (hooks_.on_joined) hooks_.on_joined(session.uav, remote_[peer], hello.process);
  watchdog_.moved(host_clock_());
  if (joined_.size() == sessions_.size()) start();
}

void Coordinator::Impl::on_progress(Session& session, const link::Progress& progress,
                                    WallTime now) {
  if (!running_ || !is_synchronised() || !is_stamp(progress.reached)) return;
  if (session.timer) return;  // its time is the coordinator's, not the client's
  if (const auto fault = fault_of(progress, standing(session), now))
    return break_off(session, link::Refusal::Reason::kBadMessage, *fault);
  if (progress.stopped) return on_stop(session, progress, now);
  if (boards_.shares(session.uav)) {
    if (!is_computing(session)) return;
    boards_.progress(session.uav, own_work(session, progress.reached));
  } else {
    barrier_.progress(session.uav, progress.reached);
  }
  release_ready();
}

void Coordinator::Impl::on_annotation(Session& session, const link::Annotation& note) {
  if (const auto fault = session.annotations.spend(note))
    return break_off(session, link::Refusal::Reason::kBadMessage, *fault);
  if (boards_.shares(session.uav) && is_computing(session)) {
    boards_.add(session.uav, {note, own_work(session, note.at), st(), host_clock_()});
    return release_ready();
  }
  log_.annotation(st(), {session.uav_name, note.at, note.topic, note.json});
}

// The timestamp of the reply that caused a stop. No reply is sent before the SUT has stopped for
// it, so it is one of the open calls that are due, and that the SUT knew to be due.
std::optional<ExecTime> Coordinator::Impl::earliest_due(const Session& session,
                                                        const link::Progress& stop) {
  std::optional<ExecTime> earliest;
  for (const PendingInteraction& pending : session.open)
    if (const ExecTime reply_at = pending.entry.reply_at;
        reply_at <= stop.reached && pending.moved_due <= stop.dues_heard)
      earliest = std::min(earliest.value_or(reply_at), reply_at);
  return earliest;
}

// A concurrent SUT is stopped: replies that are due by then can be sent. It reports the same stop
// again if a message has moved up the reply that it waits for.
void Coordinator::Impl::on_stop(Session& session, const link::Progress& stop, WallTime now) {
  const ExecTime at = stop.reached;
  if (std::exchange(session.stopped_at, at) != at)
    log_.stop(st(), {session.uav_name, at, earliest_due(session, stop), now});
  barrier_.stop(session.uav, at, stop.dues_heard >= session.newest_moved_due);
  release_ready();
}

Standing Coordinator::Impl::standing(const Session& session) const {
  const bool adds_up_cores = session.hello.clock.kind == computer::ClockKind::kCpu;
  const int cores = session.cores > 0 ? session.cores : sync::kMostCores;
  return {.running = running_,
          .synchronised = is_synchronised(),
          .concurrent = session.is_concurrent(),
          .finished = session.finish.has_value(),
          .held = running_ && barrier_.is_held(session.uav),
          .bound = boards_.shares(session.uav) ? session.own_bound
                   : running_                  ? barrier_.bound(session.uav)
                                               : ExecTime{},
          .open_calls = session.open.size() + (boards_.has_request(session.uav) ? 1U : 0U),
          .received_bytes = session.received_bytes,
          .next_sequence = session.next_sequence,
          .st = st(),
          .calls_in_step = st() > session.called_at ? 0 : session.calls_in_step,
          .waiting_commands = stepper_.waiting_commands(session.uav),
          .uavs = uav_names_,
          .uav = session.uav,
          .sensors = stepper_.sampler(session.uav),
          .has_battery = stepper_.has_battery(session.uav),
          .plausibility = session.plausibility ? &*session.plausibility : nullptr,
          .clock_cores = adds_up_cores ? cores : 0};
}

void Coordinator::Impl::on_request(Session& session, const link::Request& request, WallTime now) {
  // The Finish of one thread ends a concurrent SUT; later requests of its other threads are
  // dropped.
  if (session.is_concurrent() && session.finish) return;
  if (const auto fault = fault_of(request, standing(session), now))
    return break_off(session, link::Refusal::Reason::kBadRequest, *fault);
  if (const auto* send = std::get_if<link::SendMessage>(&request.body))
    if (const auto flood = session.radio_budget.spend(st(), send->bytes.size()))
      return expel(session, *flood);
  if (session.replay) check_replay(session, request);
  if (ended_) return;
  ++session.next_sequence;
  if (boards_.shares(session.uav)) {
    boards_.add(session.uav, {request, own_work(session, request.issued_at), st(), now});
  } else {
    begin(session, {request, st(), now});
    stepper_.act();
  }
  release_ready();
}

// What a SUT on a shared board computed until `stamp`, as if alone. Not less than before.
Duration Coordinator::Impl::own_work(Session& session, ExecTime stamp) {
  session.own_bound = std::max(session.own_bound, stamp);
  return session.own_bound - session.resumed_at;
}

// Handles the messages whose instant is known now, and tells the barrier how far the boards are.
// Whether anything has changed: another pool may go on then, or a message arrive.
bool Coordinator::Impl::settle_boards() {
  bool has_changed = false;
  for (std::size_t pool = 0; pool < boards_.pools(); ++pool)
    has_changed = settle_pool(pool) || has_changed;
  if (has_changed) stepper_.act();
  return has_changed;
}

bool Coordinator::Impl::settle_pool(std::size_t pool) {
  const auto used = [this](std::size_t uav, ExecTime from, ExecTime to, double cores) {
    stepper_.computes(uav, same_instant(from), same_instant(to), cores);
  };
  bool has_changed = false;
  while (const auto sent = boards_.next(pool, undisturbed_until(pool), used)) {
    has_changed = true;
    Session& session = sessions_[sent->uav];
    if (const auto* note = std::get_if<link::Annotation>(&sent->what.message)) {
      session.notes.push_back({session.uav_name, sent->at, note->topic, note->json});
      continue;
    }
    const auto& request = std::get<link::Request>(sent->what.message);
    begin(session, {request, sent->what.st, sent->what.wall, sent->at, sent->what.work});
    if (session.finish)
      boards_.leave(sent->uav);
    else
      boards_.resume(sent->uav, session.open.back().entry.reply_at);
  }
  for (const std::size_t uav : boards_.suts_of(pool)) {
    const ExecTime before = barrier_.bound(uav);
    barrier_.progress(uav, boards_.bound(uav));
    has_changed = has_changed || barrier_.bound(uav) != before;
  }
  return has_changed;
}

// Until when no message from outside can end the wait of a SUT of the pool: when the next one may
// arrive, or be sent and arrive. What the pool's own SUTs send is known at their stamps, beyond
// which its time line does not go on before that is handled.
ExecTime Coordinator::Impl::undisturbed_until(std::size_t pool) const {
  const auto is_open = [](const PendingInteraction& pending) {
    return pending.entry.receive_until && !pending.is_promised;
  };
  ExecTime until = ExecTime::max();
  const bool receives = std::ranges::any_of(boards_.suts_of(pool), [&](std::size_t uav) {
    return std::ranges::any_of(sessions_[uav].open, is_open);
  });
  if (!receives) return until;
  if (const auto next = next_arrival()) until = next->at;
  for (const Session& other : sessions_)
    if (!other.left && !boards_.is_in(pool, other.uav))
      until = std::min(until, barrier_.bound(other.uav) + radio::least_delay(options_.radio));
  return until;
}

// The SUT does what it did when its time was recorded. Its timestamp follows from the time given.
void Coordinator::Impl::check_replay(Session& session, const link::Request& request) {
  const auto* read = std::get_if<link::ReadSensor>(&request.body);
  const std::string call =
      read ? stepper_.sampler(session.uav).name(read->sensor) : kKinds[request.body.index()];
  ExecTime due = session.resumed_at;
  for (const link::StageTime& time : request.stages) due += time.computing;
  std::optional<std::string> difference = session.replay->take(call, request.stages);
  if (!difference && due != request.issued_at)
    difference = fmt::format("call \"{}\" at ET {} ns instead of the {} ns given", call,
                             to_ns(request.issued_at), to_ns(due));
  if (!difference) return;
  refuse(session.peer, link::Refusal::Reason::kBadRequest, *difference);
  session.left = true;
  end({RunEnd::kTimingDiffers,
       fmt::format("the SUT of UAV \"{}\" differs from the timing file at {}", session.uav_name,
                   *difference)});
}

std::vector<link::StageTime> Coordinator::Impl::time_given(const Session& session) {
  return session.replay ? session.replay->given() : std::vector<link::StageTime>();
}

// Plans a request and holds its reply. A concurrent SUT receives the time of its reply at once, so
// that its other threads can run until then.
void Coordinator::Impl::begin(Session& session, const Arrived& arrived) {
  PendingInteraction pending{.request = arrived.request, .entry = make_entry(session, arrived)};
  record::Interaction& entry = pending.entry;
  entry.request_at = charge(session, arrived, entry);
  stepper_.ends_computing(session.uav, same_instant(entry.request_at));
  session.calls_in_step = st() > session.called_at ? 1 : session.calls_in_step + 1;
  session.called_at = st();
  entry.reply_at = accept(session, pending);
  if (is_synchronised()) {
    const bool receives = entry.kind == record::kReceive;
    barrier_.hold({session.uav, entry.reply_at, entry.sequence,
                   receives ? std::optional(radio::least_delay(options_.radio)) : std::nullopt});
    if (session.is_concurrent()) {
      ++session.dues_sent;
      server_->send(session.peer, link::Due{entry.sequence, entry.reply_at});
    }
  }
  session.open.push_back(std::move(pending));
}

record::Interaction Coordinator::Impl::make_entry(const Session& session,
                                                  const Arrived& arrived) const {
  const link::Request& request = arrived.request;
  record::Interaction entry;
  entry.uav = session.uav_name;
  entry.sequence = request.sequence;
  entry.kind = kKinds[request.body.index()];
  entry.st_at_arrival = arrived.st;
  entry.wall_at_arrival = arrived.wall;
  entry.computed = arrived.computed;
  entry.stamped = !session.timer && is_synchronised();
  if (entry.stamped)
    for (const link::StageTime& time : request.stages)
      entry.stages.push_back({.stage = printable(time.stage),
                              .computing = time.computing,
                              .is_unknown = session.replay && !session.replay->knows(time.stage)});
  // Not for several threads: their calls overlap, so the last hold may belong to another call.
  if (!session.is_concurrent() && request.previous_round_trip > Duration(0) &&
      session.last_hold > Duration(0))
    entry.previous_link_time = request.previous_round_trip - session.last_hold;
  return entry;
}

// The timestamp of a request: the SUT's, or the coordinator's timer for an unstamped client, or ST
// in free running.
ExecTime Coordinator::Impl::charge(Session& session, const Arrived& arrived,
                                   record::Interaction& entry) {
  if (!is_synchronised()) return same_instant(st());
  const ExecTime stamp = session.timer ? session.timer->pause(arrived.wall)
                                       : arrived.sent_at.value_or(arrived.request.issued_at);
  const sync::Arrival arrival = barrier_.arrive(session.uav, stamp, arrived.st);
  entry.lag = arrival.lag;
  Duration behind = arrival.violation ? arrival.violation->size : Duration(0);
  if (arrived.computed) behind = session.resumed_at + *arrived.computed - arrived.request.issued_at;
  if (behind > Duration(0))
    entry.violation = fmt::format(
        "{} by {} ns", name(sync::CausalityViolation::Kind::kRequestInThePast), behind.count());
  return arrival.charged_at;
}

// Plans the interaction; returns the timestamp of its reply.
ExecTime Coordinator::Impl::accept(Session& session, PendingInteraction& pending) {
  const link::Request& request = pending.request;
  if (const auto* read = std::get_if<link::ReadSensor>(&request.body))
    return accept_read(session, pending, *read);
  if (const auto* set = std::get_if<link::SetVelocity>(&request.body))
    return accept_command(session, pending, *set);
  if (const auto* sleep = std::get_if<link::Sleep>(&request.body)) {
    const ExecTime until = sleep->is_relative
                               ? pending.entry.request_at + (sleep->until - request.issued_at)
                               : sleep->until;
    pending.entry.sleep_until = until;
    return std::max(pending.entry.request_at, until);
  }
  if (const auto* send = std::get_if<link::SendMessage>(&request.body)) {
    accept_send(session, pending.entry, *send);
    return pending.entry.request_at;
  }
  if (const auto* receive = std::get_if<link::ReceiveMessage>(&request.body))
    return accept_receive(session, pending, *receive);
  if (std::holds_alternative<link::ReadBattery>(request.body)) return pending.entry.request_at;
  session.finish = std::get<link::Finish>(request.body);
  session.finish->outcome = printable(session.finish->outcome);
  return pending.entry.request_at;
}

// The reply to a read without a measurement is due at once.
ExecTime Coordinator::Impl::accept_read(Session& session, PendingInteraction& pending,
                                        const link::ReadSensor& read) {
  record::Interaction& entry = pending.entry;
  entry.sensor = stepper_.sampler(session.uav).name(read.sensor);
  entry.latest = read.latest;
  entry.only_if_available = read.only_if_available;
  const auto measurement =
      stepper_.plan(session.uav, entry.sequence, read, same_instant(entry.request_at));
  if (!measurement) return entry.request_at;

  entry.sample_index = measurement->index;
  entry.sampled_at = measurement->sampled_at;
  entry.available_at = measurement->available_at;
  return std::max(entry.request_at, same_instant(measurement->available_at));
}

ExecTime Coordinator::Impl::accept_command(Session& session, PendingInteraction& pending,
                                           const link::SetVelocity& set) {
  const SimTime effect = same_instant(pending.entry.request_at) + session.command_latency;
  pending.entry.effect_at =
      stepper_.command(session.uav, pending.entry.sequence, set.command, effect);
  const auto& [velocity, yaw_rate] = set.command;
  pending.entry.command = {velocity.x, velocity.y, velocity.z, yaw_rate};
  pending.entry.grid_error = *pending.entry.effect_at - effect;
  return pending.entry.request_at;
}

}  // namespace tether::coordinator
