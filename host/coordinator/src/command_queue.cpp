#include "command_queue.h"

#include <algorithm>
#include <utility>

namespace tether::coordinator {

void CommandQueue::push(const PendingCommand& command) {
  const auto place = std::find_if(commands_.begin(), commands_.end(), [&](const PendingCommand& c) {
    return std::pair(c.effect_at, c.uav) <= std::pair(command.effect_at, command.uav);
  });
  commands_.insert(place, command);
  if (waiting_.size() <= command.uav) waiting_.resize(command.uav + 1);
  ++waiting_[command.uav];
}

std::size_t CommandQueue::waiting(std::size_t uav) const {
  return uav < waiting_.size() ? waiting_[uav] : 0;
}

SimTime CommandQueue::next_effect() const {
  return commands_.empty() ? SimTime::max() : commands_.back().effect_at;
}

std::optional<PendingCommand> CommandQueue::pop_due(SimTime st) {
  if (commands_.empty() || commands_.back().effect_at > st) return std::nullopt;
  const PendingCommand command = commands_.back();
  commands_.pop_back();
  --waiting_[command.uav];
  return command;
}

}  // namespace tether::coordinator
