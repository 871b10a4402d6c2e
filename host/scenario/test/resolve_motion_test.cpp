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

}  // namespace
}  // namespace tether::scenario
