#pragma once

#include <memory>
#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>
#include <tether/uav/samples.h>
#include <tether/vision/anchor_tracker.h>
#include <tether/vision/relative_position.h>

namespace tether::tasks {

/// Tracking has converged when the ROI was at its predicted position and had its previous size,
/// within `tolerance_px`, in `stable_frames` consecutive images.
///
/// The prediction continues the ROI's last speed (at first 0), so that an estimate converges while
/// the UAV turns. With a fast computer the ROI moves by less than the tolerance between two images,
/// and `stable_frames` + 1 images are enough; a slow computer needs one more, and longer for each.
struct ConvergenceOptions {
  double tolerance_px = 8.0;
  int stable_frames = 2;
  int max_frames = 12;  ///< then: not reached, "did not converge"
  int max_unseen_frames =
      4;  ///< images in a row without the anchor; then: not reached, "anchor not seen"
};

struct RelativePositionOptions {
  ConvergenceOptions convergence;
  Duration time_limit = std::chrono::seconds(60);  ///< of the SUT's clock; then "time limit"
};

/// Algorithm 2, "compute relative position": reads images until the estimate converges. Sends no
/// command. Results: "duration_s" (ET), "bearing_rad", "distance_m" (if known), "frames".
class RelativePositionTask : public Task {
 public:
  explicit RelativePositionTask(std::string anchor, const RelativePositionOptions& options = {});
  ~RelativePositionTask() override;

  std::string_view name() const override { return "relative_position"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

  /// From the last image of the last run in which the anchor was seen, converged or not; none if it
  /// was never seen.
  const std::optional<vision::RelativePosition>& estimate() const { return estimate_; }

  /// The image and region of that estimate.
  struct Sighting {
    uav::CameraSample image;
    vision::Roi roi;
  };
  const std::optional<Sighting>& sighting() const { return sighting_; }

 private:
  struct Loop;
  Progress prepare(TaskContext& context);
  Progress look(TaskContext& context, uav::CameraSample image);
  Progress miss();

  std::string anchor_;
  RelativePositionOptions options_;
  LoopLimit limit_;
  std::unique_ptr<Loop> loop_;  ///< state of the task loop, new for each run
  std::optional<vision::RelativePosition> estimate_;
  std::optional<Sighting> sighting_;
};

}  // namespace tether::tasks
