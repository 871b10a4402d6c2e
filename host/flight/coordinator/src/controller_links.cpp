#include "controller_links.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tether/base/error.h>
#include <tether/link/messages.h>

namespace tether::coordinator {
namespace {

constexpr double kBitsOfByte = 10.0;
constexpr Duration kBuffer = std::chrono::seconds(1);
// From the boundary of a step to what the controller does.
constexpr Duration kAfterBoundary{1};

}  // namespace

std::optional<SimTime> Line::send(SimTime at, std::size_t bytes) {
  second_.add(at, bytes);
  if (second_.has_too_many() || second_.has_too_much()) return std::nullopt;
  if (baud_ <= 0.0) return at + latency_;
  const SimTime begins = std::max(at, free_at_);
  if (begins - at > kBuffer) return std::nullopt;
  free_at_ = begins + Duration(static_cast<std::int64_t>(
                          std::ceil(static_cast<double>(bytes) * kBitsOfByte * 1e9 / baud_)));
  return free_at_ + latency_;
}

ControllerLinks::ControllerLinks(const RunOptions& options, std::vector<std::string> uavs,
                                 Stepper& stepper, RunLog& log)
    : uavs_(std::move(uavs)), log_(&log) {
  const auto has_one = [](const UavOptions& uav) { return uav.controller.has_value(); };
  if (std::ranges::any_of(options.uavs, has_one)) stepper.reset(options.seed);
  for (const UavOptions& uav : options.uavs) {
    Port& port = ports_.emplace_back();
    steps_.add();
    arrivals_.add();
    if (!uav.controller) continue;
    port.controller = uav.controller->make();
    port.controller->boot(stepper.sense_at_rest(ports_.size() - 1));
    port.period = uav.controller->period;
    port.to_controller = port.to_companion =
        Line(uav.controller->link_baud, uav.controller->link_latency);
    schedule(ports_.size() - 1);
  }
}

void ControllerLinks::send(std::size_t uav, std::uint64_t sequence, SimTime at,
                           const std::vector<std::uint8_t>& bytes) {
  Port& port = ports_[uav];
  Message message{.sequence = sequence,
                  .sent_at = at,
                  .arrives_at = at,
                  .bytes = std::make_shared<const std::vector<std::uint8_t>>(bytes)};
  const auto arrives_at = port.to_controller.send(at, bytes.size());
  message.is_lost = !arrives_at;
  message.arrives_at = arrives_at.value_or(at);
  port.for_controller.push_back(std::move(message));
}

std::optional<sync::SutTime> ControllerLinks::next() const {
  const ExecTime step = steps_.least(), arrival = arrivals_.least();
  if (step == sync::LeastTree::kNone) return std::nullopt;
  return step <= arrival ? sync::SutTime{step, 0} : sync::SutTime{arrival, arrivals_.first()};
}

std::optional<ControllerLinks::Arrival> ControllerLinks::handle_next(Stepper& stepper,
                                                                     RadioTraffic& inboxes) {
  if (steps_.least() <= arrivals_.least()) {
    step(steps_.first(), stepper);
    return std::nullopt;
  }
  const std::size_t uav = arrivals_.first();
  Port& port = ports_[uav];
  const Message message = std::move(port.for_companion.front());
  port.for_companion.pop_front();
  schedule(uav);
  const SimTime at = message.arrives_at;
  log(stepper.st(), uav, Direction::kFrom, message,
      inboxes.is_full_for_controller(uav) ? record::kInboxFull : record::kDelivered);
  const bool has_arrived =
      inboxes.accept(uav, {link::kAutopilot, message.sequence, message.sent_at, at, message.bytes});
  return has_arrived ? std::optional(Arrival{uav, at}) : std::nullopt;
}

void ControllerLinks::step(std::size_t uav, Stepper& stepper) {
  Port& port = ports_[uav];
  const SimTime at = port.next_step();
  ++port.steps;
  std::vector<autopilot::Bytes> received;
  std::vector<Message> taken;
  while (!port.for_controller.empty() && port.for_controller.front().arrives_at <= at) {
    taken.push_back(std::move(port.for_controller.front()));
    port.for_controller.pop_front();
    if (!taken.back().is_lost) received.push_back(*taken.back().bytes);
  }
  const autopilot::Sensed sensed = stepper.sense(uav);
  autopilot::Actions actions = [&] {
    try {
      return port.controller->step(sensed, received);
    } catch (const Error& e) {
      log_taken(at, uav, taken, {});
      throw SimulatorFailure(e.what());
    }
  }();
  log_taken(at, uav, taken, actions.refused);
  for (autopilot::Bytes& bytes : actions.of_station)
    log(at, uav, Direction::kOfStation,
        {.sequence = ++port.of_station,
         .sent_at = at,
         .arrives_at = at,
         .bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes))},
        record::kDelivered, at);
  if (actions.setpoint) stepper.fly(uav, *actions.setpoint);
  const SimTime sent_at = at + kAfterBoundary;
  for (autopilot::Bytes& bytes : actions.sent) {
    Message message{.sequence = ++port.sent,
                    .sent_at = sent_at,
                    .arrives_at = sent_at,
                    .bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes))};
    if (const auto arrives_at = port.to_companion.send(sent_at, message.bytes->size())) {
      message.arrives_at = *arrives_at;
      port.for_companion.push_back(std::move(message));
    } else {
      log(at, uav, Direction::kFrom, message, record::kQueueFull);
    }
  }
  schedule(uav);
}

