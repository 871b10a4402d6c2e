#include "dynamics.h"
#include "image_warp.h"
#include "renderer.h"
#include "sensor_noise.h"
#include "sensors.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <tether/base/error.h>
#include <tether/sim_mujoco/mujoco_simulator.h>

namespace tether::sim {
namespace {

// One camera of the world: what must be rendered for it, and how its image comes out of that.
struct CameraPlan {
  uav::CameraModel rendered;
  std::optional<ImageWarp> warp;

  explicit CameraPlan(const uav::CameraModel& camera) : rendered(camera) {
    if (!ImageWarp::is_needed(camera)) return;
    warp.emplace(camera);
    rendered = warp->source();
  }
};

class MujocoSimulator final : public Simulator {
 public:
  MujocoSimulator(World world, WarningSink warn)
      : world_(std::move(world)),
        warn_(std::move(warn)),
        grid_(world_.step),
        bodies_(moving_bodies(world_).size()),
        dynamics_(world_, warn_),
        rays_(dynamics_),
        scene_(make_scene(world_, warn_)) {}

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
    return renderer_ ? name + ", " + renderer_->name() : name;
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
    return measure_range(range, rays_.cast(r.snapshot.state, X_WS, r.uav), r.key);
  }

  uav::Sample measure(const CameraModel& camera, const Request& r) {
    const CameraPlan& plan = plan_of(r.sensor, camera);
    const RawImage& raw = renderer().render(
        {plan.rendered, camera.near_m, camera.far_m, poses(r) * r.sensor.X_BS, poses_, r.uav});
    const auto width = static_cast<std::size_t>(camera.intrinsics.width_px);
    const auto height = static_cast<std::size_t>(camera.intrinsics.height_px);
    uav::CameraSample sample{r.key.at, r.key.index, camera.intrinsics.width_px,
                             camera.intrinsics.height_px,
                             std::vector<std::uint8_t>(width * height * 3)};
    if (plan.warp) {
      plan.warp->apply(raw, sample.rgb);
    } else {
      convert_to_rgb(raw, sample.rgb);
    }
    const std::uint64_t stream = random_stream(r.key.uav, r.key.sensor, "pixels");
    add_pixel_noise(camera.pixel_noise, {r.key.seed, stream, r.key.index, r.key.at}, sample.rgb);
    return sample;
  }

  // Fills `poses_` from the snapshot; returns the UAV's own.
  const uav::Pose& poses(const Request& r) {
    poses_.resize(bodies_);
    for (std::size_t i = 0; i < bodies_; ++i) {
      poses_[i] = Dynamics::pose_of(r.snapshot.state, i);
    }
    return poses_[r.uav];
  }

  const CameraPlan& plan_of(const Sensor& sensor, const CameraModel& camera) {
    return plans_.try_emplace(&sensor, camera.intrinsics).first->second;
  }

  // Made at the first image, large enough for every camera of the world.
  Renderer& renderer() {
    if (renderer_) return *renderer_;
    int width_px = 1;
    int height_px = 1;
    for (const Uav& uav : world_.uavs) {
      for (const Sensor& sensor : uav.sensors) {
        const auto* camera = std::get_if<CameraModel>(&sensor.model);
        if (!camera) continue;
        const CameraPlan& plan = plan_of(sensor, *camera);
        width_px = std::max(width_px, plan.rendered.width_px);
        height_px = std::max(height_px, plan.rendered.height_px);
      }
    }
    renderer_.emplace(std::move(scene_), width_px, height_px);
    return *renderer_;
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
  std::size_t bodies_;
  Dynamics dynamics_;
  RayCaster rays_;
  Scene scene_;  // until the renderer takes it
  std::map<const Sensor*, CameraPlan> plans_;
  std::optional<Renderer> renderer_;
  std::vector<uav::Pose> poses_;
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
