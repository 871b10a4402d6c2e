#pragma once

#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/base/units.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/relative_position_task.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

/// Level flight that continues while the UAV turns.
struct Course {
  double yaw_rad = 0.0;    ///< its direction, counter-clockwise from east
  double speed_m_s = 0.0;  ///< ≥ 0
};

struct FaceAnchorOptions {
  double precision_rad = rad_from_deg(1.5);    ///< goal: |bearing| ≤ this; > 0
  double yaw_rate_rad_s = rad_from_deg(25.0);  ///< initial; > 0
  double slowdown = 0.5;  ///< factor of the yaw rate at each overshoot; in (0, 1]
  double min_yaw_rate_rad_s = rad_from_deg(2.0);  ///< minimum; > 0
  ConvergenceOptions convergence;
  std::optional<Course> course;   ///< while the anchor is in sight; none: hovers
  std::string imu = "imu";        ///< for the heading; only used with a course
  bool search_clockwise = false;  ///< direction of the turn until the anchor is first seen
  Duration lost_limit =
      std::chrono::seconds(20);  ///< without seeing the anchor; then "anchor lost"
  Duration time_limit = std::chrono::seconds(60);  ///< of the SUT's clock; then "time limit"
  int max_looks = 10'000;  ///< runs of Algorithm 2, in case that clock is stopped; "round limit"
};

/// Algorithm 3, "face anchor": turns until the anchor is in the middle of the image. An overshoot
/// reverses the rotation and slows it down. If the anchor is out of sight, the UAV hovers and turns
/// to search for it. With a course, the UAV moves on while it turns to a visible anchor. At the end
/// it no longer turns. Results: "overshoots", "duration_s" (ET), "looks" (runs of Algorithm 2),
/// "yaw_rate_rad_s" (the last), "bearing_rad" (the last one measured).
class FaceAnchorTask : public Task {
 public:
  explicit FaceAnchorTask(std::string anchor, const FaceAnchorOptions& options = {});

  /// In the last run: the last measured bearing [rad], if any.
  const std::optional<double>& bearing_rad() const { return bearing_rad_; }
  /// In the last run: whether the anchor was in the last image.
  bool is_in_sight() const { return in_sight_; }
  /// In the last run: runs of Algorithm 2.
  int looks() const { return looks_; }
  /// In the last run: whether it ended because the anchor was out of sight for too long.
  bool has_lost_anchor() const { return lost_; }

  std::string_view name() const override { return "face_anchor"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  Progress look(TaskContext& context, std::optional<double>& bearing_rad);
  Progress turn_to(TaskContext& context, std::string_view phase, double direction,
                   std::string_view event);
  Status turn(TaskContext& context, double yaw_rate_rad_s) const;
  Progress keep_turning(TaskContext& context);
  Progress hold_course(TaskContext& context);
  Progress keep_searching(TaskContext& context);

  FaceAnchorOptions options_;
  LoopLimit limit_;
  RelativePositionTask relative_position_;

  // Of the current run.
  ExecTime last_seen_at_;
  std::optional<double> bearing_rad_;  ///< the last one seen
  double yaw_rate_rad_s_ = 0.0;        ///< its size now
  double direction_ = 0.0;             ///< +1 counter-clockwise, −1 clockwise
  bool in_sight_ = true;               ///< at the last look
  int overshoots_ = 0;
  int looks_ = 0;
  bool lost_ = false;
};

}  // namespace tether::tasks
