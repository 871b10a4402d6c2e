#pragma once

#include <span>

/// Short loops, each mostly of one kind of work, so that the costs of a machine's kinds of work can
/// be told apart.
namespace tether::calibration {

struct Kernel {
  const char* name;
  void (*run)();  ///< a millisecond or so
};

std::span<const Kernel> kernels();

/// The kernel whose operations wait for each other, and how many cycles it takes at least. Its time
/// shows the clock rate, which many machines do not report.
inline constexpr const char* kChain = "integers";
inline constexpr double kCyclesOfChain = 7 * 200'000;

}  // namespace tether::calibration
