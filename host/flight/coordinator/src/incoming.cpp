#include "coordinator_impl.h"
#include "plan.h"
#include "sessions/admission.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <tether/base/text.h>

/// Messages from SUTs: Hello, requests, progress, annotations, and the end of a connection. Each
/// message is validated first; a protocol violation ends the run. A valid request is planned
/// (plan.cpp), held by its Timeline, and answered by release_ready() in outgoing.cpp.
namespace tether::coordinator {

namespace {

record::Annotation annotation_of(const Session& session, const Sent& sent) {
  const auto& note = std::get<link::Annotation>(sent.message);
  return {session.uav_name, sent.at, note.topic, note.json};
}

}  // namespace

void Coordinator::Impl::on_event(const link::Event& event) {
  if (const auto* connected = std::get_if<link::Connected>(&event.what))
    peers_.connected(event.peer, connected->remote_address);
  if (const auto* message = std::get_if<link::Message>(&event.what); message && !ends_.is_over())
    on_message(event.peer, *message);
  if (const auto* closed = std::get_if<link::Closed>(&event.what))
    on_closed(event.peer, closed->failure);
}

void Coordinator::Impl::on_message(link::PeerId peer, const link::Message& message) {
  const auto uav = peers_.uav_of(peer);
  Session* const session = uav ? &sessions_[*uav] : nullptr;
  if (const auto* hello = std::get_if<link::Hello>(&message); hello && !session)
    return join(peer, *hello);
  if (!session)
    return refuse(peer, link::Refusal::Reason::kBadMessage, "the first message must be a Hello");
  if (time_of(*session).has_left()) return;
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
  peers_.close(session.peer);
  peers_.forget(session.peer);
  time_of(session).leave();
  end({RunEnd::kSutLost, fmt::format("the SUT of UAV \"{}\" ended the run: {}", session.uav_name,
                                     printable(refusal.message))});
}

// Ends the run because of a protocol violation.
void Coordinator::Impl::break_off(Session& session, link::Refusal::Reason reason,
                                  const Fault& fault) {
  refuse(session.peer, reason, fault.what);
  time_of(session).leave();
  end({RunEnd::kSutLost,
       fmt::format("the SUT of UAV \"{}\" sent {}", session.uav_name, fault.what)});
}

// Its Finish has arrived, and it is stopped. Nothing that it still does can change the result, so
// it may disconnect before or after ST has caught up.
bool Coordinator::Impl::awaits_only_confirmation(const Session& session) const {
  const link::Request* next = time_of(session).unsettled();
  if (next && std::holds_alternative<link::Finish>(next->body)) return true;
  return session.finish && !time_of(session).is_computing();
}

void Coordinator::Impl::on_closed(link::PeerId peer, const Failure& failure) {
  const bool is_disconnected = failure.kind == Failure::Kind::kDisconnected;
  const auto uav = peers_.uav_of(peer);
  if (!uav && !is_disconnected) peers_.report(peer, failure.message);
  peers_.forget(peer);
  if (!uav || times_[*uav].has_left()) return;
  const Session& session = sessions_[*uav];
  if (is_disconnected && awaits_only_confirmation(session)) return;
  const Party lost = party(session, host_clock_());
  const std::string where = lost.bound ? describe_state(lost) + "; " : "";
  end({RunEnd::kSutLost, fmt::format("lost the SUT of UAV \"{}\"", session.uav_name),
       where + failure.message, session.uav_name});
}

void Coordinator::Impl::join(link::PeerId peer, const link::Hello& hello) {
  std::vector<bool> taken;
  for (const Session& session : sessions_) taken.push_back(session.joined());
  const auto admitted = admit(hello, options_.token, radio_.uavs(), taken);
  if (const auto* refusal = std::get_if<link::Refusal>(&admitted))
    return refuse(peer, refusal->reason, refusal->message);

  Session& session = sessions_[std::get<std::size_t>(admitted)];
  if (const auto fault = clock_fault(hello, options_.uavs[session.uav].clock))
    return refuse(peer, link::Refusal::Reason::kBadRequest, *fault);
  if (const auto fault = times_.fault_of(session.uav, hello))
    return refuse(peer, link::Refusal::Reason::kBadRequest, *fault);
  if (const auto fault = build_fault(hello, session.replay.get()))
    return refuse(peer, link::Refusal::Reason::kBadRequest, *fault);
  session.peer = peer;
  peers_.joined(peer, session.uav);
  session.hello = hello;
  session.hello.token.clear();
  session.hello.sut = printable(hello.sut);
  if (hooks_.on_joined) hooks_.on_joined(session.uav, peers_.address(peer), hello.process);
  watchdog_.moved(host_clock_());
  if (peers_.count_joined() == sessions_.size()) start();
}

void Coordinator::Impl::on_progress(Session& session, const link::Progress& progress,
                                    WallTime now) {
  if (!is_running() || !is_stamp(progress.reached)) return;
  if (const auto fault = fault_of(progress, standing(session), now))
    return break_off(session, link::Refusal::Reason::kBadMessage, *fault);
  if (const auto stop = time_of(session).progress(progress))
    log_.stop(st(), {session.uav_name, stop->at, stop->due, now});
  release_ready();
}

void Coordinator::Impl::on_annotation(Session& session, const link::Annotation& note) {
  if (const auto fault = session.annotations.spend(note))
    return break_off(session, link::Refusal::Reason::kBadMessage, *fault);
  if (const auto sent = time_of(session).send({note, st(), WallTime{}, session.uav}))
    return log_.annotation(st(), annotation_of(session, *sent));
  release_ready();
}

Standing Coordinator::Impl::standing(const Session& session) const {
  const Timeline& time = time_of(session);
  const int cores = session.cores > 0 ? session.cores : sync::kMostCores;
  return {.running = is_running(),
          .concurrent = session.hello.concurrent,
          .finished = session.finish.has_value(),
          .held = time.is_held(),
          .bound = time.last_stamp(),
          .open_calls = session.open.size() + (time.unsettled() ? 1U : 0U),
          .received_bytes = session.received_bytes,
          .next_sequence = session.next_sequence,
          .st = st(),
          .calls_in_step = time.calls_at(st()),
          .waiting_setpoints = stepper_.waiting_setpoints(session.uav),
          .uavs = radio_.uavs(),
          .uav = session.uav,
          .sensors = stepper_.sampler(session.uav),
          .has_battery = stepper_.has_battery(session.uav),
          .limits = session.limits,
          .has_controller = controllers_.has(session.uav),
          .plausibility = time.plausibility(),
          .clock_cores = session.hello.clock.adds_up_cores() ? cores : 0};
}

void Coordinator::Impl::on_request(Session& session, const link::Request& request, WallTime now) {
  // The Finish of one thread ends a concurrent SUT; later requests of its other threads are
  // dropped.
  if (session.hello.concurrent && session.finish) return;
  if (const auto fault = fault_of(request, standing(session), now))
    return break_off(session, link::Refusal::Reason::kBadRequest, *fault);
  if (const auto* send = std::get_if<link::SendMessage>(&request.body);
      send != nullptr && send->to != link::kAutopilot)
    if (const auto flood = radio_.spend(session.uav, st(), send->bytes.size()))
      return expel(session, *flood);
  if (session.replay) check_replay(session, request);
  if (ends_.is_over()) return;
  ++session.next_sequence;
  if (auto sent = time_of(session).send({request, st(), now, session.uav})) {
    begin(std::move(*sent));
    stepper_.act();
  }
  release_ready();
}

// Handles the messages whose instant is known only now.
bool Coordinator::Impl::settle_boards() {
  const bool has_changed =
      times_.settle([this] { return next_event(); },
                    [this](std::size_t uav, ExecTime from, ExecTime to, double cores) {
                      stepper_.computes(uav, same_instant(from), same_instant(to), cores);
                    },
                    [this](Sent sent) {
                      Session& session = sessions_[sent.uav];
                      if (std::holds_alternative<link::Annotation>(sent.message))
                        session.notes.push_back(annotation_of(session, sent));
                      else
                        begin(std::move(sent));
                    });
  if (has_changed) stepper_.act();
  return has_changed;
}

// The SUT does what it did when its time was recorded. Its timestamp follows from the time given.
void Coordinator::Impl::check_replay(Session& session, const link::Request& request) {
  const auto* read = std::get_if<link::ReadSensor>(&request.body);
  const std::string call =
      read ? stepper_.sampler(session.uav).name(read->sensor) : kind_of(request);
  ExecTime due = time_of(session).resumed_at();
  for (const link::StageTime& time : request.stages) due += time.computing;
  std::optional<std::string> difference = session.replay->take(call, request.stages);
  if (!difference && due != request.issued_at)
    difference = fmt::format("call \"{}\" at ET {} ns instead of the {} ns given", call,
                             to_ns(request.issued_at), to_ns(due));
  if (!difference) return;
  refuse(session.peer, link::Refusal::Reason::kBadRequest, *difference);
  time_of(session).leave();
  end({RunEnd::kTimingDiffers,
       fmt::format("the SUT of UAV \"{}\" differs from the timing file at {}", session.uav_name,
                   *difference)});
}

// Plans a request and holds its reply.
void Coordinator::Impl::begin(Sent sent) {
  Session& session = sessions_[sent.uav];
  PendingInteraction pending = arrive(session, std::move(sent), time_of(session));
  record::Interaction& entry = pending.entry;
  stepper_.ends_computing(session.uav, same_instant(entry.request_at));
  entry.reply_at = plan(session, pending, {stepper_, radio_, controllers_});
  if (const auto due = time_of(session).hold(entry)) peers_.send(session.peer, *due);
  session.open.push_back(std::move(pending));
}

}  // namespace tether::coordinator
