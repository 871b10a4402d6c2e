#include "convergence.h"

#include <cmath>

namespace tether::tasks {

bool ConvergenceMonitor::is_as_expected(const vision::Roi& roi, double seconds) const {
  const double u = last_->center.u_px + seconds * speed_px_s_.u_px;
  const double v = last_->center.v_px + seconds * speed_px_s_.v_px;
  const double off = std::hypot(roi.center.u_px - u, roi.center.v_px - v);
  const double grown = std::hypot(roi.width_px - last_->width_px, roi.height_px - last_->height_px);
  return off <= options_.tolerance_px && grown <= options_.tolerance_px;
}

void ConvergenceMonitor::see(SimTime sampled_at, const vision::Roi& roi) {
  if (last_) {
    const double seconds = to_seconds(sampled_at - last_at_);
    stable_ = is_as_expected(roi, seconds) ? stable_ + 1 : 0;
    if (seconds > 0.0) {
      speed_px_s_ = {(roi.center.u_px - last_->center.u_px) / seconds,
                     (roi.center.v_px - last_->center.v_px) / seconds};
    }
  }
  last_ = roi;
  last_at_ = sampled_at;
}

void ConvergenceMonitor::miss() {
  last_.reset();
  speed_px_s_ = {};
  stable_ = 0;
}

}  // namespace tether::tasks
