#include "coordinator_impl.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <tether/link/codec.h>

/// Messages between UAVs. The medium handles its events in the order of (time, UAV): each one when
/// ST is at its step, and no SUT can send an earlier one any more. A message that arrives for an
/// open receive makes its reply due at that instant.
namespace tether::coordinator {

std::vector<std::string> Coordinator::Impl::names_of_uavs() const {
  std::vector<std::string> names;
  for (const sim::Uav& uav : world().uavs) names.push_back(uav.name);
  return names;
}

std::vector<std::string> Coordinator::Impl::peers_of(const Session& session) const {
  std::vector<std::string> peers = uav_names_;
  peers.erase(peers.begin() + static_cast<std::ptrdiff_t>(session.uav));
  return peers;
}

// --- requests -----------------------------------------------------------------------------------

void Coordinator::Impl::accept_send(const Session& session, const record::Interaction& entry,
                                    const link::SendMessage& send) {
  radio::Message message{.from = session.uav,
                         .sequence = entry.sequence,
                         .sent_at = same_instant(entry.request_at),
                         .bytes = std::make_shared<const std::vector<std::uint8_t>>(send.bytes)};
  if (!send.to.empty())
    message.to = static_cast<std::size_t>(
        std::ranges::find(sessions_, send.to, &Session::uav_name) - sessions_.begin());
  medium_.send(std::move(message));
}

ExecTime Coordinator::Impl::accept_receive(Session& session, PendingInteraction& pending,
                                           const link::ReceiveMessage& receive) {
  record::Interaction& entry = pending.entry;
  const ExecTime last = from_ns<ExecTime>(link::kMaxTimestampNs - 1);
  entry.receive_until =
      receive.timeout < last - entry.request_at ? entry.request_at + receive.timeout : last;
  pending.is_promised = session.inbox.size() > session.promised;
  if (!pending.is_promised) return *entry.receive_until;
  ++session.promised;
  return entry.request_at;
}

// --- events -------------------------------------------------------------------------------------

std::optional<sync::SutTime> Coordinator::Impl::next_arrival() const {
  const auto next = medium_.next();
  if (!next) return std::nullopt;
  return sync::SutTime{same_instant(next->at), next->uav};
}

// How far ST may advance before something is due here.
SimTime Coordinator::Impl::next_radio() const {
  const auto next = medium_.next();
  return next ? std::max(grid().floor(next->at), st()) : SimTime::max();
}

void Coordinator::Impl::settle_radio() {
  while (const auto next = next_arrival()) {
    if (grid().floor(same_instant(next->at)) > st()) return;
    const auto earliest = times_.earliest();
    if (earliest && *next > *earliest) return;
    arrivals_.clear();
    medium_.handle_next([this](std::size_t a, std::size_t b) { return stepper_.link(a, b); },
                        arrivals_);
    for (radio::Arrival& arrival : arrivals_) take_arrival(arrival);
  }
}

void Coordinator::Impl::take_arrival(radio::Arrival& arrival) {
  Session& receiver = sessions_[arrival.to];
  if (arrival.outcome == radio::Outcome::kDelivered &&
      receiver.inbox.size() >= options_.radio.inbox_messages)
    arrival.outcome = radio::Outcome::kInboxFull;
  log_arrival(arrival);
  count_full_queue(arrival);
  if (arrival.outcome != radio::Outcome::kDelivered || time_of(receiver).has_left()) return;
  const ExecTime arrived_at = same_instant(arrival.at);
  receiver.inbox.push_back(std::move(arrival));
  for (PendingInteraction& pending : receiver.open)
    if (pending.entry.receive_until && !pending.is_promised &&
        arrived_at <= *pending.entry.receive_until)
      return promise(receiver, pending, std::max(arrived_at, pending.entry.request_at));
}

// The reply to an open call is due already at `reply_at`.
void Coordinator::Impl::promise(Session& session, PendingInteraction& pending, ExecTime reply_at) {
  pending.is_promised = true;
  ++session.promised;
  pending.entry.reply_at = reply_at;
  if (const auto due = time_of(session).move_up(pending.entry.sequence, reply_at))
    server_->send(session.peer, *due);
}

// Takes the first message of the inbox.
void Coordinator::Impl::receive(Session& session, record::Interaction& entry, link::Reply& reply,
                                const std::vector<Session>& sessions) {
  const radio::Arrival arrival = std::move(session.inbox.front());
  session.inbox.pop_front();
  --session.promised;
  const std::string& from = sessions[arrival.message.from].uav_name;
  entry.received = {from, arrival.message.sequence, arrival.at};
  reply.message = {from, arrival.message.sent_at, arrival.at, *arrival.message.bytes};
}

// --- floods -------------------------------------------------------------------------------------

void Coordinator::Impl::count_full_queue(const radio::Arrival& arrival) {
  Session& sender = sessions_[arrival.message.from];
  constexpr std::size_t kDroppedPerQueued = 9;  // that a radio may be overloaded by for ever
  if (arrival.outcome != radio::Outcome::kQueueFull) {
    sender.full_queues -= std::min(sender.full_queues, kDroppedPerQueued);
  } else if (!time_of(sender).has_left() && ++sender.full_queues > kMaxFullQueues) {
    expel(sender, {Fault::Kind::kFlood,
                   fmt::format("more than {} messages beyond ten times what its radio could send",
                               kMaxFullQueues)});
  }
}

// Ends the session of one SUT. The others finish, and then the run ends with the reason.
void Coordinator::Impl::expel(Session& session, const Fault& fault) {
  refuse(session.peer, link::Refusal::Reason::kBadRequest, fault.what);
  if (!expelled_)
    expelled_ = {RunEnd::kFlooded,
                 fmt::format("the SUT of UAV \"{}\" sent {}", session.uav_name, fault.what)};
  log_.footer().expelled.push_back(session.uav_name);
  leave(session);
}

// --- the record ---------------------------------------------------------------------------------

// A SUT may have sent a message at an ET that ST has not reached when the run ends early: such a
// message, like the call that sent it, has not happened.
void Coordinator::Impl::log_in_transit() {
  for (const radio::Arrival& arrival : medium_.in_transit(st()))
    if (grid().floor(arrival.message.sent_at) <= st()) log_arrival(arrival);
}

void Coordinator::Impl::log_arrival(const radio::Arrival& arrival) {
  const auto& [message, to, outcome, began_at, at, link, snr_db] = arrival;
  record::RadioMessage entry{.uav = sessions_[message.from].uav_name,
                             .sequence = message.sequence,
                             .to = sessions_[to].uav_name,
                             .bytes = message.bytes->size(),
                             .sent_at = message.sent_at,
                             .at = at,
                             .outcome = std::string(name(outcome)),
                             .began_at = began_at,
                             .snr_db = snr_db};
  if (link) {
    entry.distance_m = link->distance_m;
    entry.walls = static_cast<std::uint64_t>(link->walls);
  }
  log_.radio(st(), std::move(entry));
}

}  // namespace tether::coordinator
