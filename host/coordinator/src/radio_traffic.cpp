#include "radio_traffic.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace tether::coordinator {

RadioTraffic::RadioTraffic(const radio::Settings& settings, std::uint64_t seed,
                           std::vector<std::string> uavs, RunLog& log)
    : inbox_messages_(settings.inbox_messages),
      uavs_(std::move(uavs)),
      medium_(settings, seed, uavs_),
      boxes_(uavs_.size()),
      log_(&log) {}

std::vector<std::string> RadioTraffic::peers_of(std::size_t uav) const {
  std::vector<std::string> peers = uavs_;
  peers.erase(peers.begin() + static_cast<std::ptrdiff_t>(uav));
  return peers;
}

void RadioTraffic::send(std::size_t uav, std::uint64_t sequence, SimTime at,
                        const link::SendMessage& message) {
  radio::Message sent{.from = uav,
                      .sequence = sequence,
                      .sent_at = at,
                      .bytes = std::make_shared<const std::vector<std::uint8_t>>(message.bytes)};
  if (!message.to.empty())
    sent.to = static_cast<std::size_t>(std::ranges::find(uavs_, message.to) - uavs_.begin());
  medium_.send(sent);
}

bool RadioTraffic::accept(std::size_t uav, Received message) {
  Box& box = boxes_[uav];
  if (box.is_closed || is_full(uav)) return false;
  box.inbox.push_back(std::move(message));
  return true;
}

bool RadioTraffic::promise(std::size_t uav) {
  Box& box = boxes_[uav];
  if (box.inbox.size() <= box.promised) return false;
  ++box.promised;
  return true;
}

void RadioTraffic::receive(std::size_t uav, record::Interaction& entry, link::Reply& reply) {
  Box& box = boxes_[uav];
  const Received& message = box.inbox.front();
  entry.received = {message.from, message.sequence, message.at};
  reply.message = {message.from, message.sent_at, message.at, *message.bytes};
  box.inbox.pop_front();
  --box.promised;
}

std::optional<sync::SutTime> RadioTraffic::next() const {
  const auto next = medium_.next();
  if (!next) return std::nullopt;
  return sync::SutTime{same_instant(next->at), next->uav};
}

std::vector<radio::Arrival> RadioTraffic::handle_next(const radio::Medium::LinkOf& link_of) {
  std::vector<radio::Arrival> arrivals;
  medium_.handle_next(link_of, arrivals);
  return arrivals;
}

bool RadioTraffic::take(SimTime st, radio::Arrival arrival) {
  constexpr std::size_t kDroppedPerQueued = 9;  // that a radio may be overloaded by for ever
  Box& sender = boxes_[arrival.message.from];
  if (arrival.outcome == radio::Outcome::kDelivered && is_full(arrival.to))
    arrival.outcome = radio::Outcome::kInboxFull;
  log_arrival(st, arrival);
  if (arrival.outcome == radio::Outcome::kQueueFull)
    ++sender.full_queues;
  else
    sender.full_queues -= std::min(sender.full_queues, kDroppedPerQueued);
  if (arrival.outcome != radio::Outcome::kDelivered) return false;
  const radio::Message& message = arrival.message;
  return accept(arrival.to, {uavs_[message.from], message.sequence, message.sent_at, arrival.at,
                             message.bytes});
}

std::optional<Fault> RadioTraffic::flood_of(std::size_t uav) const {
  if (boxes_[uav].is_closed || boxes_[uav].full_queues <= kMaxFullQueues) return std::nullopt;
  return Fault{Fault::Kind::kFlood,
               fmt::format("more than {} messages beyond ten times what its radio could send",
                           kMaxFullQueues)};
}

// A SUT may have sent a message at an ET that ST has not reached when the run ends early: such a
// message, like the call that sent it, has not happened.
void RadioTraffic::log_in_transit(SimTime st, const StepGrid& grid) {
  for (const radio::Arrival& arrival : medium_.in_transit(st))
    if (grid.floor(arrival.message.sent_at) <= st) log_arrival(st, arrival);
}

void RadioTraffic::log_arrival(SimTime st, const radio::Arrival& arrival) {
  const auto& [message, to, outcome, began_at, at, link, snr_db] = arrival;
  record::RadioMessage entry{.uav = uavs_[message.from],
                             .sequence = message.sequence,
                             .to = uavs_[to],
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
  log_->radio(st, std::move(entry));
}

}  // namespace tether::coordinator
