#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using ::testing::HasSubstr;

Scenario moving_cart() {
  Scenario scenario;
  scenario.moving = {
      {"cart", {{{{}, {}, 0.0}, {std::chrono::seconds(1), {1, 0, 0}, 0.0}}}, {"s.toml", 7}}};
  return scenario;
}

sim::World house_and_cart() {
  sim::World world;
  world.models = {{"cart", {}, true, {{}}}, {"house", {}, true, {}}, {"house::door", {}, true, {}}};
  return world;
}

TEST(ResolveMotion, DrivesTheNamedModelAndWhatIsNestedInIt) {
  sim::World driven = house_and_cart();
  driven.models[2].name = "cart::load";
  resolve_motion(moving_cart(), false, driven);
  EXPECT_FALSE(driven.models[0].is_static);
  EXPECT_TRUE(driven.models[0].path.has_value());
  EXPECT_TRUE(driven.models[1].is_static);
  EXPECT_TRUE(driven.models[2].path.has_value()) << "nested";
}

TEST(ResolveMotion, RefusesAModelThatItCannotDrive) {
  const auto problem = [](Scenario scenario, const std::string& model,
                          bool is_read_elsewhere) -> std::string {
    sim::World of_file = house_and_cart();
    scenario.moving[0].model = model;
    return bad_file_error([&] { resolve_motion(scenario, is_read_elsewhere, of_file); }).what();
  };
  EXPECT_THAT(problem(moving_cart(), "kart", false), HasSubstr("did you mean 'cart'"));
  EXPECT_THAT(problem(moving_cart(), "cart", true), HasSubstr("embedded simulator"));
}

TEST(ResolveMotion, LoadsTheNamedUavOrTheOnlyOne) {
  sim::World world;
  world.uavs.resize(2);
  world.uavs[0].name = "alpha";
  world.uavs[1].name = "beta";
  Scenario scenario;
  scenario.payloads = {{.uav = "beta", .payload = {.mass_kg = 0.2}}};
  resolve_motion(scenario, false, world);
  EXPECT_TRUE(world.uavs[0].payloads.empty());
  EXPECT_EQ(world.uavs[1].payloads.at(0).mass_kg, 0.2);
  const auto problem = [&](const std::string& uav, bool is_read_elsewhere) -> std::string {
    scenario.payloads[0].uav = uav;
    return bad_file_error([&] { resolve_motion(scenario, is_read_elsewhere, world); }).what();
  };
  EXPECT_THAT(problem("bta", false), HasSubstr("did you mean 'beta'"));
  EXPECT_THAT(problem("", false), HasSubstr("Add 'uav'"));
  EXPECT_THAT(problem("beta", true), HasSubstr("embedded simulator"));
  world.uavs.resize(1);
  scenario.payloads[0].uav = "";
  resolve_motion(scenario, false, world);
  EXPECT_EQ(world.uavs[0].payloads.size(), 1u);
}

// 4 rotors of 5 N each lift 2 kg; of what the controller does not know, it holds 0.2 kg, as much as
// accelerates 1 kg by 2 m/s^2.
TEST(ResolveWorld, RefusesPayloadsThatTheRotorsCannotLiftAndWarnsOfThoseThatSink) {
  sim::World world;
  world.uavs.resize(1);
  world.uavs[0].name = "alpha";
  uav::MultirotorParameters& airframe = world.uavs[0].airframe;
  airframe.mass_kg = 1.0;
  airframe.rotors.resize(4);
  airframe.thrust_coefficient = 5.0 / (100.0 * 100.0);
  airframe.max_rotor_speed_rad_s = 100.0;
  std::vector<std::string> warnings;
  Scenario scenario;
  scenario.uavs.resize(1);
  scenario.uavs[0].placement.name = "alpha";
  const auto resolve = [&](std::vector<sim::Payload> payloads) {
    scenario.payloads.clear();
    for (const sim::Payload& payload : payloads)
      scenario.payloads.push_back({.uav = "alpha", .payload = payload, .at = {"s.toml", 7}});
    sim::World flown = world;
    resolve_world(scenario, {}, 1, false, flown,
                  [&](const Warning& warning) { warnings.push_back(warning.message); });
  };
  const auto second = [](int s) { return SimTime(std::chrono::seconds(s)); };
  EXPECT_NO_THROW(resolve({{0.2, second(0), second(2)}, {0.2, second(2), second(3)}}));
  EXPECT_THAT(warnings, testing::Not(testing::Contains(HasSubstr("sink"))));
  EXPECT_NO_THROW(resolve({{0.6, second(0), second(2)}, {0.6, second(2), second(3)}}));
  EXPECT_THAT(warnings, testing::Contains(HasSubstr("it carries 0.6 kg, and its controller, which "
                                                    "does not know of them, holds the height with "
                                                    "at most 0.204 kg")));
  const Error error = bad_file_error([&] {
    resolve({{0.6, second(0), second(2)}, {0.6, second(1), second(3)}});
  });
  EXPECT_THAT(error.what(), HasSubstr("too heavy to fly: it weighs 21.6 N (2.2 kg)"));
  EXPECT_EQ(error.where().line, 7);
}

}  // namespace
}  // namespace tether::scenario
