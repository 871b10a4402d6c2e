#pragma once

#include <optional>

#include <tether/base/time.h>
#include <tether/tasks/paper_tasks.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::tasks {

/// Tells when a sequence of ROIs has converged, by the criterion of ConvergenceOptions.
class ConvergenceMonitor {
 public:
  explicit ConvergenceMonitor(const ConvergenceOptions& options) : options_(options) {}

  /// The next ROI, of an image taken at `sampled_at`.
  void see(SimTime sampled_at, const vision::Roi& roi);
  /// The anchor was not seen: start anew.
  void miss();
  bool has_converged() const { return stable_ >= options_.stable_frames; }

 private:
  bool is_as_expected(const vision::Roi& roi, double seconds) const;

  ConvergenceOptions options_;
  std::optional<vision::Roi> last_;
  SimTime last_at_;
  uav::Pixel speed_px_s_;  ///< of the ROI's centre, over the last two images
  int stable_ = 0;
};

}  // namespace tether::tasks