void ControllerLinks::log_taken(SimTime at, std::size_t uav, const std::vector<Message>& taken,
                                const std::vector<autopilot::Actions::Refusal>& refused) {
  std::size_t received = 0;
  auto refusal = refused.begin();
  for (const Message& message : taken) {
    if (message.is_lost) {
      log(at, uav, Direction::kTo, message, record::kQueueFull);
    } else if (refusal != refused.end() && refusal->received == received++) {
      log(at, uav, Direction::kTo, message, (refusal++)->why);
    } else {
      log(at, uav, Direction::kTo, message, record::kDelivered, at);
    }
  }
}

void ControllerLinks::schedule(std::size_t uav) {
  const Port& port = ports_[uav];
  steps_.set(uav, same_instant(port.next_step() + kAfterBoundary));
  arrivals_.set(uav, port.for_companion.empty()
                         ? sync::LeastTree::kNone
                         : same_instant(port.for_companion.front().arrives_at));
}

// What was sent in a step that ST has not reached has not happened (as by radio).
void ControllerLinks::log_in_transit(SimTime st, const StepGrid& grid) {
  for (std::size_t uav = 0; uav < ports_.size(); ++uav) {
    for (const Message& message : ports_[uav].for_controller)
      if (grid.floor(message.sent_at) <= st)
        log(st, uav, Direction::kTo, message,
            message.is_lost ? record::kQueueFull : record::kWaiting);
    for (const Message& message : ports_[uav].for_companion)
      log(st, uav, Direction::kFrom, message, record::kWaiting);
  }
}

void ControllerLinks::log(SimTime st, std::size_t uav, Direction direction, const Message& message,
                          std::string_view outcome, std::optional<SimTime> acted_at) {
  std::uint64_t part = 0;
  for (autopilot::Decoded& decoded : autopilot::decode(*message.bytes))
    log_->link(st, {.uav = uavs_[uav],
                    .to_controller = direction == Direction::kTo,
                    .sequence = message.sequence,
                    .part = part++,
                    .bytes = message.bytes->size(),
                    .sent_at = message.sent_at,
                    .at = message.arrives_at,
                    .acted_at = acted_at,
                    .outcome = std::string(outcome),
                    .name = std::move(decoded.name),
                    .fields = std::move(decoded.fields_json),
                    .of_station = direction == Direction::kOfStation});
}

}  // namespace tether::coordinator
