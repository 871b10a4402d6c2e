#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/units.h>
#include <tether/client/vehicle.h>
#include <tether/vision/testing/synthetic_scene.h>

namespace tether::tasks::testing {

/// A UAV that turns on the spot in front of a blue box, with a computer of scripted speed: ET moves
/// only by waiting for images and by `compute_per_image` for each of them. Deterministic; needs no
/// network and no simulator.
class TurningVehicle : public client::Vehicle {
 public:
  struct Options {
    double anchor_bearing_rad = rad_from_deg(30.0);  ///< at the start
    double anchor_distance_m = 4.0;
    bool anchor_is_there = true;
    std::pair<Duration, Duration> anchor_hidden{};  ///< from, until
    Duration compute_per_image{0};
    Duration image_period = std::chrono::nanoseconds(33'333'333);
    Duration image_delay = std::chrono::milliseconds(20);
    double max_yaw_acceleration_rad_s2 = 6.0;
    /// The connection ends with this interaction (counted from 0).
    std::optional<int> disconnect_at = std::nullopt;
  };

  struct Annotation {
    std::string topic;
    std::string json;
  };
  struct Finish {
    bool reached_goal;
    std::string outcome;
    std::string details_json;
  };

  explicit TurningVehicle(const Options& options);

  ExecTime now() const override { return now_; }
  const uav::Catalogue& catalogue() const override { return catalogue_; }
  Result<uav::CameraSample> read_camera(std::string_view sensor, client::Read read) override;
  Result<uav::ImuSample> read_imu(std::string_view sensor, client::Read read) override;
  Result<uav::RangeSample> read_range(std::string_view sensor, client::Read read) override;
  Status command_velocity(const uav::VelocityCommand& command) override;
  Status sleep_for(Duration duration) override;
  Status sleep_until(ExecTime until) override;
  Status annotate(std::string_view topic, std::string_view json) override;
  Status finish(bool reached_goal, std::string_view outcome,
                std::string_view details_json) override;

  /// @name What happened
  /// @{
  double yaw() const { return yaw_at_ms_.back(); }
  /// What is left to turn: the true bearing of the anchor's centre [rad].
  double bearing() const { return options_.anchor_bearing_rad - yaw(); }
  const std::vector<uav::VelocityCommand>& commands() const { return commands_; }
  const std::vector<Annotation>& annotations() const { return annotations_; }
  const std::optional<Finish>& finished() const { return finish_; }
  int images_read() const { return images_read_; }
  /// @}

 private:
  Status begin_interaction();
  void simulate_until(ExecTime until);

  Options options_;
  uav::Catalogue catalogue_;
  vision::testing::SyntheticScene with_anchor_, without_anchor_;
  ExecTime now_;
  std::vector<double> yaw_at_ms_{0.0};  // [rad] at each millisecond up to now
  double yaw_rate_rad_s_ = 0.0;
  uav::VelocityCommand command_;
  std::optional<std::uint64_t> last_image_;
  int interactions_ = 0;
  int images_read_ = 0;
  std::vector<uav::VelocityCommand> commands_;
  std::vector<Annotation> annotations_;
  std::optional<Finish> finish_;
};

}  // namespace tether::tasks::testing
