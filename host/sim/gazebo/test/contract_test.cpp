#include <memory>
#include <string>
#include <utility>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/sim_gazebo/gazebo_install.h>
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

// ---- Gazebo in it
// -----------------------------------------------------------------------------------

/// With all that it runs on.
class InGazebo final : public Simulator {
 public:
  explicit InGazebo(World world) {
    for (Model& model : world.models) model.links.at(0).name = "link";
    world.file = folder_.write("world.sdf", sdf_world(world));
    running_ = std::make_unique<GazeboSimulator>(
        world, GazeboSetup{std::chrono::seconds(30), folder_.path("simulator.log"),
                           [](const std::string& line) { ADD_FAILURE() << line; }});
  }

  const World& world() const override { return it().world(); }
  StepGrid grid() const override { return it().grid(); }
  SimTime now() const override { return it().now(); }
  void reset(std::uint64_t seed) override { it().reset(seed); }
  void advance_to(SimTime t) override { it().advance_to(t); }
  void apply(std::size_t uav, const uav::VelocityCommand& command) override {
    it().apply(uav, command);
  }
  void capture(Snapshot& snapshot) const override { it().capture(snapshot); }
  uav::Sample measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index) override {
    return it().measure(snapshot, uav, sensor, index);
  }
  GroundTruth ground_truth(std::size_t uav) const override { return it().ground_truth(uav); }
  std::string description() const override { return it().description(); }

 private:
  Simulator& it() const { return running_->get(); }

  ScratchFolder folder_;
  std::unique_ptr<GazeboSimulator> running_;
};

/// Skips all tests where there is no Gazebo or no plugin.
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
                         ::testing::Values(SimulatorMaker([](World world) {
                           return std::make_unique<InGazebo>(std::move(world));
                         })));

}  // namespace tether::sim::testing
