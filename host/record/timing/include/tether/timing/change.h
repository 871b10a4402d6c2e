#pragma once

#include <string>
#include <vector>

#include <tether/timing/timing.h>

namespace tether::timing {

/// How much longer a stage takes than before, by its median. Shares: 0.12 is +12 %.
struct StageChange {
  std::string stage;
  double change = 0.0;
  double low = 0.0, high = 0.0;  ///< bounds of the 95 % interval, by bootstrap
  std::size_t few = 0;           ///< the smaller number of samples, if it is below kFewSamples
};

struct Comparison {
  std::vector<StageChange> stages;   ///< that both have; the largest share of the old one first
  std::vector<std::string> added;    ///< only in the new one
  std::vector<std::string> removed;  ///< only in the old one
  std::string doubt{};               ///< by how much the times can be off; empty: not known
};

/// Pure: draws of the bootstrap are keyed by the stage. Stages whose share of the old computing
/// time is below 0.1 % are left out.
Comparison compare(const Timing& now, const Timing& before);

/// Whether a stage is slower than the limit allows: 0.2 for +20 %.
bool is_beyond(const Comparison& comparison, double limit);

/// A line for each stage. With a limit: how many times slower it may still become.
std::string to_text(const Comparison& comparison, const double* limit);

}  // namespace tether::timing
