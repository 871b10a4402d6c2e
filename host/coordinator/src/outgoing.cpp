#include "coordinator_impl.h"

#include <algorithm>
#include <string>
#include <utility>

/// Replies to SUTs, sent when the barrier releases them.
namespace tether::coordinator {

void Coordinator::Impl::release_ready() {
  settle();
  if (!is_synchronised()) return answer_free_running();
  // Other threads draw ahead: while one picture is drawn for its reply, those of other SUTs, and
  // while the SUTs compute, what they will read.
  if (sessions_.size() > 1) stepper_.announce();
  while (const auto grant = barrier_.release(st(), next_arrival())) {
    Session& session = sessions_[grant->sut];
    std::size_t i = 0;
    while (session.open[i].entry.sequence != grant->call) ++i;
    reply(session, i, grant->released_at);
    settle();
  }
  stepper_.announce();
}

// A message can end the wait of a program that shares a board, and so change when others have done
// their work; and what these send is known only then.
void Coordinator::Impl::settle() {
  do settle_radio();
  while (settle_boards());
}

// In free running: when a sleep or a receive ends, unless a message has arrived.
std::optional<SimTime> Coordinator::Impl::waits_until(const PendingInteraction& pending) const {
  const record::Interaction& entry = pending.entry;
  if (pending.is_promised || !(entry.receive_until || entry.sleep_until)) return std::nullopt;
  return grid().ceil(same_instant(entry.receive_until ? *entry.receive_until : *entry.sleep_until));
}

// In free running, how far ST may advance before one of these ends.
SimTime Coordinator::Impl::next_wake() const {
  SimTime due = SimTime::max();
  if (is_synchronised()) return due;
  for (const Session& session : sessions_)
    for (const PendingInteraction& pending : session.open)
      due = std::min(due, waits_until(pending).value_or(due));
  return due;
}

// In free running, only what waits in ST is not answered at once: sleeps, receives, and reads that
// wait for the next measurement of their sensor.
void Coordinator::Impl::answer_free_running() {
  for (Session& session : sessions_) {
    for (std::size_t i = 0; i < session.open.size();) {
      PendingInteraction& pending = session.open[i];
      const Sampler::Read* read = stepper_.sampler(session.uav).find(pending.entry.sequence);
      if (waits_until(pending) > st() || (read && !read->state)) {
        ++i;
        continue;
      }
      pending.entry.reply_at = same_instant(st());
      reply(session, i, st());
    }
  }
}

// Sends the reply before it is recorded, so that recording costs the SUT no wall time.
void Coordinator::Impl::reply(Session& session, std::size_t open_index, SimTime st) {
  const auto place = session.open.begin() + static_cast<std::ptrdiff_t>(open_index);
  PendingInteraction pending = std::move(*place);
  session.open.erase(place);
  record::Interaction& entry = pending.entry;

  link::Reply message{.sequence = entry.sequence,
                      .resume_at = entry.reply_at,
                      .sample = stepper_.measure(session.uav, entry),
                      .computing = time_given(session)};
  if (entry.kind == record::kBattery) message.battery = stepper_.read_battery(session.uav, entry);
  if (pending.is_promised) receive(session, entry, message, sessions_);
  const std::optional<uav::CameraSample> image = image_to_record(session, pending.request, message);
  entry.st_at_release = st;
  entry.grid_error = std::max(entry.grid_error, same_instant(entry.reply_at) - st);
  entry.wall_at_release = host_clock_();
  server_->send(session.peer, std::move(message));
  session.received_bytes = 0;

  session.last_hold = entry.wall_at_release - entry.wall_at_arrival;
  watchdog_.heard(session.uav, entry.wall_at_release);
  watchdog_.moved(entry.wall_at_release);
  computes_from(session, entry.reply_at);
  session.computes_since = entry.wall_at_release;
  session.waited_before = session.looks.waiting;
  if (session.timer) session.timer->resume(entry.wall_at_release, entry.reply_at);
  // A CPU clock adds what child processes computed during the call.
  if (session.plausibility)
    session.plausibility->go_on(barrier_.bound(session.uav),
                                session.hello.clock.kind == computer::ClockKind::kCpu
                                    ? entry.wall_at_arrival
                                    : entry.wall_at_release);
  for (record::Annotation& note : session.notes) log_.annotation(st, std::move(note));
  session.notes.clear();
  const bool is_last = entry.kind == record::kFinish;
  const std::string sensor = image ? entry.sensor : "";
  log_.interaction(st, std::move(entry));
  if (image) log_.image(st, session.uav_name, sensor, *image);
  if (is_last) leave(session);
}

std::optional<uav::CameraSample> Coordinator::Impl::image_to_record(
    Session& session, const link::Request& request, const link::Reply& reply) const {
  if (!options_.record_images || !reply.sample) return std::nullopt;
  const auto* image = std::get_if<uav::CameraSample>(&*reply.sample);
  if (image == nullptr) return std::nullopt;
  auto& last = session.recorded_image_at[std::get<link::ReadSensor>(request.body).sensor];
  if (last && image->sampled_at < *last + options_.image_period) return std::nullopt;
  last = image->sampled_at;
  return *image;
}

// What the threads of a concurrent SUT compute while others wait is not known; what a SUT on a
// shared board computes, its board's time line knows.
void Coordinator::Impl::computes_from(Session& session, ExecTime at) {
  session.resumed_at = session.own_bound = at;
  if (!session.is_concurrent() && !boards_.shares(session.uav))
    stepper_.begins_computing(session.uav, same_instant(at));
}

// Drops the other open calls of a concurrent SUT.
void Coordinator::Impl::leave(Session& session) {
  session.left = true;
  session.open.clear();
  stepper_.close(session.uav);
  stepper_.ends_computing(session.uav, st());
  barrier_.remove(session.uav);
  server_->close(session.peer);
  if (std::all_of(sessions_.begin(), sessions_.end(), [](const Session& s) { return s.left; }))
    end(expelled_.value_or(Ending{RunEnd::kFinished, "every SUT has finished"}));
}

}  // namespace tether::coordinator
