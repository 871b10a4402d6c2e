#pragma once

#include <memory>
#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/base/units.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/relative_position_task.h>
#include <tether/tasks/task.h>
#include <tether/uav/math.h>
#include <tether/uav/samples.h>

namespace tether::tasks {

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
