#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/sim/bodies.h>
#include <tether/sim/simulator.h>

namespace tether::sim {

/// A world of `count` UAVs named "uav0", "uav1", …, one metre apart along y at 1 m height, heading
/// east. Each has the sensors "camera" (8×6 pixels, 30 Hz), "imu" (20 Hz) and "range" (0.1 to 20 m,
/// on demand), in this order. One anchor, "blue_box", at x = 8 m.
World make_fake_world(std::size_t count, Duration step = std::chrono::milliseconds(1));

/// A simulator without physics, for tests of its users: each UAV moves exactly as
/// commanded, and every sample tells which instant, UAV and index it was measured for. Keeps
/// Simulator's promises on determinism; breaks of the call order (time backwards or off the grid,
/// unknown UAV or sensor) throw Error(kInternal).
class FakeSimulator final : public Simulator {
 public:
  /// One call of `apply`.
  struct AppliedCommand {
    SimTime at;
    std::size_t uav = 0;
    uav::Setpoint setpoint;
    friend bool operator==(const AppliedCommand&, const AppliedCommand&) = default;
  };

  /// One call of `expect`.
  struct Expected {
    SimTime at;
    std::size_t uav = 0;
    std::size_t sensor = 0;
    std::uint64_t index = 0;
  };

  /// How often each function was called since construction.
  struct Calls {
    std::uint64_t reset = 0;
    std::uint64_t advance_to = 0;
    std::uint64_t steps = 0;  ///< made by all advances
    std::uint64_t capture = 0;
    std::uint64_t measure = 0;
  };

  explicit FakeSimulator(World world = make_fake_world(1));

  /// Called at the beginning of each `advance_to`, with the instants before and after. It may take
  /// its time (a slow simulator) or throw Error(kSetup) (a lost one).
  void on_advance(std::function<void(SimTime from, SimTime to)> callback);
  /// Called at the beginning of each `measure`, likewise.
  void on_measure(std::function<void(std::size_t uav, std::size_t sensor)> callback);

  /// Contacts of the next flight, in the order of time; it reports none otherwise.
  void plan_contacts(std::vector<Contact> contacts) { planned_contacts_ = std::move(contacts); }
  /// What of the anchors each image shows; it does not know this otherwise.
  void plan_seen_anchors(std::vector<uav::SeenAnchor> seen) { planned_seen_ = std::move(seen); }
  /// Cameras of another kind measure depths of 2.5 m and labels 1.
  void set_camera_kind(uav::CameraKind kind);

  const Calls& calls() const { return calls_; }
  /// Every command applied since the last reset, in order.
  const std::vector<AppliedCommand>& applied() const { return applied_; }

  /// Every measurement expected since the last reset, in order.
  const std::vector<Expected>& expected() const { return expected_; }

  const World& world() const override { return world_; }
  StepGrid grid() const override { return grid_; }
  SimTime now() const override { return now_; }
  void reset(std::uint64_t seed) override;
  void advance_to(SimTime t) override;
  bool takes_setpoints() const override { return true; }
  /// Only velocities in the heading frame move a UAV; it stands still otherwise. Joints turn.
  void apply(std::size_t uav, const uav::Setpoint& setpoint) override;
  void capture(Snapshot& snapshot) const override;
  /// Camera: the bytes are a hash of (seed, instant, UAV, sensor, index), the first eight the
  /// instant itself. IMU: attitude, yaw rate, and gravity's reaction. Range: distance ahead to the
  /// plane x = 10 m.
  uav::Sample measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index) override;
  void expect(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
              std::uint64_t index) override {
    expected_.push_back({snapshot.at, uav, sensor, index});
  }
  GroundTruth ground_truth(std::size_t uav) const override;
  bool reports_contacts() const override { return planned_contacts_.has_value(); }
  std::optional<int> walls_between(std::size_t, std::size_t) override { return 0; }
  std::vector<Contact> take_contacts() override;
  /// To the plane x = 10 m, "wall", if contacts were planned.
  std::optional<Clearance> clearance(std::size_t uav) const override;
  /// Of UAVs of the world with a model of energy: as if they hovered.
  std::optional<energy::Status> battery(std::size_t uav) const override;
  void computing(std::size_t uav, double cores) override;
  std::string description() const override { return "fake simulator"; }

 private:
  struct Body {
    uav::Vec3 p_WB;
    double yaw_rad = 0.0;
    uav::VelocityCommand command;
    std::optional<energy::Meter> meter{};
  };

  void check_uav(std::size_t uav) const;
  void step();

  World world_;
  StepGrid grid_;
  SimTime now_{};
  std::uint64_t seed_ = 0;
  std::vector<Body> bodies_;
  JointDrives joints_;
  std::vector<AppliedCommand> applied_;
  std::vector<Expected> expected_;
  std::optional<std::vector<Contact>> planned_contacts_;
  std::optional<std::vector<uav::SeenAnchor>> planned_seen_;
  mutable Calls calls_;
  std::function<void(SimTime, SimTime)> on_advance_;
  std::function<void(std::size_t, std::size_t)> on_measure_;
};

/// The instant that an image of FakeSimulator carries in its bytes. @pre at least eight bytes.
SimTime instant_in_image(const uav::CameraSample& image);

}  // namespace tether::sim
