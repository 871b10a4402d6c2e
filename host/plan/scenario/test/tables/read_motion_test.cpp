#include "tables/read_motion.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/units.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::scenario {
namespace {

using ::testing::HasSubstr;

Scenario motion_of(const std::string& text) {
  Scenario scenario;
  scenario.time_limit = std::chrono::seconds(10);
  read_motion(toml::Document::parse(text, "s.toml").root(), scenario);
  return scenario;
}

constexpr const char* kMoving = R"([[moving]]
model = "cart"
repeats = true
waypoint = [ { at_s = 0, offset_m = [0, 0, 0] },
             { at_s = 2.5, offset_m = [1, 2, 0], yaw_deg = 180 },
             { at_s = 4, offset_m = [0, 0, 0], yaw_deg = 360 } ]
)";

TEST(ReadMotion, ReadsWindAndPaths) {
  const Scenario scenario = motion_of(std::string(kMoving) +
                                      "[wind]\nvelocity_m_s = [3, -1, 0]\nroughness_m = 0.1\n"
                                      "turbulence = 0.5\n");
  EXPECT_EQ(*scenario.wind, (uav::Wind{{3.0, -1.0, 0.0}, 0.1, 0.5}));
  ASSERT_EQ(scenario.moving.size(), 1U);
  EXPECT_EQ(scenario.moving[0].model, "cart");
  EXPECT_TRUE(scenario.moving[0].path.repeats);
  EXPECT_EQ(scenario.moving[0].path.waypoints[1],
            (uav::Waypoint{std::chrono::milliseconds(2500), {1, 2, 0}, rad_from_deg(180.0)}));
}

TEST(ReadMotion, ReadsPayloads) {
  const auto payloads = motion_of(
                            "[[payload]]\nmass_kg = 0.2\nfrom_s = 1.5\nuntil_s = 3\n"
                            "[[payload]]\nuav = \"beta\"\nmass_kg = 0.1\n")
                            .payloads;
  ASSERT_EQ(payloads.size(), 2U);
  EXPECT_EQ(payloads[0].payload.from, SimTime(std::chrono::milliseconds(1500)));
  EXPECT_EQ(payloads[0].payload.until, SimTime(std::chrono::seconds(3)));
  EXPECT_EQ(payloads[1].uav, "beta");
  EXPECT_EQ(payloads[1].payload.until, SimTime::max());
}

TEST(ReadMotion, RefusesWhatCannotMove) {
  const auto problem = [](const std::string& text) -> std::string {
    return bad_file_error([&] { motion_of(text); }).what();
  };
  const std::string start = "[[moving]]\nmodel = \"cart\"\nwaypoint = [ { at_s = 1, ";
  EXPECT_THAT(problem(start + "offset_m = [0, 0, 0] } ]"), HasSubstr("two waypoints"));
  EXPECT_THAT(problem(start + "offset_m = [0, 0, 0] }, { at_s = 1.001, offset_m = [5, 0, 0] } ]"),
              HasSubstr("goes from its waypoint at 1.000 s to the next one faster than 100 m/s"));
  EXPECT_THAT(problem(start + "offset_m = [0, 0] } ]"), HasSubstr("offset_m"));
  EXPECT_THAT(problem(start + "offset_m = [nan, 0, 0] } ]"), HasSubstr("offset_m"));
  EXPECT_THAT(problem(std::string(kMoving) + kMoving), HasSubstr("another [[moving]]"));
  EXPECT_THAT(problem("[wind]\nvelocity_m_s = [0, 0, 1]\nturbulence = 1"),
              HasSubstr("no effect without a wind"));
  EXPECT_THAT(problem("[[payload]]\nmass_kg = 0"), HasSubstr("mass_kg"));
  EXPECT_THAT(problem("[[payload]]\nmass_kg = 1\nfrom_s = 2\nuntil_s = 2"), HasSubstr("until_s"));
  EXPECT_THAT(problem("[[payload]]\nmass_kg = 1\nfrom_s = 10"),
              HasSubstr("the flight ends at 'time_limit_s' = 10"));
  EXPECT_THAT(problem("[wind]\nvelocity_m_s = [100, 0, 0]"), HasSubstr("velocity_m_s"));
}

}  // namespace
}  // namespace tether::scenario
