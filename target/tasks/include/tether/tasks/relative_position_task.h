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

/// When the tracking counts as converged: for `stable_frames` images in a row the ROI was where it
/// was expected, and as large as before, each within `tolerance_px`.
///
/// Expected is where the ROI would be had it gone on with its last speed (so the first image after
/// a start expects a ROI at rest). So a UAV that turns does not keep the estimate from converging:
/// one with a fast computer moves the ROI by less than the tolerance between two images and needs
/// `stable_frames` + 1 of them; a slow one needs one more, and each takes longer.
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

/// Algorithm 2, "compute relative position": looks at images until the estimate converges. Moves
/// nothing. Results: "duration_s" (ET), "bearing_rad", "distance_m" (if known), "frames".
class RelativePositionTask : public Task {
 public:
  explicit RelativePositionTask(std::string anchor, const RelativePositionOptions& options = {});
  ~RelativePositionTask() override;

  std::string_view name() const override { return "relative_position"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

  /// From the newest image of the last run in which the anchor was seen, converged or not; none:
  /// not seen at all.
  const std::optional<vision::RelativePosition>& estimate() const { return estimate_; }

  /// What that estimate was made from.
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
