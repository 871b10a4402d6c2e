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

/// Facing an anchor on the way: its bearing goes on changing, by speed ÷ distance, so the rotation
/// must not become slower than that.
FaceAnchorOptions facing_under_way();

struct MoveForwardOptions {
  double speed_m_s = 0.3;  ///< > 0
  /// With the anchor further than this from straight ahead, the lower-level task is run; > 0. Its
  /// own goal, `face.precision_rad`, should not be larger.
  double precision_rad = rad_from_deg(2.0);
  bool stop_to_face = false;  ///< the lower-level task stands still, as Algorithm 3 alone does
  /// Of the lower-level task; its convergence and IMU are also this task's.
  FaceAnchorOptions face = facing_under_way();
  /// After the final stop, to come to rest, by the instants of the IMU's readings: until one is so
  /// much younger than the newest at the stop; ≥ 0. 1 s is 20 readings at 20 Hz.
  Duration settle_time = std::chrono::seconds(1);
  Duration time_limit = std::chrono::seconds(180);  ///< of the SUT's clock; then "time limit"
  int max_rounds = 10'000;  ///< of the loop, should that clock stand still; then "round limit"
};

/// Algorithm 4: moves in the direction that the UAV heads to at the start, facing the anchor
/// meanwhile, until it has turned by 90°: then the anchor is abeam of the way.
///
/// While the lower-level task turns it, the UAV keeps its course: "keeping a line of sight" is
/// something that happens on the way (paper, Section III), and a slow computer is then late at the
/// end. With `stop_to_face` it stops for each run, as the two listings say taken together, and a
/// slow computer takes longer.
///
/// An anchor that is not seen is looked for by the lower-level task, standing still; when that
/// gives up, so does this one ("anchor lost", "anchor never seen"). One that cannot be faced within
/// the lower-level task's limits is moved on from.
///
/// Results: "duration_s" (ET, until the final stop), "yaw_turned_rad", "face_anchors" (runs of the
/// lower-level task), "face_anchors_missed" (those that did not reach their goal), "looks" (runs of
/// Algorithm 2, also those of the lower-level task), "overshoots" (of all its runs), "bearing_rad"
/// (the last seen).
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
