#include "dynamics.h"
#include "image_maker.h"
#include "sensors.h"

#include <utility>

#include <tether/base/error.h>
#include <tether/sim_mujoco/mujoco_simulator.h>

namespace tether::sim {
namespace {

class MujocoSimulator final : public Simulator {
 public:
  MujocoSimulator(World world, WarningSink warn)
      : world_(std::move(world)),
        warn_(std::move(warn)),
        grid_(world_.step),
        dynamics_(world_, warn_),
        rays_(dynamics_),
        images_(world_, dynamics_, warn_) {}

  const World& world() const override { return world_; }
  StepGrid grid() const override { return grid_; }
  SimTime now() const override { return now_; }

  void reset(std::uint64_t seed) override {
    seed_ = seed;
    now_ = SimTime{};
    dynamics_.reset();
  }

  void advance_to(SimTime t) override {
    check_target(t);
    while (now_ < t) {
      dynamics_.step();
      now_ += grid_.dt();
    }
    warn_once_about_contacts();
  }

  void apply(std::size_t uav, const uav::VelocityCommand& command) override {
    check_uav(uav);
    dynamics_.set_command(uav, command);
  }

  void capture(Snapshot& snapshot) const override {
    snapshot.at = now_;
    dynamics_.capture(snapshot.state);
  }

  uav::Sample measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index) override {
    check_uav(uav);
    const Uav& carrier = world_.uavs[uav];
    if (sensor >= carrier.sensors.size()) {
      throw Error(ErrorCode::kInternal, "simulator: no sensor " + std::to_string(sensor));
    }
    const Sensor& description = carrier.sensors[sensor];
    const Request request{
        snapshot, uav, description, {seed_, carrier.name, description.name, index, snapshot.at}};
    return std::visit([&](const auto& model) { return measure(model, request); },
                      description.model);
  }

  GroundTruth ground_truth(std::size_t uav) const override {
    check_uav(uav);
    return {now_, dynamics_.body_state(uav)};
  }

  std::string description() const override {
    const std::string name = "MuJoCo " + engine_version();
    const std::string renderer = images_.renderer_name();
    return renderer.empty() ? name : name + ", " + renderer;
  }

 private:
  struct Request {
    const Snapshot& snapshot;
    std::size_t uav;
    const Sensor& sensor;
    MeasurementKey key;
  };

  uav::Sample measure(const ImuModel& imu, const Request& r) {
    return measure_imu(imu, r.sensor.X_BS, Dynamics::pose_of(r.snapshot.state, r.uav),
                       dynamics_.motion_of(r.snapshot.state, r.uav), world_.gravity_m_s2, r.key);
  }

  uav::Sample measure(const RangeModel& range, const Request& r) {
    const uav::Pose X_WS = Dynamics::pose_of(r.snapshot.state, r.uav) * r.sensor.X_BS;
    return measure_range(range, rays_.cast(r.snapshot.state, X_WS, range.rays_S, r.uav), r.key);
  }

  uav::Sample measure(const CameraModel& camera, const Request& r) {
    return images_.make(camera, {r.snapshot.state, r.uav, r.sensor, r.key});
  }

  void check_target(SimTime t) const {
    if (t < now_ || !grid_.contains(t)) {
      throw Error(ErrorCode::kInternal, "simulator: cannot advance from " +
                                            std::to_string(to_ns(now_)) + " ns to " +
                                            std::to_string(to_ns(t)) + " ns");
    }
  }

  void check_uav(std::size_t uav) const {
    if (uav >= world_.uavs.size()) {
      throw Error(ErrorCode::kInternal, "simulator: no UAV " + std::to_string(uav));
    }
  }

  void warn_once_about_contacts() {
    if (warned_ || !dynamics_.contacts_dropped()) return;
    warned_ = true;
    warn_("more contacts at once than the simulator keeps: some bodies pass through others");
  }

  World world_;
  WarningSink warn_;
  StepGrid grid_;
  Dynamics dynamics_;
  RayCaster rays_;
  ImageMaker images_;
  SimTime now_{};
  std::uint64_t seed_ = 0;
  bool warned_ = false;
};

}  // namespace

const bool kHasMujoco = true;

std::unique_ptr<Simulator> make_mujoco_simulator(World world, const WarningSink& warn) {
  return std::make_unique<MujocoSimulator>(std::move(world), warn);
}

}  // namespace tether::sim
