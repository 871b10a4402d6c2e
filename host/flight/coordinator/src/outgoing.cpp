#include "coordinator_impl.h"

#include <algorithm>
#include <string>
#include <utility>

/// Replies to SUTs, sent when the barrier releases them.
namespace tether::coordinator {

namespace {

/// None: not an image, or not one to record. Its time is that of its content, not its stamp.
std::optional<uav::CameraSample> image_to_record(Session& session, const link::Request& request,
                                                 const link::Reply& reply, SimTime sampled_at,
                                                 const RunOptions& options) {
  if (!options.record_images || !reply.sample) return std::nullopt;
  const auto* image = std::get_if<uav::CameraSample>(&*reply.sample);
  if (image == nullptr) return std::nullopt;
  auto& last = session.recorded_image_at[std::get<link::ReadSensor>(request.body).sensor];
  if (last && sampled_at < *last + options.image_period) return std::nullopt;
  last = sampled_at;
  std::optional recorded = *image;
  recorded->sampled_at = sampled_at;
  return recorded;
}

}  // namespace

void Coordinator::Impl::release_ready() {
  settle();
  // Other threads draw ahead: while one picture is drawn for its reply, those of other SUTs, and
  // while the SUTs compute, what they will read.
  if (sessions_.size() > 1) stepper_.announce();
  while (const auto grant = times_.release(st(), next_event())) {
    Session& session = sessions_[grant->sut];
    std::size_t i = 0;
    while (session.open[i].entry.sequence != grant->call) ++i;
    session.open[i].entry.reply_at = grant->resume_at;
    reply(session, i, grant->released_at);
    settle();
  }
  stepper_.announce();
}

// A message can end the wait of a program that shares a board, and so change when others have done
// their work; and what these send is known only then.
void Coordinator::Impl::settle() {
  do settle_events();
  while (settle_boards());
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
                      .computing = session.time_given()};
  if (entry.kind == record::kBattery) message.battery = stepper_.read_battery(session.uav, entry);
  if (pending.received) receive(session, pending, message);
  const std::optional<uav::CameraSample> image = image_to_record(
      session, pending.request, message, entry.sample_state_at.value_or(SimTime{}), options_);
  entry.st_at_release = st;
  entry.grid_error = std::max(entry.grid_error, same_instant(entry.reply_at) - st);
  entry.wall_at_release = host_clock_();
  peers_.send(session.peer, std::move(message));
  session.received_bytes = 0;

  watchdog_.heard(session.uav, entry.wall_at_release);
  watchdog_.moved(entry.wall_at_release);
  time_of(session).replied(entry);
  computes_from(session.uav, entry.reply_at, entry.wall_at_release);
  for (record::Annotation& note : session.notes) log_.annotation(st, std::move(note));
  session.notes.clear();
  const bool is_last = entry.kind == record::kFinish;
  const std::string sensor = image ? entry.sensor : "";
  log_.interaction(st, std::move(entry));
  if (image) log_.image(st, session.uav_name, sensor, *image);
  if (is_last) leave(session);
}

// What arrives by the time of the reply has arrived: no earlier message can come any more.
void Coordinator::Impl::receive(const Session& session, PendingInteraction& pending,
                                link::Reply& reply) {
  const auto take = [&](const Received& received) {
    radio_.received(session.uav, received);
    return link::RadioMessage{received.from, received.sent_at, received.at, *received.bytes};
  };
  record::Interaction& entry = pending.entry;
  entry.received = {pending.received->from, pending.received->sequence, pending.received->at};
  reply.message = take(*pending.received);
  if (reply.message->from != link::kAutopilot || session.hello.concurrent) return;
  const std::size_t more = std::get<link::ReceiveMessage>(pending.request.body).most - 1;
  while (reply.more.size() < more) {
    const auto next = radio_.take_next_of_controller(session.uav, same_instant(entry.reply_at));
    if (!next) break;
    reply.more.push_back(take(*next));
  }
  entry.received_more = reply.more.size();
}

// What the threads of a concurrent SUT compute while others wait is not known; what a SUT on a
// shared board computes, its board's time line knows.
void Coordinator::Impl::computes_from(std::size_t uav, ExecTime at, WallTime since) {
  looks_.computes(uav, since);
  if (times_[uav].facts().loads_one_core()) stepper_.begins_computing(uav, same_instant(at));
}

// Drops the other open calls of a concurrent SUT.
void Coordinator::Impl::leave(Session& session) {
  time_of(session).leave();
  radio_.close(session.uav);
  session.open.clear();
  stepper_.close(session.uav);
  stepper_.ends_computing(session.uav, st());
  peers_.close(session.peer);
  if (std::ranges::all_of(sessions_, [&](const Session& s) { return time_of(s).has_left(); }))
    ends_.all_have_finished();
}

}  // namespace tether::coordinator
