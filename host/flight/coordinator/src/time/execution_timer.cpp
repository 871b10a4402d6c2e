#include "time/execution_timer.h"

namespace tether::coordinator {

ExecTime ExecutionTimer::pause(WallTime now) {
  base_et_ = read(now);
  held_ = true;
  return base_et_;
}

void ExecutionTimer::resume(WallTime now, ExecTime at) {
  base_et_ = at;
  base_wall_ = now;
  held_ = false;
}

}  // namespace tether::coordinator
