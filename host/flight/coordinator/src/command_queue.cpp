#include "command_queue.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace tether::coordinator {

CommandQueue::CommandQueue(StepGrid grid,
                           const std::vector<std::optional<uav::SetpointLoss>>& losses)
    : grid_(grid) {
  for (const auto& loss : losses) {
    flights_.push_back({.loss = loss});
    next_.add();
  }
}

SimTime CommandQueue::push(PendingCommand command) {
  Flight& flight = flights_[command.uav];
  flight.last_arrival = command.arrives_at = std::max(command.arrives_at, flight.last_arrival);
  flight.waiting += command.setpoints.size();
  const auto key = [this](const PendingCommand& c) {
    return std::tuple(grid_.ceil(c.arrives_at), c.uav, c.arrives_at);
  };
  const auto place = std::find_if(commands_.begin(), commands_.end(),
                                  [&](const PendingCommand& c) { return key(c) <= key(command); });
  commands_.insert(place, std::move(command));
  return flight.last_arrival;
}

bool CommandQueue::has_due(const Flight& flight) const {
  return flight.flown && (flight.next < flight.flown->setpoints.size() ||
                          (flight.loss && flight.next == flight.flown->setpoints.size()));
}

// A loss is one nanosecond later than its timeout, so that a command at the timeout is in time.
SimTime CommandQueue::time_of_next(const Flight& flight) const {
  const std::vector<uav::TimedSetpoint>& setpoints = flight.flown->setpoints;
  if (flight.next < setpoints.size())
    return flight.flown->arrives_at + setpoints[flight.next].after;
  return flight.flown->arrives_at + setpoints.back().after + flight.loss->timeout + Duration(1);
}

void CommandQueue::schedule(std::size_t uav) {
  const Flight& flight = flights_[uav];
  next_.set(uav, has_due(flight) ? same_instant(grid_.ceil(time_of_next(flight)))
                                 : sync::LeastTree::kNone);
}

CommandEffect CommandQueue::take_next(std::size_t uav) {
  Flight& flight = flights_[uav];
  const std::vector<uav::TimedSetpoint>& setpoints = flight.flown->setpoints;
  CommandEffect effect{.uav = uav, .sequence = flight.flown->sequence, .setpoint = {}};
  if (flight.next < setpoints.size()) {
    --flight.waiting;
    effect.index = flight.next;
  } else {
    effect.index = setpoints.size() - 1;
    effect.loss = flight.loss->action;
  }
  effect.setpoint = setpoints[effect.index].setpoint;
  ++flight.next;
  schedule(uav);
  return effect;
}

SimTime CommandQueue::next_effect() const {
  const SimTime next = same_instant(next_.least());
  return commands_.empty() ? next : std::min(next, grid_.ceil(commands_.back().arrives_at));
}

// At one instant, a set-point of the trajectory before it takes effect first: whether the command
// is known by then does not matter.
bool CommandQueue::precedes(const PendingCommand& command, std::size_t running) const {
  const SimTime time = time_of_next(flights_[running]);
  return std::tuple(grid_.ceil(command.arrives_at), command.uav, command.arrives_at) <
         std::tuple(grid_.ceil(time), running, time);
}

std::optional<CommandEffect> CommandQueue::pop_due(SimTime st) {
  const bool arrives = !commands_.empty() && grid_.ceil(commands_.back().arrives_at) <= st;
  const bool goes_on = same_instant(next_.least()) <= st;
  if (arrives && (!goes_on || precedes(commands_.back(), next_.first()))) {
    const std::size_t uav = commands_.back().uav;
    Flight& flight = flights_[uav];
    // Joints alone leave what is flown, and do not show that the link is there.
    if (const auto& first = commands_.back().setpoints.front(); !first.setpoint.flies()) {
      CommandEffect effect{
          .uav = uav, .sequence = commands_.back().sequence, .setpoint = first.setpoint};
      --flight.waiting;
      commands_.pop_back();
      return effect;
    }
    if (flight.flown)
      flight.waiting -= std::max(flight.flown->setpoints.size(), flight.next) - flight.next;
    flight.flown = std::move(commands_.back());
    flight.next = 0;
    commands_.pop_back();
    return take_next(uav);
  }
  if (!goes_on) return std::nullopt;
  return take_next(next_.first());
}

}  // namespace tether::coordinator
