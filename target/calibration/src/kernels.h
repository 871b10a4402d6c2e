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

}  // namespace tether::calibration
