#include "radio_traffic.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace tether::coordinator {

RadioTraffic::RadioTraffic(const radio::Settings& settings, std::uint64_t seed,
                           std::vector<std::string> uavs, RunLog& log)
    : uavs_(std::move(uavs)), medium_(settings, seed, uavs_), boxes_(uavs_.size()), log_(&log) {
  for (Box& box : boxes_) box.of_radio.most = settings.inbox_messages;
}

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
  if (box.is_closed || is_full_for_controller(uav)) return false;
  ++box.of_controller.taken;
  box.inbox.push_back(std::move(message));
  return true;
}

std::optional<Received> RadioTraffic::take_first(std::size_t uav, SimTime latest) {
  Box& box = boxes_[uav];
  if (box.inbox.empty() || box.inbox.front().at > latest) return std::nullopt;
  Received message = std::move(box.inbox.front());
  box.inbox.pop_front();
  return message;
}

std::optional<Received> RadioTraffic::take_next_of_controller(std::size_t uav, SimTime latest) {
  const auto& inbox = boxes_[uav].inbox;
  if (inbox.empty() || inbox.front().from != link::kAutopilot) return std::nullopt;
  return take_first(uav, latest);
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
  Box& receiver = boxes_[arrival.to];
  if (arrival.outcome == radio::Outcome::kDelivered && receiver.of_radio.is_full())
    arrival.outcome = radio::Outcome::kInboxFull;
  log_arrival(st, arrival);
  if (arrival.outcome == radio::Outcome::kQueueFull)
    ++sender.full_queues;
  else
    sender.full_queues -= std::min(sender.full_queues, kDroppedPerQueued);
  if (arrival.outcome != radio::Outcome::kDelivered || receiver.is_closed) return false;
  const radio::Message& message = arrival.message;
  ++receiver.of_radio.taken;
  receiver.inbox.push_back(
      {uavs_[message.from], message.sequence, message.sent_at, arrival.at, message.bytes});
  return true;
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
