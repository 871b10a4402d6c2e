#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <tether/base/time.h>
#include <tether/base/units.h>
#include <tether/tasks/task.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/math.h>
#include <tether/uav/samples.h>

namespace tether::vision {
struct Roi;
}

/// The other tasks, of which missions are made.
namespace tether::tasks {

struct GoToOptions {
  double ahead_m = 1.0;       ///< the goal, from the start: along the heading,
  double left_m = 0.0;        ///< to its left,
  double up_m = 0.0;          ///< and up
  double speed_m_s = 0.5;     ///< maximum; > 0
  double tolerance_m = 0.15;  ///< the goal is reached within this distance; > 0
  std::string imu = "imu";
  /// Pause after the stop, by the IMU's timestamps, while the UAV comes to rest; ≥ 0.
  Duration settle_time = std::chrono::seconds(1);
  /// The pause after that, in which the IMU's bias is measured; ≥ 0.
  Duration rest_time = std::chrono::seconds(1);
  Duration time_limit = std::chrono::seconds(60);  ///< of the SUT's clock; then "time limit"
  int max_readings = 200'000;                      ///< in case that clock is stopped
};

/// Stops, and then flies to a position relative to where it came to rest, by dead reckoning with
/// the IMU, at a constant heading. The height is that of the commands: thrust changes the vertical
/// speed faster than an IMU is read, which then shows what follows a change instead of the change.
/// Annotates its odometry. Results: "duration_s" (ET), "end_x_m",
/// "end_y_m", "end_z_m" (dead-reckoned, in the start-heading frame H0).
class GoToTask : public Task {
 public:
  explicit GoToTask(const GoToOptions& options = {});
  ~GoToTask() override;

  std::string_view name() const override { return "go_to"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  GoToOptions options_;
  LoopLimit limit_;

  // Of the current run.
  std::unique_ptr<class DeadReckoning> reckoning_;
  uav::Vec3 p_H0B_;
  double v_up_m_s_ = 0.0;  ///< of the last command
};

struct HoldOptions {
  Duration duration = std::chrono::seconds(5);  ///< by the IMU's timestamps; > 0
  std::string imu = "imu";
};

/// Hovers for a time. Results: "duration_s" (ET).
class HoldTask : public Task {
 public:
  explicit HoldTask(HoldOptions options = {}) : options_(std::move(options)) {}

  std::string_view name() const override { return "hold"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  HoldOptions options_;
  ExecTime started_at_;
};

struct SearchOptions {
  double yaw_rate_rad_s = rad_from_deg(30.0);  ///< > 0
  bool clockwise = false;
  int frames = 2;  ///< in this number of consecutive images the anchor must be seen; ≥ 1
  Duration time_limit = std::chrono::seconds(30);  ///< of the SUT's clock; then "time limit"
  int max_images = 100'000;                        ///< in case that clock is stopped
};

/// Turns on the spot until the anchor is seen, and stops. Results: "duration_s" (ET), "images",
/// "bearing_rad" (in the last image, if it was seen).
class SearchTask : public Task {
 public:
  explicit SearchTask(std::string anchor, const SearchOptions& options = {});

  std::string_view name() const override { return "search"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  std::string anchor_;
  SearchOptions options_;
  LoopLimit limit_;

  // Of the current run.
  int images_ = 0;
  int seen_in_a_row_ = 0;
  std::optional<double> bearing_rad_;
};

struct SearchPairOptions {
  SearchOptions search{};  ///< its time limit is that of the whole
  /// Where the other UAV hovers: from the start, along the heading at the start, and to its left.
  double partner_ahead_m = 1.0;
  double partner_left_m = 0.0;
  double gap_m = 1.0;      ///< kept to the other one; > 0
  double speed_m_s = 0.5;  ///< maximum; > 0
  std::string imu = "imu";
  Duration repeat = std::chrono::milliseconds(500);  ///< between two messages; > 0
};

/// Two UAVs search for an anchor together (each runs this task): both turn on the spot until one
/// sees it. That one stops, and says so to the other by radio, again and again. The other one then
/// flies to it, and says that it is there. Both have then reached the goal.
///
/// Results: "duration_s" (ET), "images", "found" (1: saw the anchor itself), "sent" (messages).
class SearchPairTask : public Task {
 public:
  explicit SearchPairTask(std::string anchor, const SearchPairOptions& options = {});

