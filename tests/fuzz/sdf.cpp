#include "fuzz_target.h"

#include <cmath>
#include <memory>
#include <utility>

#include <tether/sim/simulator.h>
#include <tether/sim/world.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_sdf/load_world.h>

/// SDF to the scene that back ends get, and on to the embedded simulator's model of it, which flies
/// some steps. Input: a world's file where it has a <world>, URDF where it has a <robot>, else a
/// UAV's file; it may include the other files of its folder and name its meshes.
namespace tether::fuzz {
namespace {

constexpr const char* kWorld = "<sdf version='1.7'><world name='w'/></sdf>";
constexpr const char* kRobot = R"(<sdf version='1.7'><world name='w'><include>
<uri>input.urdf</uri></include></world></sdf>)";
constexpr const char* kBox = R"(<sdf version='1.7'><model name='box'><link name='link'>
<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>
</link></model></sdf>)";

/// A tetrahedron, with a submesh of its own.
constexpr const char* kMesh = R"(o tetra
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 2 3 4
f 3 1 4
o card
v 0 0 2
v 1 0 2
v 0 1 2
f 5 6 7
)";
constexpr int kSteps = 5;

bool is_finite(const uav::Vec3& v) {
  return std::isfinite(std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
}

bool is_finite(const uav::Pose& X) {
  double sum = 0.0;
  for (const double x : {X.p.x, X.p.y, X.p.z, X.q.w, X.q.x, X.q.y, X.q.z}) sum += std::abs(x);
  return std::isfinite(sum);
}

void require_whole(const sim::Link& link) {
  require(link.mass_kg > 0.0 && std::isfinite(link.mass_kg), "a bad mass");
  require(is_finite(link.X_ML) && is_finite(link.X_LI), "a link that is nowhere");
  for (const sim::Visual& visual : link.visuals) require(is_finite(visual.X_LV), "nowhere");
  for (const sim::Collision& collision : link.collisions)
    require(is_finite(collision.X_LC) && std::isfinite(collision.friction), "nowhere");
}

/// What world.h promises.
void require_whole(const sim::World& world) {
  require(world.step > Duration(0) && std::isfinite(world.gravity_m_s2), "a bad step or gravity");
  for (const sim::Model& model : world.models) {
    require(is_finite(model.X_WM), "a model that is nowhere");
    for (const sim::Link& link : model.links) require_whole(link);
  }
  for (const sim::Light& light : world.lights) require(is_finite(light.X_WL), "nowhere");
  for (const sim::Uav& uav : world.uavs) {
    require_whole(uav.body);
    require(!uav.airframe.rotors.empty(), "a multirotor without rotors");
    for (const sim::Sensor& sensor : uav.sensors) require(is_finite(sensor.X_BS), "nowhere");
    (void)sim::make_catalogue(world, uav);
  }
  for (const auto& file : world.files)
    require(std::filesystem::is_regular_file(file), "a file that is not there");
}

void require_sound(const uav::Sample& sample) {
  if (const auto* imu = std::get_if<uav::ImuSample>(&sample)) {
    require(is_finite(imu->angular_velocity_rad_s) && is_finite(imu->specific_force_m_s2) &&
                is_finite(uav::Pose{{}, imu->q_WS}),
            "an IMU that measures no numbers");
  } else if (const auto* range = std::get_if<uav::RangeSample>(&sample)) {
    require(!std::isnan(range->range_m), "a distance that is no number");
  } else if (const auto* scan = std::get_if<uav::ScanSample>(&sample)) {
    for (const float range_m : scan->ranges_m)
      require(!std::isnan(range_m), "a distance that is no number");
  } else if (const auto* odometry = std::get_if<uav::OdometrySample>(&sample)) {
    require(is_finite(uav::Pose{odometry->p_WS, odometry->q_WS}) && is_finite(odometry->v_WS_m_s),
            "an odometry that is nowhere");
  } else if (const auto* navsat = std::get_if<uav::NavSatSample>(&sample)) {
    require(!navsat->has_fix || std::isfinite(navsat->altitude_m), "a fix that is nowhere");
  }
}

/// What simulator.h promises of every instant. Images are left out: one takes longer than all the
/// rest. The targets `mesh` and `texture` draw.
void require_sound(sim::Simulator& simulator) {
  sim::Snapshot snapshot;
  simulator.capture(snapshot);
  for (const double x : snapshot.state) require(std::isfinite(x), "a state without numbers");
  const auto& uavs = simulator.world().uavs;
  for (std::size_t i = 0; i < uavs.size(); ++i) {
    const uav::BodyState body = simulator.ground_truth(i).body;
    require(is_finite(uav::Pose{body.p_WB, body.q_WB}) && is_finite(body.v_WB) &&
                is_finite(body.w_WB_B),
            "a UAV that is nowhere");
    for (std::size_t k = 0; k < uavs[i].sensors.size(); ++k) {
      if (uavs[i].sensors[k].kind() == uav::SensorKind::kCamera) continue;
      require_sound(simulator.measure(snapshot, i, k, 0));
    }
  }
}

void fly(sim::Simulator& simulator) {
  require_sound(simulator);
  for (std::size_t i = 0; i < simulator.world().uavs.size(); ++i)
    simulator.apply(i, uav::to_setpoint({{1.0, 0.5, 0.2}, 1.0}));
  simulator.advance_to(SimTime{} + kSteps * simulator.grid().dt());
  require_sound(simulator);
  simulator.reset(1);
  require_sound(simulator);
}

sim::WorldRequest request(const InputFolder& folder, Bytes input) {
  const std::string text = text_of(input);
  if (text.find("<world") != std::string::npos) return {folder.write("input.sdf", text), {}, {}};
  if (text.find("<robot") != std::string::npos) {
    folder.write("input.urdf", text);
    return {folder.path() / "robot.sdf", {}, {}};
  }
  return {folder.path() / "world.sdf", {{"uav", folder.write("input.sdf", text), {}, 0.5}}, {}};
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::InputFolder folder;
  static const auto written = {folder.write("world.sdf", std::string_view(fuzz::kWorld)),
                               folder.write("robot.sdf", std::string_view(fuzz::kRobot)),
                               folder.write("models/box/model.sdf", std::string_view(fuzz::kBox)),
                               folder.write("tetra.obj", std::string_view(fuzz::kMesh))};
  (void)written;
  fuzz::require(sim::kHasMujoco, "a build without the embedded simulator");
  const sim::WorldRequest request = fuzz::request(folder, {data, size});
  const auto warn = [](const Warning& warning) { fuzz::require_one_line(to_line(warning)); };
  auto world = fuzz::read_or_refuse([&] { return sim::load_world(request, warn); });
  if (!world) return 0;
  fuzz::require_whole(*world);
  const auto made =
      fuzz::read_or_refuse([&] { return sim::make_mujoco_simulator(std::move(*world), warn); });
  // A motion may become too wild for the engine, which says so.
  if (made) {
    (void)fuzz::read_or_refuse([&] { return fuzz::fly(**made), true; }, {ErrorCode::kSetup});
  }
  return 0;
}
