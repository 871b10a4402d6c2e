#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace tether::stl {

enum class Extremum { kMin, kMax };

/// The indices first … last, inclusive; empty if first > last.
struct Window {
  std::size_t first = 1;
  std::size_t last = 0;

  bool is_empty() const { return first > last; }
};

/// The values of a window that can still be an extremum, the best first. A ring that grows.
class Wedge {
 public:
  template <class Beats>
  void push(std::size_t index, double value, const Beats& beats) {
    while (end_ != begin_ && !beats(at(end_ - 1).value, value)) --end_;
    if (end_ - begin_ == entries_.size()) grow();
    at(end_++) = {value, index};
  }
  void drop_before(std::size_t index) {
    while (begin_ != end_ && at(begin_).index < index) ++begin_;
  }
  double best() { return at(begin_).value; }

 private:
  struct Entry {
    double value;
    std::size_t index;
  };
  Entry& at(std::size_t place) { return entries_[place & (entries_.size() - 1)]; }
  void grow() {
    std::vector<Entry> larger(2 * entries_.size());
    for (std::size_t i = begin_; i != end_; ++i) larger[i & (larger.size() - 1)] = at(i);
    entries_ = std::move(larger);
  }

  std::vector<Entry> entries_ = std::vector<Entry>(64);
  std::size_t begin_ = 0, end_ = 0;
};

/// Writes the extremum of `values` in each window to `found`; of an empty one the neutral element:
/// +∞ of kMin, −∞ of kMax. Lemire's algorithm: linear in the number of values and windows.
/// @param offset index of the first value, as the windows count them.
/// @param window_of the window of found[i]; called with i = 0, 1, ….
/// @pre both ends of the windows that are not empty never decrease, and `values` has them.
template <class WindowOf>
void slide(Extremum extremum, std::span<const double> values, std::size_t offset,
           WindowOf&& window_of, std::span<double> found) {
  constexpr double kNeutral = std::numeric_limits<double>::infinity();
  const auto run = [&](double neutral, const auto& beats) {
    if (found.size() == 1) {  // what is asked most, without a wedge
      const Window window = window_of(0);
      double best = neutral;
      for (std::size_t i = window.first; i <= window.last; ++i)
        best = beats(values[i - offset], best) ? values[i - offset] : best;
      found[0] = best;
      return;
    }
    Wedge wedge;
    std::size_t next = 0;  // first value that has not been in the wedge
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Window window = window_of(i);
      found[i] = neutral;
      if (window.is_empty()) continue;
      wedge.drop_before(window.first);
      for (next = next < window.first ? window.first : next; next <= window.last; ++next)
        wedge.push(next, values[next - offset], beats);
      found[i] = wedge.best();
    }
  };
  if (extremum == Extremum::kMin)
    run(kNeutral, [](double a, double b) { return a < b; });
  else
    run(-kNeutral, [](double a, double b) { return a > b; });
}

}  // namespace tether::stl