  std::string_view name() const override { return "search_pair"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  enum class Word { kFound, kHere };
  /// What the other one has said since the last call; waits for it until `timeout`.
  Result<std::optional<Word>> listen(TaskContext& context, Duration timeout);
  Status say(TaskContext& context, Word word);
  Progress search(TaskContext& context);
  Progress call(TaskContext& context);
  Progress come(TaskContext& context);

  std::string anchor_;
  SearchPairOptions options_;
  LoopLimit limit_;

  // Of the current run.
  double start_yaw_rad_ = 0.0;
  int images_ = 0;
  int seen_in_a_row_ = 0;
  int sent_ = 0;
  bool found_ = false;
};

struct InspectOptions {
  double distance_m = 1.5;                           ///< wanted, from the camera; > 0
  Duration duration = std::chrono::seconds(5);       ///< by the images' timestamps; > 0
  double distance_tolerance_m = 0.25;                ///< > 0
  double bearing_tolerance_rad = rad_from_deg(6.0);  ///< > 0
  double speed_m_s = 0.5;                            ///< maximum; > 0
  double yaw_rate_rad_s = rad_from_deg(40.0);        ///< maximum; > 0
  double yaw_gain_per_s = 1.5;                       ///< yaw rate for each radian; > 0
  double speed_gain_per_s = 0.8;                     ///< speed for each metre; > 0
  Duration lost_limit = std::chrono::seconds(3);     ///< without seeing the anchor; "anchor lost"
  Duration time_limit = std::chrono::seconds(60);    ///< of the SUT's clock; then "time limit"
  int max_images = 100'000;                          ///< in case that clock is stopped
  double least_charge = 0.0;  ///< share of the battery's; below it, "battery low"; 0: not read
};

/// Keeps the anchor straight ahead at a distance, until it was within the tolerances of both for a
/// time without a break. Each image leads to one command, in proportion to what it shows, so that a
/// slow computer makes the UAV swing. The anchor may move. Without the anchor in sight, it hovers.
///
/// Results: "duration_s" (ET), "images", "held_s" (the longest time within the tolerances),
/// "bearing_rad" and "distance_m" (the last ones).
class InspectTask : public Task {
 public:
  explicit InspectTask(std::string anchor, const InspectOptions& options = {});

  std::string_view name() const override { return "inspect"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  std::string anchor_;
  InspectOptions options_;
  LoopLimit limit_;

  // Of the current run.
  int images_ = 0;
  ExecTime seen_at_;
  std::optional<SimTime> held_since_;
  Duration held_{0};
  std::optional<double> bearing_rad_, distance_m_;
};

struct LandOptions {
  double speed_m_s = 0.3;  ///< of the descent, the larger of the two; ≥ 0.15
  std::string imu = "imu";
  /// Pause after the stop, by the IMU's timestamps, while the UAV comes to rest; ≥ 0.
  Duration settle_time = std::chrono::seconds(1);
  /// The pause after that, in which the IMU's bias is measured; ≥ 0.
  Duration rest_time = std::chrono::seconds(1);
  Duration time_limit = std::chrono::seconds(30);  ///< of the SUT's clock; then "time limit"
  int max_readings = 200'000;                      ///< in case that clock is stopped
};

/// Descends until it stands on something. An IMU measures the same at a constant speed as on the
/// floor, and can miss the impact between two readings. So the task switches every half second, by
/// the IMU's timestamps, between the speed of the descent and a slower one: it has landed when the
/// UAV does not follow. Results: "duration_s" (ET), "descended_m" (dead-reckoned, to the last
/// switch).
class LandTask : public Task {
 public:
  explicit LandTask(const LandOptions& options = {});
  ~LandTask() override;

  std::string_view name() const override { return "land"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  Progress sink(TaskContext& context, double speed_m_s);

  LandOptions options_;
  LoopLimit limit_;

  // Of the current run.
  std::unique_ptr<class DeadReckoning> reckoning_;
  double v_wanted_m_s_ = 0.0;  ///< upwards, as all of these
  double change_wanted_m_s_ = 0.0;
  double v_at_switch_m_s_ = 0.0;
  double z_at_switch_m_ = 0.0;
  SimTime switched_at_;
};

struct LandOnOptions {
  double speed_m_s = 2.0;                          ///< maximum along the ground; > 0
  double descent_m_s = 0.4;                        ///< > 0
  double gain_per_s = 1.5;                         ///< speed for each metre beside the anchor; > 0
  double commit_height_m = 0.5;                    ///< below, it sinks without looking; ≥ 0
  std::string range = "range";                     ///< rangefinder that looks down
  std::string imu = "imu";                         ///< for the attitude
  Duration lost_limit = std::chrono::seconds(2);   ///< without seeing the anchor; "anchor lost"
  Duration time_limit = std::chrono::seconds(60);  ///< of the SUT's clock; then "time limit"
  int max_images = 100'000;                        ///< in case that clock is stopped
};

/// Lands on an anchor that may move, with a camera and a rangefinder that look down. Each image
/// leads to one velocity: the UAV goes to the middle of the anchor, learns how it moves (a
/// proportional and an integral term), and sinks while it is above it. When it stands, it stops its
/// rotors, so that what carries it takes it along.
///
/// Results: "duration_s" (ET), "images", "offset_m" (beside the anchor, at the last look).
class LandOnTask : public Task {
 public:
  explicit LandOnTask(std::string anchor, const LandOnOptions& options = {});

