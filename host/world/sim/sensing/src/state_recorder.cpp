#include "state_numbers.h"

#include <algorithm>
#include <cassert>

#include <tether/sim_sensing/state_layout.h>

namespace tether::sim {

StateRecorder::StateRecorder(const World& world)
    : layout_(world), joints_(world), past_(layout_.size() - layout_.past_at()) {}

void StateRecorder::reset(std::span<const uav::Pose> X_WB) {
  joints_.reset();
  for (std::size_t i = 0; i < layout_.past_steps(); ++i) begin_step(X_WB);
}

void StateRecorder::begin_step(std::span<const uav::Pose> X_WB) {
  assert(X_WB.size() == layout_.bodies());
  if (layout_.past_steps() == 0) return joints_.step();
  double* out = past_.data() + oldest_ * layout_.row_size();
  for (const uav::Pose& X : X_WB) out = write(X, out);
  std::ranges::copy(joints_.angles_rad(), out);
  joints_.step();
  oldest_ = (oldest_ + 1) % layout_.past_steps();
}

void StateRecorder::capture(std::span<const uav::Pose> X_WB, std::span<const BodyMotion> motions,
                            std::vector<double>& state) const {
  assert(X_WB.size() == layout_.bodies() && motions.size() == layout_.uavs());
  state.resize(layout_.size());
  double* out = state.data();
  for (const uav::Pose& X : X_WB) out = write(X, out);
  for (const BodyMotion& motion : motions) {
    for (const uav::Vec3& v : {motion.w_WB_B, motion.a_WB_W, motion.alpha_WB_B, motion.v_WB_W})
      out = write(v, out);
  }
  out = std::ranges::copy(joints_.angles_rad(), out).out;
  const double* const seam = past_.data() + oldest_ * layout_.row_size();
  const double* const end = past_.data() + past_.size();
  std::copy(past_.data(), seam, std::copy(seam, end, out));
}

}  // namespace tether::sim
