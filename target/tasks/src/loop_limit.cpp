#include <tether/tasks/task.h>

namespace tether::tasks {

void LoopLimit::start(ExecTime now) {
  started_at_ = now;
  rounds_ = 0;
}

Progress LoopLimit::next_round(ExecTime now) {
  if (elapsed(now) > time_limit_) return TaskOutcome::not_reached("time limit");
  if (++rounds_ > max_rounds_) return TaskOutcome::not_reached("round limit");
  return std::nullopt;
}

}  // namespace tether::tasks
