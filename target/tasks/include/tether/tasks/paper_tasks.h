#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/base/units.h>
#include <tether/tasks/task.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/math.h>
#include <tether/uav/samples.h>
#include <tether/vision/anchor_tracker.h>

/// The tasks of the paper.
namespace tether::tasks {

struct SensorCharacterizationOptions {
  int acquisitions = 100;                          ///< > 0
  Duration time_limit = std::chrono::seconds(60);  ///< of the SUT's clock; then "time limit"
};

/// One reading of a sensor and its times.
struct Acquisition {
  ExecTime asked_at;
  ExecTime had_at;          ///< ≥ asked_at; the difference is what Algorithm 1 measures
  SimTime sampled_at;       ///< timestamp of the sample
  std::uint64_t index = 0;  ///< of the sample
};

/// Algorithm 1: acquires one sensor's data repeatedly, waiting each time for a new measurement, and
/// measures the time on the SUT's clock. Sends no command.
///
/// Results: "duration_s" (ET of all acquisitions, which the listing returns), "acquisitions" (their
/// number), and of one acquisition "mean_s", "min_s", "median_s", "max_s" and, with two or more,
/// "stddev_s" (of a sample).
class SensorCharacterizationTask : public Task {
 public:
  /// `sensor`: the name of a sensor of any kind.
  explicit SensorCharacterizationTask(std::string sensor,
                                      const SensorCharacterizationOptions& options = {});

  std::string_view name() const override { return "sensor_characterization"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

  /// All acquisitions of the last run in their order, even if it failed.
  const std::vector<Acquisition>& acquisitions() const { return acquisitions_; }

 private:
  std::string sensor_;
  SensorCharacterizationOptions options_;
  LoopLimit limit_;

  // Of the current run.
  uav::SensorKind kind_ = uav::SensorKind::kCamera;
  std::vector<Acquisition> acquisitions_;
};

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

struct ClosedPathOptions {
  double distance_m = 1.0;  ///< of each leg; > 0
  double speed_m_s = 0.3;   ///< > 0
  std::string imu = "imu";
  /// Pause before the start, by the IMU's timestamps, in which its bias is measured; ≥ 0.
  Duration rest_time = std::chrono::seconds(1);
  ConvergenceOptions convergence;                  ///< of the estimates at the start and at the end
  double turn_rate_rad_s = rad_from_deg(25.0);     ///< maximum, back to the start heading; > 0
  double turn_tolerance_rad = rad_from_deg(1.0);   ///< > 0
  Duration turn_limit = std::chrono::seconds(15);  ///< then "time limit turning back"
  /// Pause after the stop, by the IMU's timestamps, while the UAV comes to rest; ≥ 0.
  Duration settle_time = std::chrono::seconds(1);
  Duration leg_slack = std::chrono::seconds(5);  ///< limit of a leg: five times its time plus this
  Duration time_limit = std::chrono::seconds(180);  ///< of the SUT's clock
  int max_readings = 200'000;                       ///< of the IMU, in case that clock is stopped
};

/// Algorithm 5: flies a closed path by dead reckoning with the IMU, and measures by vision how far
/// from its start it ended.
///
/// Four legs in the directions 0, π/2, π, 3π/2 from the start heading, at a constant heading. The
/// listing's fifth direction, 2π, would leave the closed path; instead, the UAV stops and turns
/// back to the start heading.
///
/// Both pauses are in simulated time, measured by the timestamps of the IMU's readings: 1 s is 20
/// readings at 20 Hz.
///
/// Not reached: "time limit in leg 2", "time limit turning back", "time limit at rest before the
/// start", "time limit coming to rest", "round limit …"; "anchor not seen
/// at the start", "no distance to the anchor at the end", ….
///
/// Results: "duration_s" (ET), "legs" (flown to their end), "path_length_m" and "end_x_m",
/// "end_y_m" (dead-reckoned), "displacement_m", "displacement_x_m", "displacement_y_m" (by vision;
/// only if known). All positions in the start-heading frame H0.
class ClosedPathTask : public Task {
 public:
  explicit ClosedPathTask(std::string anchor, const ClosedPathOptions& options = {});
  ~ClosedPathTask() override;

  std::string_view name() const override { return "closed_path"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  enum class Phase { kLegs, kTurnBack, kSettle };
  struct Flight;

  Progress see_anchor(TaskContext& context, std::string_view when, uav::Vec3& p_HA);
  Progress rest(TaskContext& context);
  Progress read_imu(TaskContext& context);
  void reckon(TaskContext& context, const uav::ImuSample& reading);
  Progress start_leg(TaskContext& context);
  Progress follow_leg(TaskContext& context);
  Progress turn_back(TaskContext& context);
  Progress settle(TaskContext& context);
  Progress measure(TaskContext& context);
  void enter(TaskContext& context, Phase phase);
  std::string place() const;

  ClosedPathOptions options_;
  LoopLimit limit_;
  RelativePositionTask relative_position_;
  std::unique_ptr<Flight> flight_;  ///< state of the current run
};

}  // namespace tether::tasks
