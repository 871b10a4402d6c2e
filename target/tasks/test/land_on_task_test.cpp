#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <tether/client/vehicle.h>
#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>
#include <tether/vision/testing/synthetic_scene.h>

namespace tether::tasks {
namespace {

using std::chrono::milliseconds;
using uav::Vec3;

/// A UAV whose camera and rangefinder look down on a pad that drives along W's x. It has each
/// commanded velocity at once.
class OverPad : public client::Vehicle {
 public:
  struct Options {
    Vec3 p_WB_m{-0.5, 0.2, 2.5};
    double pad_speed_m_s = 0.0;
    Duration compute{0};  ///< for each image
    bool pad_is_there = true;
  };

  explicit OverPad(const Options& options) : options_(options), p_WB_m_(options.p_WB_m) {
    const uav::Pose down{{}, uav::from_rpy(0.0, 0.5 * 3.14159265358979, 0.0)};
    catalogue_.sensors = {
        {"camera", down, 30.0,
         uav::CameraProperties{uav::CameraModel::from_horizontal_fov(160, 120, 1.4)}},
        {"range", down, 30.0, uav::RangeProperties{0.04, 10.0}},
        {"imu", {}, 100.0, uav::ImuProperties{}}};
    catalogue_.anchors = {{"pad", uav::AnchorShape::kBox, {0.4, 0.4, 0.4}, {0.05, 0.15, 0.85}}};
    catalogue_.limits = {4, 800.0, 15.0};
  }

  ExecTime now() const override { return now_; }
  const uav::Catalogue& catalogue() const override { return catalogue_; }
  Result<uav::Sample> read_any(std::string_view sensor, uav::SensorKind, client::Read) override {
    if (sensor == "range") return uav::Sample(uav::RangeSample{at(), 0, height_m()});
    if (sensor == "imu") {
      advance(milliseconds(10));
      uav::ImuSample reading;
      reading.sampled_at = at();
      return uav::Sample(reading);
    }
    advance(milliseconds(33));
    vision::testing::SyntheticScene scene;
    if (options_.pad_is_there)
      scene.boxes.push_back({{pad_x_m(), 0.0, -0.2}, 0.0, {0.4, 0.4, 0.4}, {0.05, 0.15, 0.85}});
    const uav::Pose X_WB{p_WB_m_, {}};
    const uav::Pose X_BC = catalogue_.sensors[0].X_BS * uav::Pose{{}, uav::q_body_from_optical()};
    uav::CameraSample image = scene.render(
        std::get<uav::CameraProperties>(catalogue_.sensors[0].properties).model, X_WB * X_BC);
    image.sampled_at = at();
    advance(options_.compute);
    return uav::Sample(std::move(image));
  }
  Status command_velocity(const uav::VelocityCommand& command) override {
    v_WB_m_s_ = command.velocity_H_m_s;
    return ok_status();
  }
  Status follow(std::span<const uav::TimedSetpoint> trajectory) override {
    rotors_are_off_ = trajectory.front().setpoint.mask == uav::kRotorSpeeds &&
                      trajectory.front().setpoint.rotor_speeds_rad_s == std::vector<double>(4, 0.0);
    return ok_status();
  }
  Status sleep_for(Duration duration) override {
    advance(duration);
    return ok_status();
  }
  Status sleep_until(ExecTime until) override { return sleep_for(until - now_); }
  Status annotate(std::string_view, std::string_view) override { return ok_status(); }
  Status finish(bool, std::string_view, std::string_view) override { return ok_status(); }

  double beside_pad_m() const { return std::hypot(p_WB_m_.x - pad_x_m(), p_WB_m_.y); }
  double height_m() const { return p_WB_m_.z; }
  bool rotors_are_off() const { return rotors_are_off_; }
  const Vec3& velocity_m_s() const { return v_WB_m_s_; }

 private:
  SimTime at() const { return SimTime{} + (now_ - ExecTime{}); }
  double pad_x_m() const { return options_.pad_speed_m_s * to_seconds(now_ - ExecTime{}); }
  void advance(Duration duration) {
    now_ += duration;
    if (rotors_are_off_) {
      p_WB_m_.x += options_.pad_speed_m_s * to_seconds(duration);
    } else {
      p_WB_m_ = p_WB_m_ + to_seconds(duration) * v_WB_m_s_;
      p_WB_m_.z = std::max(p_WB_m_.z, 0.0);
    }
  }

  Options options_;
  uav::Catalogue catalogue_;
  ExecTime now_{};
  Vec3 p_WB_m_, v_WB_m_s_{};
  bool rotors_are_off_ = false;
};

TaskOutcome land(OverPad& vehicle) {
  LandOnTask task("pad");
  TaskContext context(vehicle);
  return run(task, context);
}

TEST(LandOnTask, StandsOnAPadThatDrivesWithItsRotorsOff) {
  for (const double speed_m_s : {0.0, 0.8}) {
    OverPad vehicle({.pad_speed_m_s = speed_m_s});
    const TaskOutcome outcome = land(vehicle);
    ASSERT_TRUE(outcome.reached()) << outcome.reason;
    EXPECT_LT(vehicle.beside_pad_m(), 0.2) << speed_m_s;
    EXPECT_TRUE(vehicle.rotors_are_off());
  }
}

TEST(LandOnTask, ASlowComputerDoesNotGetDown) {
  OverPad vehicle({.pad_speed_m_s = 0.8, .compute = milliseconds(1500)});
  EXPECT_FALSE(land(vehicle).reached());
  EXPECT_GT(vehicle.height_m(), 0.3);
}

TEST(LandOnTask, WithoutThePadItStopsAndSaysSo) {
  OverPad vehicle({.pad_is_there = false});
  EXPECT_EQ(land(vehicle).reason, "anchor lost");
  EXPECT_EQ(vehicle.velocity_m_s(), Vec3{});
  EXPECT_EQ(vehicle.height_m(), 2.5);
}

}  // namespace
}  // namespace tether::tasks
