#include "coordinator_impl.h"

#include <algorithm>

#include <fmt/format.h>

/// Events of the radio and of flight controllers: each one is handled in the order of (time, UAV),
/// when ST is at its step, and no SUT can send an earlier one any more. A message that arrives for
/// an open receive makes its reply due at that instant.
namespace tether::coordinator {

std::optional<sync::SutTime> Coordinator::Impl::next_event() const {
  const auto radio = radio_.next(), controller = controllers_.next();
  return !controller || (radio && *radio < *controller) ? radio : controller;
}

// How far ST may advance before something is due here.
SimTime Coordinator::Impl::next_event_step() const {
  const auto next = next_event();
  return next ? std::max(grid().floor(same_instant(next->at)), st()) : SimTime::max();
}

void Coordinator::Impl::settle_events() {
  while (const auto next = next_event()) {
    if (grid().floor(same_instant(next->at)) > st()) return;
    const auto earliest = times_.earliest();
    if (earliest && *next > *earliest) return;
    if (next != controllers_.next()) {
      handle_radio();
    } else if (const auto arrival = controllers_.handle_next(stepper_, radio_)) {
      deliver(sessions_[arrival->uav], same_instant(arrival->at));
    }
  }
}

void Coordinator::Impl::handle_radio() {
  for (const radio::Arrival& arrival :
       radio_.handle_next([this](std::size_t a, std::size_t b) { return stepper_.link(a, b); })) {
    const bool has_arrived = radio_.take(st(), arrival);
    Session& sender = sessions_[arrival.message.from];
    if (const auto flood = radio_.flood_of(sender.uav)) expel(sender, *flood);
    if (has_arrived) deliver(sessions_[arrival.to], same_instant(arrival.at));
  }
}

// The first open receive that waits for a message gets this one: its reply is due at its arrival.
void Coordinator::Impl::deliver(Session& session, ExecTime arrived_at) {
  for (PendingInteraction& pending : session.open) {
    record::Interaction& entry = pending.entry;
    if (!entry.receive_until || pending.received || arrived_at > *entry.receive_until) continue;
    pending.received = radio_.take_first(session.uav, same_instant(arrived_at));
    entry.reply_at = std::max(arrived_at, entry.request_at);
    if (const auto due = time_of(session).move_up(entry.sequence, entry.reply_at))
      peers_.send(session.peer, *due);
    return;
  }
}

// Ends the session of one SUT. The others finish, and then the run ends with the reason.
void Coordinator::Impl::expel(Session& session, const Fault& fault) {
  refuse(session.peer, link::Refusal::Reason::kBadRequest, fault.what);
  ends_.later({RunEnd::kFlooded,
               fmt::format("the SUT of UAV \"{}\" sent {}", session.uav_name, fault.what)});
  log_.footer().expelled.push_back(session.uav_name);
  leave(session);
}

}  // namespace tether::coordinator
