#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include <tether/base/time.h>

namespace tether::sync {

/// The least of some times, one for each index: a tournament tree. A change takes a number of steps
/// that is logarithmic in the number of indices. Of equal times, that of the least index is first.
/// Allocates only in `add`. Not thread-safe.
class LeastTree {
 public:
  /// Of an index without a time.
  static constexpr ExecTime kNone = ExecTime::max();

  /// One index more, without a time.
  void add() {
    ++size_;
    if (size_ <= leaves_) return;
    const std::vector<ExecTime> old(nodes_.begin() + static_cast<std::ptrdiff_t>(leaves_),
                                    nodes_.end());
    leaves_ = std::bit_ceil(size_);
    nodes_.assign(2 * leaves_, kNone);
    for (std::size_t i = 0; i < old.size(); ++i) set(i, old[i]);
  }

  void set(std::size_t index, ExecTime time) {
    std::size_t node = leaves_ + index;
    nodes_[node] = time;
    while (node > 1) {
      node /= 2;
      const ExecTime least = std::min(nodes_[2 * node], nodes_[2 * node + 1]);
      if (nodes_[node] == least) return;
      nodes_[node] = least;
    }
  }

  /// kNone if no index has a time.
  ExecTime least() const { return size_ == 0 ? kNone : nodes_[1]; }
  /// Index of the least time. @pre some index has a time.
  std::size_t first() const {
    std::size_t node = 1;
    while (node < leaves_) node = 2 * node + (nodes_[2 * node] <= nodes_[2 * node + 1] ? 0 : 1);
    return node - leaves_;
  }
  /// Least of the times of other indices before `index`, and of those after it.
  struct Others {
    ExecTime before;
    ExecTime after;
    ExecTime least() const { return std::min(before, after); }
  };
  Others others(std::size_t index) const {
    Others others{kNone, kNone};
    for (std::size_t node = leaves_ + index; node > 1; node /= 2) {
      ExecTime& side = node % 2 == 0 ? others.after : others.before;
      side = std::min(side, nodes_[node ^ 1U]);
    }
    return others;
  }

 private:
  std::size_t size_ = 0;
  std::size_t leaves_ = 0;       // a power of two
  std::vector<ExecTime> nodes_;  // the root is 1, the children of n are 2n and 2n + 1
};

}  // namespace tether::sync
