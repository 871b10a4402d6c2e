#include <ctime>

#include <tether/sim/simulator_work.h>

namespace tether::sim {

Duration CpuTimer::thread_time() {
  ::timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

}  // namespace tether::sim
