#include "controller_options.h"

#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/autopilot/external.h>
#include <tether/autopilot/flight_controller.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/sim_testing/fake_simulator.h>

namespace tether::runner {
namespace {

class WithoutSetpoints final : public sim::Simulator {
 public:
  const sim::World& world() const override { return own_.world(); }
  StepGrid grid() const override { return own_.grid(); }
  SimTime now() const override { return own_.now(); }
  void reset(std::uint64_t seed) override { own_.reset(seed); }
  void advance_to(SimTime t) override { own_.advance_to(t); }
  bool takes_setpoints() const override { return false; }
  void apply(std::size_t uav, const uav::Setpoint& setpoint) override { own_.apply(uav, setpoint); }
  void capture(sim::Snapshot& snapshot) const override { own_.capture(snapshot); }
  uav::Sample measure(const sim::Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index) override {
    return own_.measure(snapshot, uav, sensor, index);
  }
  sim::GroundTruth ground_truth(std::size_t uav) const override { return own_.ground_truth(uav); }
  bool reports_contacts() const override { return own_.reports_contacts(); }
  std::vector<sim::Contact> take_contacts() override { return own_.take_contacts(); }
  std::optional<sim::Clearance> clearance(std::size_t uav) const override {
    return own_.clearance(uav);
  }
  std::string description() const override { return own_.description(); }

 private:
  sim::FakeSimulator own_;
};

TEST(ControllerOptions, DescribesTheControllerAndItsLink) {
  const sim::FakeSimulator simulator(sim::make_fake_world(2));
  scenario::FlightController controller;
  controller.link_baud = 57'600.0;
  controller.link_latency = Duration(7);
  const auto options = controller_options(controller, simulator, 1, 1, {});
  EXPECT_EQ(options.name, "built-in");
  EXPECT_EQ(options.estimate, "truth") << "it has no odometry";
  EXPECT_EQ(options.period, autopilot::kBuiltInPeriod);
  EXPECT_EQ(options.link_baud, 57'600.0);
  EXPECT_EQ(options.link_latency, Duration(7));
  EXPECT_NE(options.make(), nullptr);
}

TEST(ControllerOptions, StepsAtAMultipleOfTheSimulatorsStep) {
  for (const auto& [step_us, period_us] :
       {std::pair{1'000, 4'000}, {3'000, 6'000}, {10'000, 10'000}}) {
    const sim::FakeSimulator simulator(sim::make_fake_world(1, std::chrono::microseconds(step_us)));
    EXPECT_EQ(controller_options({}, simulator, 0, 1, {}).period,
              std::chrono::microseconds(period_us));
  }
}

TEST(ControllerOptions, FliesOnAnOdometry) {
  sim::World world = sim::make_fake_world(1);
  world.uavs[0].sensors[1].name = "odometry";
  world.uavs[0].sensors[1].model = sim::OdometryModel{};
  EXPECT_EQ(controller_options({}, sim::FakeSimulator(world), 0, 1, {}).estimate, "odometry");
}

void expect_refused(const scenario::FlightController& controller, const sim::Simulator& simulator,
                    std::size_t uav, const std::string& reason) {
  const Error error =
      bad_file_error([&] { controller_options(controller, simulator, uav, 1, {}); });
  EXPECT_EQ(error.where().line, 12);
  EXPECT_EQ(error.subject(), "flight_controller");
  EXPECT_THAT(std::string(error.what()), testing::HasSubstr(reason));
}

TEST(ControllerOptions, IsRefusedWhereTheScenarioHasIt) {
  scenario::FlightController controller;
  controller.at = {"s.toml", 12};
  expect_refused(controller, WithoutSetpoints(), 0, "embedded one");
  controller.external = &autopilot::externals()[0];
  const sim::FakeSimulator simulator(sim::make_fake_world(11));
  expect_refused(controller, simulator, 10, "PX4 can fly the first 10 UAVs only");
  sim::World world = sim::make_fake_world(1);
  world.uavs[0].sensors.clear();
  expect_refused(controller, sim::FakeSimulator(world), 0, "PX4 needs an IMU");
}

TEST(ControllerOptions, DoNotRepeatIfAGroundStationMayCommand) {
  using autopilot::GroundStation;
  const sim::FakeSimulator simulator(sim::make_fake_world(1));
  for (const auto& [what, repeats] : {std::pair{GroundStation::kAbsent, true},
                                      {GroundStation::kLooks, true},
                                      {GroundStation::kCommands, false}}) {
    scenario::FlightController controller;
    controller.ground_station = what;
    controller.ground_station_port = autopilot::kGroundStationPort;
    const auto options = controller_options(controller, simulator, 0, 1, {});
    EXPECT_EQ(options.repeats, repeats);
    EXPECT_NE(options.make(), nullptr);
  }
}

TEST(ControllerOptions, SignTheLinkWithTheKeyOfTheScenario) {
  const sim::FakeSimulator simulator(sim::make_fake_world(1));
  scenario::FlightController controller;
  controller.signing_key = std::string(32, 'k');
  const auto made = controller_options(controller, simulator, 0, 1, {}).make();
  EXPECT_EQ(made->step({}, {{1, 2, 3}}).refused.size(), 1U);
}

TEST(ControllerOptions, DescribesOneThatTheUserBrings) {
  const sim::FakeSimulator simulator(sim::make_fake_world(1, std::chrono::microseconds(3'000)));
  for (const autopilot::External& kind : autopilot::externals()) {
    scenario::FlightController controller;
    controller.external = &kind;
    const auto options = controller_options(controller, simulator, 0, 1, {});
    EXPECT_EQ(options.name, kind.name);
    EXPECT_EQ(options.estimate, "its sensors");
    EXPECT_EQ(options.repeats, kind.repeats);
    EXPECT_EQ(options.period, std::chrono::milliseconds(kind.key == "px4" ? 6 : 3));
  }
}

}  // namespace
}  // namespace tether::runner
