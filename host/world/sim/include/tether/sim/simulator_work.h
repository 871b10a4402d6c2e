#pragma once

#include <cstdint>

#include <tether/base/time.h>
#include <tether/os/clock.h>

namespace tether::sim {

/// What a simulator has computed since its last reset. The times, and how often the forecasts of
/// `Simulator::expect` were right, may differ between two runs with the same record.
struct SimulatorWork {
  Duration stepping{0};             ///< CPU time of steps
  Duration drawing{0};              ///< CPU time of pictures, of all threads
  std::uint64_t pictures = 0;       ///< drawn, those in vain among them
  std::uint64_t drawn_ahead = 0;    ///< of these, begun before they were asked for
  std::uint64_t drawn_in_vain = 0;  ///< of these, not asked for

  friend bool operator==(const SimulatorWork&, const SimulatorWork&) = default;
};

/// Measures the CPU time of the thread that it is used on.
class CpuTimer {
 public:
  Duration elapsed() const { return os::read_clock(CLOCK_THREAD_CPUTIME_ID) - begin_; }

 private:
  Duration begin_ = os::read_clock(CLOCK_THREAD_CPUTIME_ID);
};

}  // namespace tether::sim
