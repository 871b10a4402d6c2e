#include "robustness.h"

#include <cstddef>
#include <deque>

namespace tether::judge {

// The least value of each window that begins with an instant, by Lemire's algorithm ("Streaming
// maximum-minimum filter using no more than three comparisons per element", 2006).
std::vector<double> robustness(const Holds& holds, const std::vector<double>& signal,
                               const std::vector<SimTime>& at) {
  std::vector<double> values = signal;
  for (double& value : values) value *= holds.at_most == holds.is_never ? 1.0 : -1.0;
  if (holds.hold == Duration(0)) return values;
  std::vector<double> least(values.size());
  std::deque<std::size_t> candidates;  // to be the least from now on: ascending
  std::size_t next = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (; next < at.size() && at[next] - at[i] <= holds.hold; ++next) {
      while (!candidates.empty() && values[candidates.back()] >= values[next])
        candidates.pop_back();
      candidates.push_back(next);
    }
    while (candidates.front() < i) candidates.pop_front();
    least[i] = values[candidates.front()];
  }
  return least;
}

}  // namespace tether::judge
