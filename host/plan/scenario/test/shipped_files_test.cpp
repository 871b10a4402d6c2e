// Every scenario, campaign, profile and target in the repository loads, with the expected timings.

#include "sensor_world.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/scenario/campaign.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::scenario {
namespace {

template <class Load>
void expect_named_as_their_files(const std::string& folder, const Load& load) {
  int files = 0;
  const auto path = std::filesystem::path(TETHER_SOURCE_DIR) / "data" / folder;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_EQ(load(entry.path()).name, entry.path().stem());
    ++files;
  }
  EXPECT_GT(files, 0) << folder;
}

TEST(ShippedFiles, LoadAndAreNamedAsTheirFiles) {
  expect_named_as_their_files("scenarios", [](const auto& file) { return load_scenario(file); });
  expect_named_as_their_files("campaigns", load_campaign);
  expect_named_as_their_files("profiles", load_profile);
  expect_named_as_their_files("profiles/targets", load_target);
}

std::filesystem::path source(const std::string& file) {
  return std::filesystem::path(TETHER_SOURCE_DIR) / "data" / file;
}

// Copies of a flight count once, however many seeds are flown.
TEST(ShippedFiles, NoTwoSeedsOfAScenarioAreCopies) {
  for (const auto& entry : std::filesystem::directory_iterator(source("scenarios"))) {
    const Scenario scenario = load_scenario(entry.path());
    const bool has_spread = std::ranges::any_of(
        scenario.uavs, [](const UavSetup& uav) { return uav.yaw_spread_rad > 0.0; });
    const bool varies = std::ranges::any_of(scenario.variations, [](const Variation& variation) {
      return !std::holds_alternative<OneOf>(variation.distribution);
    });
    EXPECT_TRUE(has_spread || varies) << scenario.name;
  }
}

/// A bare world with the scenario's UAV, and its timings after all layers, as "33333333 + 0,
/// 37400000 ns late". No warning is expected. The shipped worlds:
/// host/world/sim/sdf/test/project_worlds_test.cpp.
struct Resolved {
  sim::World world;
  std::vector<std::string> timings;  ///< camera, imu, range

  const auto& model(std::size_t index) const { return world.uavs.at(0).sensors.at(index).model; }
};

std::string text_of(const uav::SensorTiming& timing) {
  const auto delay = [](const uav::Delay& d) {
    return ", " + std::to_string(std::get<uav::ConstantDelay>(d).value.count()) + " ns late";
  };
  const auto* periodic = std::get_if<uav::PeriodicTiming>(&timing);
  if (!periodic) return "on demand" + delay(std::get<uav::OnDemandTiming>(timing).delay);
  return std::to_string(periodic->period.count()) + " + " +
         std::to_string(periodic->phase.count()) + delay(periodic->delay);
}

Resolved resolved(const Scenario& scenario) {
  const auto no_warning = [](const Warning& warning) { ADD_FAILURE() << to_line(warning); };
  const ScratchFolder folder;
  sim::WorldRequest request = world_request(scenario, 1);
  request.world = folder.write("w.sdf", "<sdf version='1.7'><world name='w'/></sdf>");
  request.anchors.clear();
  Resolved result{sim::load_world(request, no_warning), {}};
  const auto timings =
      resolve_sensors(scenario, scenario.conditions.front(), result.world, no_warning);
  for (const uav::SensorTiming& timing : timings.at(0)) result.timings.push_back(text_of(timing));
  return result;
}

TEST(ShippedFiles, EveryScenarioHasTheTimingsOfItsTask) {
  using Texts = std::vector<std::string>;
  const std::string imu = "50000000 + 0, 0 ns late";
  const Texts streaming = {"33333333 + 0, 37400000 ns late", imu, "33333333 + 0, 0 ns late"};
  const Texts on_demand = {"on demand, 37400000 ns late", imu, "on demand, 97700000 ns late"};
  const auto timings = [](const std::string& name) {
    return resolved(load_scenario(source("scenarios/" + name + ".toml"))).timings;
  };
  for (const char* name :
       {"closed_path", "face_anchor", "mission", "move_forward", "relative_position"})
    EXPECT_EQ(timings(name), streaming) << name;
  EXPECT_EQ(timings("sensor_characterization"), on_demand);
}

// Else no computer is too slow for it. The characterization measures sensors, not a computer.
TEST(ShippedFiles, EveryScenarioLimitsItsTimeOrWhatDependsOnIt) {
  for (const auto& entry : std::filesystem::directory_iterator(source("scenarios"))) {
    const Scenario scenario = load_scenario(entry.path());
    if (scenario.name == "sensor_characterization") continue;
    const bool has_mission = std::ranges::any_of(
        scenario.uavs, [](const UavSetup& uav) { return uav.sut.mission.has_value(); });
    const bool has_limit = std::ranges::any_of(scenario.metrics, [](const Metric& metric) {
      return metric.max && (metric.kind == "time_required" || metric.kind == "abeam_error");
    });
    EXPECT_TRUE(has_mission || has_limit) << scenario.name;
  }
}

TEST(ShippedFiles, TheIdealProfileLeavesNoErrorAndNoDelay) {
  Scenario scenario = load_scenario(source("scenarios/sensor_characterization.toml"));
  lay_profile(scenario, load_profile(source("profiles/ideal.toml")));
  const Resolved r = resolved(scenario);
  EXPECT_THAT(r.timings, testing::ElementsAre("on demand, 0 ns late", "50000000 + 0, 0 ns late",
                                              "on demand, 0 ns late"));
  const auto none = testing::Each(0.0);
  const auto& camera = std::get<sim::CameraModel>(r.model(0));
  EXPECT_THAT(values_of(camera.pixel_noise), none);
  EXPECT_EQ(camera.exposure_s + camera.readout_s, 0.0);
  EXPECT_FALSE(camera.intrinsics.has_distortion());
  const auto& imu = std::get<sim::ImuModel>(r.model(1));
  for (const auto& noise : imu.angular_velocity) EXPECT_THAT(values_of(noise), none);
  for (const auto& noise : imu.linear_acceleration) EXPECT_THAT(values_of(noise), none);
  const auto& range = std::get<sim::RangeModel>(r.model(2));
  EXPECT_THAT(values_of(range.noise), none);
  EXPECT_EQ(range.resolution_m, 0.0);
  EXPECT_EQ(range.dropout_probability, 0.0);
  EXPECT_EQ(range.rays_S.size(), 1u);
}

}  // namespace
}  // namespace tether::scenario
