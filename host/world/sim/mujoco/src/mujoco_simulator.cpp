#include "collision_rays.h"
#include "dynamics.h"
#include "meshes/usable_meshes.h"
#include "renderer.h"
#include "scene.h"

#include <algorithm>
#include <utility>

#include <tether/base/error.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_sensing/sensor_suite.h>

namespace tether::sim {
namespace {

// A world, and what is made of it and the files that it names.
struct Parts {
  // Keeps the files of meshes only until all parts have read them.
  Parts(World read, const WarningSink& warn, const std::optional<FileCache>& cache,
        const MeshFiles& meshes = MeshFiles())
      : world(usable(std::move(read), meshes, warn)),
        dynamics(world, warn, meshes),
        scene(std::make_shared<const raster::Scene>(make_scene(world, warn, meshes, cache))) {}

  static World usable(World world, const MeshFiles& meshes, const WarningSink& warn) {
    leave_out_unusable_meshes(world, meshes, warn);
    split_collisions(world, meshes);
    return world;
  }

  World world;
  Dynamics dynamics;
  std::shared_ptr<const raster::Scene> scene;  // the renderers share it
};

SensorSuite::BackEnd back_end(const Parts& parts, RayCaster& rays, int threads_ahead) {
  const auto make_renderer = [scene = parts.scene](raster::Helpers* helpers) {
    return std::make_unique<Renderer>(scene, helpers);
  };
  return {rays, make_renderer, threads_ahead};
}

class MujocoSimulator final : public Simulator {
 public:
  MujocoSimulator(std::shared_ptr<Parts> parts, WarningSink warn, int threads_ahead)
      : parts_(std::move(parts)),
        warn_(printable_warnings(std::move(warn))),
        grid_(world_.step),
        rays_(dynamics_.model(), world_),
        sensors_(world_, back_end(*parts_, rays_, threads_ahead), warn_) {}

  const World& world() const override { return world_; }
  StepGrid grid() const override { return grid_; }
  SimTime now() const override { return now_; }

  void reset(std::uint64_t seed) override {
    sensors_.reset(seed);
    now_ = SimTime{};
    stepping_ = Duration(0);
    dynamics_.reset(seed);
  }

  void advance_to(SimTime t) override {
    check_target(t);
    const CpuTimer timer;
    while (now_ < t) {
      dynamics_.step();
      now_ += grid_.dt();
    }
    stepping_ += timer.elapsed();
    dynamics_.warn_of_falls(warn_);
    warn_once_about_contacts();
  }

  bool takes_setpoints() const override { return true; }
  void apply(std::size_t uav, const uav::Setpoint& setpoint) override {
    check_uav(uav);
    dynamics_.set_setpoint(uav, setpoint);
  }

  void capture(Snapshot& snapshot) const override {
    snapshot.at = now_;
    dynamics_.capture(snapshot.state);
  }

  uav::Sample measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index) override {
    return sensors_.measure(snapshot, uav, sensor, index);
  }

  void expect(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
              std::uint64_t index) override {
    sensors_.expect(snapshot, uav, sensor, index);
  }

  std::optional<SimulatorWork> work() const override {
    SimulatorWork work = sensors_.work();
    work.stepping = stepping_;
    return work;
  }

  GroundTruth ground_truth(std::size_t uav) const override {
    check_uav(uav);
    const auto joints_rad = dynamics_.joints_rad(uav);
    return {now_, dynamics_.body_state(uav), {joints_rad.begin(), joints_rad.end()}};
  }

  bool moves_by_forces() const override { return true; }
  bool reports_contacts() const override { return true; }
  std::vector<Contact> take_contacts() override { return dynamics_.contacts().take(); }
  std::optional<Clearance> clearance(std::size_t uav) const override {
    check_uav(uav);
    return dynamics_.clearance(uav);
  }

  std::optional<int> walls_between(std::size_t uav, std::size_t other) override {
    check_uav(std::max(uav, other));
    capture(between_);
    return sensors_.walls_between(between_, uav, other);
  }

  std::optional<energy::Status> battery(std::size_t uav) const override {
    check_uav(uav);
    return dynamics_.battery(uav);
  }
  void computing(std::size_t uav, double cores) override {
    check_uav(uav);
    dynamics_.computing(uav, cores);
  }

  std::string description() const override {
    const std::string name = "MuJoCo " + engine_version();
    const std::string renderer = sensors_.renderer_name();
    return renderer.empty() ? name : name + ", " + renderer;
  }

 private:
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
    warn_({Consequence::kBehavesDifferent,
           {},
           "contacts",
           "are more at once than the simulator keeps; some bodies pass through others"});
  }

  std::shared_ptr<Parts> parts_;
  const World& world_ = parts_->world;
  Dynamics& dynamics_ = parts_->dynamics;
  WarningSink warn_;
  StepGrid grid_;
  CollisionRays rays_;
  SensorSuite sensors_;
  Snapshot between_;  // reused
  SimTime now_{};
  Duration stepping_{0};
  bool warned_ = false;
};

}  // namespace

const bool kHasMujoco = true;

MakeMujocoSimulator prepare_mujoco_simulator(World world, const WarningSink& warn,
                                             const std::optional<FileCache>& cache) {
  const FileLocation file{world.file.string()};
  try {
    // Shared, because a std::function must be copyable.
    const auto parts = std::make_shared<Parts>(std::move(world), printable_warnings(warn), cache);
    return [parts](const WarningSink& warn_later, int threads_ahead) {
      return std::make_unique<MujocoSimulator>(parts, warn_later, threads_ahead);
    };
  } catch (const Error& e) {
    if (e.code() != ErrorCode::kBadFile || !e.where().file.empty() || file.file.empty()) throw;
    throw Error(ErrorCode::kBadFile, file, e.what()).about(e.subject());
  }
}

}  // namespace tether::sim
