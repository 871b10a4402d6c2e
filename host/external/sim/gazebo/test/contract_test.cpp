#include <memory>
#include <string>
#include <utility>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/sim_gazebo/gazebo_simulator.h>
#include <tether/sim_testing/simulator_contract.h>

/// Real Gazebo keeps what every back end promises.
namespace tether::sim::testing {
namespace {

// ---- A world of boxes as an SDF file
// ----------------------------------------------------------------

std::string text(const uav::Vec3& v) {
  return std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z);
}

std::string sdf_box(const Geometry& geometry) {
  return "<geometry><box><size>" + text(std::get<BoxGeometry>(geometry).size_m) +
         "</size></box></geometry>";
}

std::string sdf_inertial(const Link& link) {
  const uav::Vec3& i = link.inertia_kg_m2;
  return "<inertial><mass>" + std::to_string(link.mass_kg) + "</mass><inertia><ixx>" +
         std::to_string(i.x) + "</ixx><iyy>" + std::to_string(i.y) + "</iyy><izz>" +
         std::to_string(i.z) + "</izz></inertia></inertial>";
}

std::string sdf_model(const Model& model) {
  const Link& link = model.links.at(0);
  const uav::Vec3& rgb = link.visuals.at(0).material.diffuse_rgb;
  return "<model name='" + model.name + "'><static>" + (model.is_static ? "1" : "0") +
         "</static><pose>" + text(model.X_WM.p) + " 0 0 0</pose><link name='" + link.name + "'>" +
         sdf_inertial(link) + "<collision name='box'>" + sdf_box(link.collisions.at(0).geometry) +
         "</collision><visual name='box'>" + sdf_box(link.visuals.at(0).geometry) +
         "<material><ambient>" + text(rgb) + " 1</ambient><diffuse>" + text(rgb) +
         " 1</diffuse></material></visual></link></model>\n";
}

std::string sdf_world(const World& world) {
  std::string models;
  for (const Model& model : world.models) models += sdf_model(model);
  return "<sdf version='1.6'><world name='" + world.name +
         "'><physics name='p' type='ode'>"
         "<max_step_size>" +
         std::to_string(to_seconds(world.step)) + "</max_step_size></physics>\n" + models +
         "</world></sdf>\n";
}

// ---- Gazebo with it ----------------------------------------------------------------------------

struct InGazebo {
  ScratchFolder folder;
  std::unique_ptr<GazeboSimulator> running;
};

std::shared_ptr<Simulator> make_in_gazebo(World world) {
  auto gazebo = std::make_shared<InGazebo>();
  for (Model& model : world.models) model.links.at(0).name = "link";
  world.file = gazebo->folder.write("world.sdf", sdf_world(world));
  gazebo->running = std::make_unique<GazeboSimulator>(
      world, GazeboSetup{std::chrono::seconds(30), gazebo->folder.path("simulator.log"),
                         [](const Warning& warning) { ADD_FAILURE() << to_line(warning); }});
  Simulator& simulator = gazebo->running->get();
  return {std::move(gazebo), &simulator};
}

/// Skips all tests without Gazebo or its plugin.
class NeedsGazebo : public ::testing::Environment {
 public:
  void SetUp() override {
    try {
      (void)find_gazebo();
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
};
const auto* const kNeedsGazebo = ::testing::AddGlobalTestEnvironment(new NeedsGazebo);

}  // namespace

INSTANTIATE_TEST_SUITE_P(Gazebo, SimulatorContract,
                         ::testing::Values(SimulatorMaker(make_in_gazebo)));

}  // namespace tether::sim::testing
