#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tether::sim {

/// Where everything was at the last instants, oldest forgotten first. Allocates at construction
/// only. With no room it keeps nothing and costs nothing.
class PoseHistory {
 public:
  /// Room for `instants` of `numbers` each.
  PoseHistory(std::size_t instants, std::size_t numbers);

  /// As if nothing had moved before. @pre poses.size() is `numbers`, as for `push`.
  void fill(std::span<const double> poses);
  void push(std::span<const double> poses);

  std::size_t instants() const { return instants_; }
  /// How many numbers `write` writes.
  std::size_t size() const { return ring_.size(); }
  /// All instants, oldest first.
  void write(double* out) const;

 private:
  std::size_t instants_;
  std::size_t numbers_;
  std::size_t oldest_ = 0;
  std::vector<double> ring_;
};

}  // namespace tether::sim
