#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/units.h>
#include <tether/client/vehicle.h>
#include <tether/vision/testing/synthetic_scene.h>

namespace tether::tasks::testing {

/// A UAV that flies level in a world with one blue box, with a computer of scripted speed: ET moves
/// only by waiting and by `compute_per_image` for each image. Yaw rate and velocity follow the
/// command with limited acceleration. Deterministic; needs no network and no simulator.
///
/// Starts at the world's origin. Sensors: "camera" (30 Hz), "imu" (200 Hz unless said otherwise),
/// "range" (on demand: the distance to a wall at x = 10 m).
class PlanarVehicle : public client::Vehicle {
 public:
  struct Options {
    double anchor_bearing_rad = rad_from_deg(30.0);  ///< at the start
    double anchor_distance_m = 4.0;                  ///< from the UAV
    double anchor_height_m = 0.5;
    bool anchor_is_there = true;
    std::pair<Duration, Duration> anchor_hidden{};  ///< from, until
    double start_yaw_rad = 0.0;
    uav::Vec3 start_velocity_m_s{};  ///< in the world
    double max_acceleration_m_s2 = 3.0;
    double camera_ahead_m = 0.0;  ///< its mounting
    double height_m = 1000.0;     ///< of the start above the floor
    uav::Quat q_BS_imu{};         ///< the IMU's mounting
    uav::Vec3 imu_bias_m_s2{};    ///< of the specific force
    bool imu_is_stuck = false;    ///< it reports a UAV that never moves
    Duration compute_per_image{0};
    /// What a rangefinder's measurement takes, in turn.
    std::vector<Duration> range_delays{std::chrono::milliseconds(30)};
    Duration image_delay = std::chrono::milliseconds(20);
    std::optional<Duration> endurance{};  ///< of its battery; none: it has no battery
    bool clock_stands_still = false;      ///< `now` always says 0, whatever happens
    /// Speed of `now` relative to the samples' timestamps; other than 1 without synchronisation.
    double clock_factor = 1.0;
    Duration imu_period = std::chrono::milliseconds(5);
    bool imu_instants_stand_still = false;  ///< its readings go on, their `sampled_at` does not
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

  explicit PlanarVehicle(const Options& options);

  ExecTime now() const override;
  const uav::Catalogue& catalogue() const override { return catalogue_; }
  Result<uav::Sample> read_any(std::string_view sensor, uav::SensorKind kind,
                               client::Read read) override;
  /// Full at the start, and empty after `Options::endurance`.
  Result<uav::BatterySample> read_battery() override;
  Status command_velocity(const uav::VelocityCommand& command) override;
  Status sleep_for(Duration duration) override;
  Status sleep_until(ExecTime until) override;
  Status annotate(std::string_view topic, std::string_view json) override;
  Status finish(bool reached_goal, std::string_view outcome,
                std::string_view details_json) override;

  /// Turns the UAV by force, as a gust would.
  void disturb_yaw(double yaw_rad) { states_.back().yaw_rad += yaw_rad; }

  /// @name What happened
  /// @{
  double yaw() const { return states_.back().yaw_rad; }
  const uav::Vec3& position() const { return states_.back().p_W; }
  const uav::Vec3& anchor_position() const { return with_anchor_.boxes.front().p_W; }
  /// What is left to turn: the true bearing of the anchor's centre [rad].
  double bearing() const;
  const std::vector<uav::VelocityCommand>& commands() const { return commands_; }
  const std::vector<Annotation>& annotations() const { return annotations_; }
  const std::optional<Finish>& finished() const { return finish_; }
  int images_read() const { return images_read_; }
  /// @}

 private:
  /// @name Of a sensor of that kind
  /// @{
  uav::CameraSample image();
  uav::ImuSample motion(client::Read read);
  uav::RangeSample range();
  /// @}
  struct State {
    uav::Vec3 p_W, v_W, a_W;
    double yaw_rad = 0.0;
    double yaw_rate_rad_s = 0.0;
  };

  Status begin_interaction(std::string_view sensor = {}, std::string_view expected = {});
  State next(const State& state) const;
  const State& at(Duration since_start) const;
  void simulate_until(ExecTime until);

  Options options_;
  uav::Catalogue catalogue_;
  vision::testing::SyntheticScene with_anchor_, without_anchor_;
  ExecTime now_;
  std::vector<State> states_;  // at each millisecond up to now
  uav::VelocityCommand command_;
  std::optional<std::uint64_t> last_image_;
  std::optional<std::uint64_t> last_imu_;
  int interactions_ = 0;
  int images_read_ = 0;
  std::uint64_t ranges_read_ = 0;
  std::vector<uav::VelocityCommand> commands_;
  std::vector<Annotation> annotations_;
  std::optional<Finish> finish_;
};

}  // namespace tether::tasks::testing
