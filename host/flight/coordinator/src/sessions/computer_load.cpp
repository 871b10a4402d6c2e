#include "sessions/computer_load.h"

#include <algorithm>

namespace tether::coordinator {

void ComputerLoad::add(SimTime from, SimTime to, double cores) {
  if (to <= from) return;
  if (!uses_.empty() && uses_.back().to == from && uses_.back().cores == cores)
    uses_.back().to = to;
  else
    uses_.push_back({from, to, cores});
}

void ComputerLoad::end(SimTime at) {
  if (uses_.empty() || uses_.back().to < SimTime::max()) return;
  uses_.back().to = at;
  if (at <= uses_.back().from) uses_.pop_back();
}

// Exact where one use covers all of it, however long that is: a record must not depend on how far
// ST advances at once.
double ComputerLoad::mean_cores(SimTime from, SimTime to) {
  while (!uses_.empty() && uses_.front().to <= from) uses_.pop_front();
  double busy_ns = 0.0;
  for (const Use& use : uses_) {
    if (use.from <= from && use.to >= to) return use.cores;
    if (use.from >= to) break;
    const Duration both = std::min(use.to, to) - std::max(use.from, from);
    busy_ns += static_cast<double>(both.count()) * use.cores;
  }
  return busy_ns / static_cast<double>((to - from).count());
}

SimTime ComputerLoad::next_change(SimTime st, const StepGrid& grid) const {
  for (const Use& use : uses_) {
    for (const SimTime edge : {use.from, use.to}) {
      if (edge <= st || edge == SimTime::max()) continue;
      return grid.floor(edge) > st ? grid.floor(edge) : grid.ceil(edge);
    }
  }
  return SimTime::max();
}

}  // namespace tether::coordinator
