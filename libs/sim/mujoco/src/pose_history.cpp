#include "pose_history.h"

#include <algorithm>
#include <cassert>

namespace tether::sim {

PoseHistory::PoseHistory(std::size_t instants, std::size_t numbers)
    : instants_(instants), numbers_(numbers), ring_(instants * numbers) {}

void PoseHistory::fill(std::span<const double> poses) {
  for (std::size_t i = 0; i < instants_; ++i) push(poses);
}

void PoseHistory::push(std::span<const double> poses) {
  assert(poses.size() == numbers_);
  if (instants_ == 0) return;
  std::copy(poses.begin(), poses.end(), ring_.data() + oldest_ * numbers_);
  oldest_ = (oldest_ + 1) % instants_;
}

void PoseHistory::write(double* out) const {
  const double* const seam = ring_.data() + oldest_ * numbers_;
  const double* const end = ring_.data() + ring_.size();
  std::copy(ring_.data(), seam, std::copy(seam, end, out));
}

}  // namespace tether::sim
