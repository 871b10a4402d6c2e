#pragma once

#include <string>

#include <tether/base/time.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>
#include <tether/uav/samples.h>

namespace tether::tasks {

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

}  // namespace tether::tasks
