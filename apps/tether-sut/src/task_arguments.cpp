#include "task_arguments.h"

#include "common_arguments.h"

#include <utility>

namespace tether::sut {
namespace {

constexpr const char* kTimeLimit = "Gives up after this time of its own clock";

void add_settling(CLI::App& app, Duration& time) {
  add_seconds(app, "--settle-s", time,
              "By the IMU's readings, after the final stop, while the UAV comes to rest", 0.0);
}

template <class Options>
class ArgumentsFor : public TaskArguments {
 public:
  TaskSpec spec() const override {
    TaskSpec spec = spec_;
    spec.options = options_;
    return spec;
  }

 protected:
  TaskSpec spec_;
  Options options_;
};

class SensorCharacterizationArguments : public ArgumentsFor<tasks::SensorCharacterizationOptions> {
 public:
  std::string_view name() const override { return "sensor_characterization"; }
  std::string_view description() const override {
    return "Time the acquisition of a sensor's data";
  }
  void add_to(CLI::App& app) override {
    app.add_option("--sensor", spec_.sensor, "Name of the sensor, of any kind")->required();
    app.add_option("--acquisitions", options_.acquisitions, "How many")
        ->check(CLI::Range(1, 10'000'000))
        ->capture_default_str();
    add_seconds(app, "--time-limit-s", options_.time_limit, kTimeLimit);
  }
};

class RelativePositionArguments : public ArgumentsFor<tasks::RelativePositionOptions> {
 public:
  std::string_view name() const override { return "relative_position"; }
  std::string_view description() const override {
    return "Measure bearing and distance of the anchor";
  }
  void add_to(CLI::App& app) override {
    add_vision_options(app, spec_);
    add_convergence_options(app, options_.convergence);
    add_seconds(app, "--time-limit-s", options_.time_limit, kTimeLimit);
  }
};

class FaceAnchorArguments : public ArgumentsFor<tasks::FaceAnchorOptions> {
 public:
  std::string_view name() const override { return "face_anchor"; }
  std::string_view description() const override {
    return "Turn until the anchor is straight ahead";
  }
  void add_to(CLI::App& app) override {
    add_vision_options(app, spec_);
    add_degrees(app, "--precision-deg", options_.precision_rad, "The goal: bearing at most this",
                0.001, 90.0);
    add_turning_options(app, options_);
    add_seconds(app, "--time-limit-s", options_.time_limit, kTimeLimit);
  }
};

class MoveForwardArguments : public ArgumentsFor<tasks::MoveForwardOptions> {
 public:
  std::string_view name() const override { return "move_forward"; }
  std::string_view description() const override {
    return "Move ahead facing the anchor until it is abeam";
  }
  void add_to(CLI::App& app) override {
    add_vision_options(app, spec_);
    app.add_option("--speed-m-s", options_.speed_m_s, "Of moving")
        ->check(within(0.001, 5.0))
        ->capture_default_str();
    add_degrees(app, "--precision-deg", options_.precision_rad,
                "Faces the anchor when its bearing is more than this", 0.001, 90.0);
    add_degrees(app, "--face-precision-deg", options_.face.precision_rad,
                "Facing it: until its bearing is at most this", 0.001, 90.0);
    add_seconds(app, "--face-time-limit-s", options_.face.time_limit,
                "Facing it: moves on after this time");
    app.add_option("--stop-to-face", options_.stop_to_face,
                   "true or false: stop while turning towards the anchor")
        ->capture_default_str();
    add_turning_options(app, options_.face);
    app.add_option("--imu", options_.face.imu,
                   "Name of the IMU that tells the heading, or a real one's device")
        ->capture_default_str();
    add_settling(app, options_.settle_time);
    add_seconds(app, "--time-limit-s", options_.time_limit, kTimeLimit);
  }
};

class ClosedPathArguments : public ArgumentsFor<tasks::ClosedPathOptions> {
 public:
  std::string_view name() const override { return "closed_path"; }
  std::string_view description() const override {
    return "Fly a square by the IMU and see how far from its start it ends";
  }
  void add_to(CLI::App& app) override {
    add_vision_options(app, spec_);
    add_path_options(app);
    add_convergence_options(app, options_.convergence);
    add_limits(app);
  }

 private:
  void add_path_options(CLI::App& app) {
    app.add_option("--distance-m", options_.distance_m, "Length of each of the four legs")
        ->check(within(0.01, 1000.0))
        ->capture_default_str();
    app.add_option("--speed-m-s", options_.speed_m_s, "Of moving")
        ->check(within(0.001, 5.0))
        ->capture_default_str();
    app.add_option("--imu", options_.imu, "Name of the IMU, or a real one's device")
        ->capture_default_str();
    add_seconds(app, "--rest-s", options_.rest_time,
                "By the IMU's readings, before the start; its bias is taken from them", 0.0);
    add_degrees(app, "--turn-rate-deg-s", options_.turn_rate_rad_s,
                "Turning back to the start heading: at most this fast", 0.01, 720.0);
    add_degrees(app, "--turn-tolerance-deg", options_.turn_tolerance_rad,
                "... until the heading is off by at most this", 0.01, 90.0);
    add_settling(app, options_.settle_time);
  }
  void add_limits(CLI::App& app) {
    add_seconds(app, "--turn-limit-s", options_.turn_limit, "Gives up turning back after this");
    add_seconds(app, "--leg-slack-s", options_.leg_slack,
                "Gives up a leg after five times its time and this");
    add_seconds(app, "--time-limit-s", options_.time_limit, kTimeLimit);
  }
};

}  // namespace

std::vector<std::unique_ptr<TaskArguments>> all_task_arguments() {
  std::vector<std::unique_ptr<TaskArguments>> all;
  all.push_back(std::make_unique<SensorCharacterizationArguments>());
  all.push_back(std::make_unique<RelativePositionArguments>());
  all.push_back(std::make_unique<FaceAnchorArguments>());
  all.push_back(std::make_unique<MoveForwardArguments>());
  all.push_back(std::make_unique<ClosedPathArguments>());
  return all;
}

std::unique_ptr<TaskArguments> make_task_arguments(std::string_view task) {
  for (auto& arguments : all_task_arguments()) {
    if (arguments->name() == task) {
      return std::move(arguments);
    }
  }
  return nullptr;
}

}  // namespace tether::sut
