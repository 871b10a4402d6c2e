#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>
#include <tether/vision/testing/synthetic_scene.h>

namespace tether::tasks {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(5);
constexpr Duration kFrame = std::chrono::milliseconds(35);

/// A point that follows accelerations, always level, with a camera, an IMU that keeps its readings,
/// and an odometry that drifts to the left. Two gates stand ahead. `computing`: of each image.
class RacingVehicle : public client::Vehicle {
 public:
  explicit RacingVehicle(Duration computing) : computing_(computing) {
    catalogue_.sensors = {
        {"camera",
         {{0.1, 0.0, 0.0}, {}},
         28.6,
         uav::CameraProperties{uav::CameraModel::from_horizontal_fov(160, 120, 1.4)}},
        {"imu", {}, 200.0, uav::ImuProperties{}},
        {"odometry", {}, 50.0, uav::OdometryProperties{}}};
    add_gate("red", {4.0, 0.5, 0.3}, {0.9, 0.1, 0.1});
    add_gate("blue", {8.0, -0.4, -0.2}, {0.1, 0.2, 0.9});
  }

  ExecTime now() const override { return same_instant(at(states_.size() - 1)); }
  const uav::Catalogue& catalogue() const override { return catalogue_; }
  Status set_queue(std::string_view, std::uint32_t) override { return ok_status(); }
  std::uint32_t queue_of(std::string_view) const override { return 64; }
  Result<uav::Sample> read_any(std::string_view, uav::SensorKind kind, client::Read read) override {
    if (kind == uav::SensorKind::kCamera) return uav::Sample(image());
    if (kind == uav::SensorKind::kOdometry) return uav::Sample(odometry());
    if (next_imu_ == states_.size()) {
      if (read == client::Read::kIfAvailable)
        return Failure{Failure::Kind::kNothingYet, "no reading"};
      advance(kStep);
    }
    return uav::Sample(reading(next_imu_++));
  }
  Status command_velocity(const uav::VelocityCommand& command) override {
    is_stopped_ = command == uav::VelocityCommand{};
    return ok_status();
  }
  Status follow(std::span<const uav::TimedSetpoint> trajectory) override {
    acceleration_ = trajectory.front().setpoint.acceleration_m_s2;
    return ok_status();
  }
  Status sleep_for(Duration) override { return ok_status(); }
  Status sleep_until(ExecTime) override { return ok_status(); }
  Status annotate(std::string_view, std::string_view) override { return ok_status(); }
  Status finish(bool, std::string_view, std::string_view) override { return ok_status(); }

  bool is_stopped() const { return is_stopped_; }
  /// The greatest distance to a gate's middle, as it was passed, along the worse axis.
  double worst_miss_m() const {
    double worst = 0.0;
    for (const uav::Vec3& gate : gates_) {
      const auto crossed =
          std::ranges::find_if(states_, [&](const State& s) { return s.p.x >= gate.x; });
      if (crossed == states_.end()) return std::numeric_limits<double>::infinity();
      worst = std::max({worst, std::abs(crossed->p.y - gate.y), std::abs(crossed->p.z - gate.z)});
    }
    return worst;
  }

 private:
  struct State {
    uav::Vec3 p, v, a;
  };

  static SimTime at(std::size_t step) { return SimTime(static_cast<Duration::rep>(step) * kStep); }
  std::size_t steps_until(SimTime instant) const {
    return static_cast<std::size_t>(instant.time_since_epoch() / kStep);
  }

  void add_gate(const std::string& name, const uav::Vec3& middle, const uav::Vec3& color) {
    gates_.push_back(middle);
    catalogue_.anchors.push_back({name, uav::AnchorShape::kBox, {0.15, 1.5, 1.5}, color});
    for (const double side : {-1.0, 1.0}) {
      scene_.boxes.push_back(
          {middle + uav::Vec3{0.0, 0.675 * side, 0.0}, 0.0, {0.15, 0.15, 1.5}, color});
      scene_.boxes.push_back(
          {middle + uav::Vec3{0.0, 0.0, 0.675 * side}, 0.0, {0.15, 1.2, 0.15}, color});
    }
  }

  void advance(Duration time) {
    const double dt_s = to_seconds(kStep);
    for (Duration passed{0}; passed < time; passed += kStep) {
      State next = states_.back();
      next.a = acceleration_;
      next.v = next.v + dt_s * next.a;
      next.p = next.p + dt_s * next.v;
      states_.push_back(next);
    }
  }

  uav::CameraSample image() {
    const Duration since = now().time_since_epoch();
    const Duration sampled = (since / kFrame + 1) * kFrame;
    advance(sampled - since);
    const auto& model = std::get<uav::CameraProperties>(catalogue_.sensors[0].properties).model;
    uav::CameraSample image = scene_.render(
        model, vision::testing::level_camera(states_.back().p + uav::Vec3{0.1, 0.0, 0.0}, 0.0),
        images_++);
    image.sampled_at = SimTime(sampled);
    advance(computing_);
    return image;
  }
  uav::ImuSample reading(std::size_t step) const {
    uav::ImuSample sample;
    sample.sampled_at = at(step);
    sample.specific_force_m_s2 = states_[step].a + uav::Vec3{0.0, 0.0, 9.81};
    return sample;
  }
  uav::OdometrySample odometry() const {
    uav::OdometrySample sample;
    sample.sampled_at = at(states_.size() - 1);
    sample.p_WS =
        states_.back().p + uav::Vec3{0.0, 0.2 * to_seconds(now().time_since_epoch()), 0.0};
    sample.v_WS_m_s = states_.back().v;
    return sample;
  }

  Duration computing_;
  uav::Catalogue catalogue_;
  vision::testing::SyntheticScene scene_;
  std::vector<uav::Vec3> gates_;
  std::vector<State> states_{State{}};
  uav::Vec3 acceleration_;
  std::size_t next_imu_ = 0;
  std::uint64_t images_ = 0;
  bool is_stopped_ = false;
};

double fly_past(Duration computing) {
  RacingVehicle vehicle(computing);
  TaskContext context(vehicle);
  FlyThroughGatesTask task({.speed_m_s = 2.5, .time_limit = std::chrono::seconds(8)});
  const TaskOutcome outcome = run(task, context);
  EXPECT_NE(outcome.status, TaskStatus::kFailed) << outcome.reason;
  EXPECT_TRUE(vehicle.is_stopped());
  if (computing == Duration(0)) {
    EXPECT_EQ(outcome.results.at("gates"), 2.0);
  }
  return vehicle.worst_miss_m();
}

// The odometry alone would lead it 0.6 m past the second gate's middle.
TEST(FlyThroughGatesTask, PassesTheMiddleOfEachGateUnlessItsComputerIsSlow) {
  EXPECT_LT(fly_past(Duration(0)), 0.25);
  EXPECT_GT(fly_past(std::chrono::milliseconds(600)), 0.34);
}

TEST(FlyThroughGatesTask, NeedsAnchors) {
  class Blind : public RacingVehicle {
    using RacingVehicle::RacingVehicle;
    const uav::Catalogue& catalogue() const override { return none_; }
    uav::Catalogue none_;
  };
  Blind vehicle(Duration(0));
  TaskContext context(vehicle);
  FlyThroughGatesTask task;
  EXPECT_EQ(run(task, context).status, TaskStatus::kFailed);
}

}  // namespace
}  // namespace tether::tasks
