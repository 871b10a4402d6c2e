#pragma once

#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/base/units.h>
#include <tether/tasks/face_anchor_task.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/relative_position_task.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

/// Options for facing an anchor while moving: its bearing changes by speed ÷ distance, so the
/// rotation must not become slower than that.
FaceAnchorOptions facing_under_way();

struct MoveForwardOptions {
  double speed_m_s = 0.3;  ///< > 0
  /// The lower-level task runs if the anchor's bearing exceeds this; > 0. Its goal,
  /// `face.precision_rad`, should not be larger.
  double precision_rad = rad_from_deg(2.0);
  bool stop_to_face = false;  ///< hover during the lower-level task, as Algorithm 3 alone does
  /// For the lower-level task; its convergence and IMU are also used by this task.
  FaceAnchorOptions face = facing_under_way();
  /// Pause after the final stop, by the timestamps of the IMU's readings, while the UAV comes to
  /// rest; ≥ 0. 1 s is 20 readings at 20 Hz.
  Duration settle_time = std::chrono::seconds(1);
  Duration time_limit = std::chrono::seconds(180);  ///< of the SUT's clock; then "time limit"
  int max_rounds = 10'000;  ///< of the loop, in case that clock is stopped; then "round limit"
};

/// Algorithm 4: moves in the direction of the start heading and faces the anchor on the way, until
/// the UAV has turned by 90°. The anchor is then abeam.
///
/// The UAV keeps its course while the lower-level task turns it: it keeps a line of sight on the
/// way (paper, Section III), and overshoots if the computer is slow. With `stop_to_face` it stops
/// for each run, as the two listings together do, and takes longer if the computer is slow.
///
/// If the anchor is not seen, the lower-level task hovers and searches for it; if that fails, this
/// task ends ("anchor lost", "anchor never seen"). If the anchor cannot be faced within the limits
/// of the lower-level task, the UAV moves on.
///
/// Results: "duration_s" (ET, until the final stop), "yaw_turned_rad", "face_anchors" (runs of the
/// lower-level task), "face_anchors_missed" (those that did not reach their goal), "looks" (runs of
/// Algorithm 2, also those of the lower-level task), "overshoots" (of all its runs), "bearing_rad"
/// (the last one measured).
class MoveForwardTask : public Task {
 public:
  explicit MoveForwardTask(std::string anchor, const MoveForwardOptions& options = {});

  std::string_view name() const override { return "move_forward"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  Progress look(TaskContext& context, bool& is_ahead);
  Progress face_anchor(TaskContext& context);
  Progress update_yaw(TaskContext& context);
  Status settle(TaskContext& context, const TaskOutcome& outcome);

  std::string anchor_;
  MoveForwardOptions options_;
  LoopLimit limit_;
  RelativePositionTask relative_position_;

  // Of the current run.
  double starting_yaw_rad_ = 0.0;
  bool in_sight_ = false;              ///< the anchor, at the last look
  double yaw_turned_rad_ = 0.0;        ///< since the start, in (−π, π]
  std::optional<double> bearing_rad_;  ///< the last one seen
  int face_anchors_ = 0;
  int missed_ = 0;
  int looks_ = 0;
  double overshoots_ = 0.0;
};

}  // namespace tether::tasks
