#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/math.h>

namespace tether::vision {
struct Roi;
}

namespace tether::tasks {

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
