#pragma once

#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>
#include <tether/uav/math.h>

namespace tether::tasks {

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

}  // namespace tether::tasks
