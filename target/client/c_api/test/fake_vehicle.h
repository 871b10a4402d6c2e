#pragma once

#include "handles.h"

#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <tether/client.h>
#include <tether/client/vehicle.h>

namespace tether::c_api {

/// A UAV without a simulator: gives what the test put in, and keeps what it was told.
class FakeVehicle final : public client::Vehicle {
 public:
  explicit FakeVehicle() {
    catalogue_.uav = "uav1";
    uav::CameraModel model = uav::CameraModel::from_horizontal_fov(4, 2, 1.0);
    model.k1 = 0.1;
    model.k2 = 0.2;
    model.k3 = 0.3;
    model.p1 = 0.4;
    model.p2 = 0.5;
    const uav::Pose X_BS{{0.1, 0.2, 0.3}, {0.5, 0.5, -0.5, 0.5}};
    catalogue_.sensors = {
        {"camera", X_BS, 30.0, uav::CameraProperties{model}},
        {"imu", {}, 20.0, uav::ImuProperties{}},
        {"down", {}, 0.0, uav::RangeProperties{0.1, 8.0}},
        {"ahead", {}, 10.0, uav::RangeProperties{0.1, 8.0}},
        {"rgbd", {}, 10.0, uav::CameraProperties{model, uav::CameraKind::kRgbd, 0.3, 9.0}},
        {"labels",
         {},
         10.0,
         uav::CameraProperties{
             model, uav::CameraKind::kSegmentation, 0.0, 0.0, {"wall", "blue_box"}}},
        {"gps", {}, 5.0, uav::NavSatProperties{}},
        {"compass", {}, 10.0, uav::MagnetometerProperties{}},
        {"air", {}, 10.0, uav::BarometerProperties{}},
        {"pose", {}, 50.0, uav::OdometryProperties{}},
        {"lidar", {}, 10.0, uav::ScanProperties{}},
        {"joint_state", {}, 10.0, uav::JointStateProperties{}}};
    catalogue_.anchors = {{"blue_box", uav::AnchorShape::kBox, {0.4, 0.5, 0.6}, {0.05, 0.15, 0.85}},
                          {"ball", uav::AnchorShape::kSphere, {0.2, 0.2, 0.2}, {1.0, 0.0, 0.0}}};
    catalogue_.battery_capacity_C = 7200.0;
    catalogue_.limits = {4, 800.0, 24.0, {{"yaw", {1, 2, 3}, {0, 0, 1}, -1, 2, 0.5}}};
    catalogue_.sensors[0].joints = 1;
    image.rgb.assign(24, 7);
    image.rgb.back() = 9;
  }

  ExecTime now() const override { return et; }
  const uav::Catalogue& catalogue() const override { return catalogue_; }
  bool is_concurrent() const override { return concurrent; }

  Result<uav::Sample> read_any(std::string_view sensor, uav::SensorKind kind,
                               client::Read read) override {
    if (kind == uav::SensorKind::kCamera) return answer(sensor, read, image);
    if (kind == uav::SensorKind::kImu) return answer(sensor, read, imu);
    if (kind == uav::SensorKind::kRange) return answer(sensor, read, range);
    for (const uav::Sample& sample : navigation)
      if (static_cast<uav::SensorKind>(sample.index()) == kind) return answer(sensor, read, sample);
    return Failure{Failure::Kind::kInvalid, "nothing was put in"};
  }
  Status set_queue(std::string_view sensor, std::uint32_t depth) override {
    queues.emplace_back(sensor, depth);
    return status();
  }
  Result<uav::BatterySample> read_battery() override {
    if (failure) return *failure;
    return uav::BatterySample{from_ns<SimTime>(14), 12.5, 6.0, 0.75};
  }
  Status command_velocity(const uav::VelocityCommand& command) override {
    commands.push_back(command);
    return status();
  }
  Status follow(std::span<const uav::TimedSetpoint> trajectory) override {
    followed.insert(followed.end(), trajectory.begin(), trajectory.end());
    return status();
  }
  Status sleep_for(Duration duration) override {
    et += duration;
    return status();
  }
  Status sleep_until(ExecTime until) override {
    et = until;
    return status();
  }
  const std::vector<std::string>& peers() const override { return others; }
  Status send(std::string_view to, std::span<const std::uint8_t> bytes) override {
    return say("to " + std::string(to) + ": " + std::string(bytes.begin(), bytes.end()));
  }
  Result<client::RadioMessage> receive(Duration timeout) override {
    et += timeout;
    if (failure) return *failure;
    return client::RadioMessage{"uav2", from_ns<SimTime>(7), from_ns<SimTime>(9), {'h', 'i'}};
  }
  Status annotate(std::string_view topic, std::string_view json) override {
    return say(std::string(topic) + " " + std::string(json));
  }
  Status begin_stage(std::string_view stage) override { return say("begin " + std::string(stage)); }
  Status end_stage() override { return say("end"); }
  Status finish(bool reached_goal, std::string_view outcome, std::string_view details) override {
    return say(std::string(reached_goal ? "reached " : "missed ") + std::string(outcome) + " " +
               std::string(details));
  }

  ExecTime et{};
  bool concurrent = false;
  bool out_of_memory = false;
  std::optional<Failure> failure;  ///< of every call
  std::optional<int> reads_left;   ///< the run ends after them
  uav::CameraSample image{from_ns<SimTime>(11), 3, 4, 2, {}};
  uav::ImuSample imu{from_ns<SimTime>(12), 4, {1, 2, 3}, {4, 5, 6}, {0.5, -0.5, 0.5, -0.5}};
  uav::RangeSample range{from_ns<SimTime>(13), 5, 1.5};
  std::vector<uav::Sample> navigation;  ///< one of each other kind that is read
  std::vector<std::pair<std::string, std::uint32_t>> queues;
  std::vector<std::pair<std::string, client::Read>> reads;
  std::vector<uav::VelocityCommand> commands;
  std::vector<uav::TimedSetpoint> followed;
  std::vector<std::string> said;
  std::vector<std::string> others{"uav2", "uav3"};

 private:
  template <class Sample>
  Result<uav::Sample> answer(std::string_view sensor, client::Read read, const Sample& sample) {
    if (out_of_memory) throw std::bad_alloc();
    reads.emplace_back(sensor, read);
    if (failure) return *failure;
    if (reads_left && (*reads_left)-- == 0) return Failure{Failure::Kind::kRunEnded, "time limit"};
    return uav::Sample(sample);
  }
  Status say(std::string text) {
    said.push_back(std::move(text));
    return status();
  }
  Status status() const { return failure ? Status(*failure) : ok_status(); }

  uav::Catalogue catalogue_;
};

/// A vehicle of the C API, and the fake behind it.
struct Flown {
  Flown() {
    auto made = std::make_unique<FakeVehicle>();
    fake = made.get();
    vehicle = new tether_vehicle(std::move(made));
  }
  ~Flown() { tether_disconnect(vehicle); }
  Flown(const Flown&) = delete;
  Flown& operator=(const Flown&) = delete;

  FakeVehicle* fake;
  tether_vehicle* vehicle;
};

}  // namespace tether::c_api