  std::string_view name() const override { return "land_on"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  /// A look down.
  struct View {
    double height_m = 0.0;                ///< of the rangefinder above what is below
    SimTime sampled_at;                   ///< of the image
    std::optional<uav::Vec3> anchor_H_m;  ///< along the ground, from the camera; none: not seen
  };
  Result<View> look_down(TaskContext& context);
  Progress approach(TaskContext& context, const View& view);
  Progress sink(TaskContext& context);
  Progress stand(TaskContext& context);

  std::string anchor_;
  LandOnOptions options_;
  LoopLimit limit_;

  // Of the current run.
  int images_ = 0;
  ExecTime seen_at_;
  std::optional<SimTime> last_image_at_;
  uav::Vec3 carried_H_m_s_;  ///< the anchor's velocity, as far as it is learnt
  double offset_m_ = 0.0;
  bool stands_ = false;
};

struct AvoidByScanOptions {
  double distance_m = 10.0;            ///< to the goal line, along the heading at the start; > 0
  double speed_m_s = 2.0;              ///< maximum; > 0
  double max_acceleration_m_s2 = 3.0;  ///< of the predicted paths; > 0
  Duration reaction = std::chrono::milliseconds(150);  ///< before the UAV follows a command; ≥ 0
  double radius_m = 0.4;  ///< kept free around the body's origin; ≥ 0
  double margin_m = 0.3;  ///< wanted beyond that, at the price of a longer way; ≥ 0
  Duration horizon = std::chrono::milliseconds(1500);  ///< of the predicted paths; ≥ step
  Duration step = std::chrono::milliseconds(50);       ///< along a predicted path; > 0
  int directions = 72;                                 ///< of the velocities to choose from; ≥ 1
  int speeds = 6;                                      ///< in each direction; ≥ 1
  std::string lidar = "lidar";
  std::string odometry = "odometry";
  Duration time_limit = std::chrono::seconds(60);  ///< of the SUT's clock; then "time limit"
  int max_scans = 100'000;                         ///< in case that clock is stopped
};

/// Flies across a field of obstacles to a goal line, at the height and the heading of the start.
/// Plans a velocity from each scan of a lidar alone, without a map. Annotates its odometry.
/// Results: "duration_s" (ET), "scans", "blocked" (scans with which each velocity would hit
/// something), "end_x_m", "end_y_m" (by odometry, in the start-heading frame H0).
class AvoidByScanTask : public Task {
 public:
  explicit AvoidByScanTask(const AvoidByScanOptions& options = {});

  std::string_view name() const override { return "avoid_by_scan"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  uav::VelocityCommand plan(TaskContext& context, const uav::ScanSample& scan,
                            const uav::OdometrySample& odometry, const uav::Vec3& p_H0B);

  AvoidByScanOptions options_;
  LoopLimit limit_;

  // Of the current run.
  const uav::SensorDescription* lidar_ = nullptr;
  uav::Pose X_WH0_;
  uav::Vec3 p_H0B_;
  int scans_ = 0;
  int blocked_ = 0;
};

struct FlyThroughGatesOptions {
  double speed_m_s = 2.0;              ///< along the heading at the start; > 0
  double max_acceleration_m_s2 = 3.0;  ///< of the commands, sideways and up; > 0
  double stiffness_per_s2 = 6.0;  ///< acceleration for each metre beside the gate's middle; > 0
  double damping_per_s = 4.0;     ///< acceleration against each m/s of sideways speed; ≥ 0
  double run_out_m = 1.0;         ///< the goal: so far behind the last gate; ≥ 0
  std::string imu = "imu";
  std::string odometry = "odometry";
  Duration time_limit = std::chrono::seconds(60);  ///< of the SUT's clock; then "time limit"
  int max_images = 100'000;                        ///< in case that clock is stopped
};

/// Flies through all anchors of the catalogue, in their order, as through gates: frames that stand
/// across the heading of the start. Where a gate is, it measures by the camera (bearing, elevation
/// and distance); between two images it knows its own motion by all readings of the IMU, and by an
/// odometry, which may drift. Commands accelerations, at the heading of the start.
///
/// Annotates ROIs, estimates and its odometry. Results: "duration_s" (ET), "images", "sightings",
/// "gates" (passed).
class FlyThroughGatesTask : public Task {
 public:
  explicit FlyThroughGatesTask(const FlyThroughGatesOptions& options = {});
  ~FlyThroughGatesTask() override;

  std::string_view name() const override { return "fly_through_gates"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  const uav::Anchor& gate(TaskContext& context) const;
  Status look(TaskContext& context);
  void see(TaskContext& context, const vision::Roi& roi, std::uint64_t image_index,
           SimTime sampled_at);
  Status follow_motion(TaskContext& context);
  Status steer(TaskContext& context);

  FlyThroughGatesOptions options_;
  LoopLimit limit_;

  // Of the current run.
  std::unique_ptr<class PoseTrack> track_;
  uav::Pose X_WH0_;                 ///< level, at the start
  std::optional<uav::Vec3> p_H0G_;  ///< the middle of the next gate, if it has been seen
  uav::Vec3 aim_H0_;                ///< where it flies as long as it has not
  std::size_t passed_ = 0;
  int images_ = 0;
  int sightings_ = 0;
};

}  // namespace tether::tasks
