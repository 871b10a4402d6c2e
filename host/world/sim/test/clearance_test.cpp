#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sim/bodies.h>
#include <tether/sim/contacts.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::box_model;
using testing::test_uav;
using testing::test_world;
using uav::Vec3;

// The UAV is 0.4 × 0.4 × 0.1 m.
World world_at(const Vec3& p_WB) {
  World world = test_world();
  world.uavs[0].X_WB.p = p_WB;
  return world;
}

World with_collision(Geometry geometry) {
  World world = world_at({0.0, 0.0, 1.0});
  world.models[0].links[0].collisions[0].geometry = std::move(geometry);
  return world;
}

World with_second_uav() {
  World world = world_at({0.0, 0.0, 5.0});
  world.uavs.push_back(test_uav("beta", {1.0, 0.0, 5.0}));
  return world;
}

struct MeterCase {
  std::string name;
  World world;
  std::optional<double> distance_m;
  std::string to;
};

class ClearanceMeterTest : public ::testing::TestWithParam<MeterCase> {};

TEST_P(ClearanceMeterTest, MeasuresToTheNearest) {
  const MeterCase& c = GetParam();
  std::vector<uav::Pose> X_WB;
  for (const MovingBody& body : moving_bodies(c.world)) X_WB.push_back(body.X_WB);
  const auto clearance = ClearanceMeter(c.world, {}).measure(0, X_WB);
  ASSERT_EQ(clearance.has_value(), c.distance_m.has_value());
  if (!clearance) return;
  EXPECT_NEAR(clearance->distance_m, *c.distance_m, 1e-5);
  EXPECT_EQ(clearance->to, c.to);
}

World without_models() {
  World world = test_world();
  world.models.clear();
  return world;
}

World with_bits_of_floor(std::uint32_t bits) {
  World world = world_at({0.0, 0.0, 1.0});
  world.models[0].links[0].collisions[0].bits = bits;
  return world;
}

const std::vector<MeterCase> kMeterCases = {
    {"Floor", world_at({0.0, 0.0, 1.0}), 0.95, "floor"},
    {"InTheFloor", world_at({0.0, 0.0, 0.0}), 0.0, "floor"},
    {"Plane", with_collision(PlaneGeometry{{0.0, 0.0, 2.0}, 1.0, 1.0}), 1.0, "floor"},
    {"BelowAPlane", with_collision(PlaneGeometry{{0.0, 0.0, -1.0}, 1.0, 1.0}), 0.0, "floor"},
    {"AnotherUav", with_second_uav(), 0.6, "beta"},
    {"UnknownMesh", with_collision(MeshGeometry{}), std::nullopt, ""},
    {"OneBitInCommon", with_bits_of_floor(0x10100), 0.95, "floor"},
    {"NoBitInCommon", with_bits_of_floor(0x10000), std::nullopt, ""},
    {"NothingElse", without_models(), std::nullopt, ""},
};

INSTANTIATE_TEST_SUITE_P(Worlds, ClearanceMeterTest, ::testing::ValuesIn(kMeterCases),
                         [](const auto& named) { return named.param.name; });

// Also if they have moved since the meter was last used.
TEST(ClearanceMeter, InAFleetTheNearestIsThatOfAllPairs) {
  KeyedRandom random({.seed = 7});
  const auto place_m = [&] { return 4.0 * random.uniform() - 2.0; };
  World fleet = test_world();
  fleet.uavs.clear();
  for (int i = 0; i < 20; ++i)
    fleet.uavs.push_back(test_uav("uav" + std::to_string(i), {place_m(), place_m(), 3.0}));
  std::vector<uav::Pose> X_WB;
  for (const MovingBody& body : moving_bodies(fleet)) X_WB.push_back(body.X_WB);
  const ClearanceMeter meter(fleet, {});
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < fleet.uavs.size(); ++i) {
      std::pair<double, std::size_t> nearest{1e9, 0};
      for (std::size_t k = 0; k < fleet.uavs.size(); ++k) {
        if (k == i) continue;
        World pair = fleet;
        pair.uavs = {fleet.uavs[i], fleet.uavs[k]};
        const auto clearance = ClearanceMeter(pair, {}).measure(0, std::vector{X_WB[i], X_WB[k]});
        nearest = std::min(nearest, {clearance->distance_m, k});
      }
      const auto clearance = meter.measure(i, X_WB);
      EXPECT_EQ(clearance->distance_m, nearest.first);
      EXPECT_EQ(clearance->to, fleet.uavs[nearest.second].name);
    }
    for (uav::Pose& X : X_WB) X.p = {place_m(), place_m(), 3.0};
  }
}

TEST(ClearanceMeter, AMeshIsItsConvexHull) {
  const World world = with_collision(MeshGeometry{});
  const auto vertices = [](const MeshGeometry&) {
    return std::vector<Vec3>{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, 0.45}};
  };
  const std::vector<uav::Pose> X_WB{world.uavs[0].X_WB};
  EXPECT_NEAR(ClearanceMeter(world, vertices).measure(0, X_WB)->distance_m, 0.55, 1e-5);
}

struct StartCase {
  std::string name;
  Vec3 p_WB;
  std::vector<std::string> said;  ///< a part of each warning
};

class StartWarningTest : public ::testing::TestWithParam<StartCase> {};

TEST_P(StartWarningTest, NamesWhatIsWrongWithAStart) {
  World world = world_at(GetParam().p_WB);
  world.models.push_back(box_model("wall", {5.0, 0.0, 1.5}, {0.2, 6.0, 3.0}, {1.0, 1.0, 1.0}));
  world.anchors.push_back({{"box", uav::AnchorShape::kBox, {1, 1, 1}, {1, 1, 1}}, {}});
  std::vector<std::string> warnings;
  ClearanceMeter(world, {}).warn_of_starts([&](const Warning& w) {
    EXPECT_EQ(w.consequence, Consequence::kDoubtful);
    warnings.push_back(to_line(w));
  });
  ASSERT_EQ(warnings.size(), GetParam().said.size());
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    EXPECT_NE(warnings[i].find("'alpha'"), std::string::npos);
    EXPECT_NE(warnings[i].find(GetParam().said[i]), std::string::npos) << warnings[i];
  }
}

const std::vector<StartCase> kStartCases = {
    {"InTheAir", {0.0, 0.0, 1.0}, {}},
    {"OnTheFloor", {0.0, 0.0, 0.05}, {}},
    {"ALittleInTheFloor", {0.0, 0.0, 0.04}, {}},
    {"InTheFloor", {0.0, 0.0, 0.0}, {"inside 'floor'"}},
    {"InTheWall", {5.0, 0.0, 1.0}, {"inside 'wall'"}},
    {"OnTheFloorTouchingTheWall", {4.6995, 0.0, 0.05}, {"inside 'wall'"}},
    {"BelowTheFloor", {0.0, 0.0, -2.0}, {"below the floor 'floor'"}},
    {"FarAway", {100.0, 0.0, 1.0}, {"100 m from the nearest anchor, 'box'"}},
};

INSTANTIATE_TEST_SUITE_P(Starts, StartWarningTest, ::testing::ValuesIn(kStartCases),
                         [](const auto& named) { return named.param.name; });

TEST(ClearanceMeter, WarnsOnceOfAUavThatFallsBelowTheWorld) {
  const World world = world_at({0.0, 0.0, 1.0});
  std::vector<std::string> warnings;
  ClearanceMeter meter(world, {});
  for (const double z_m : {1.0, -0.5, -0.7, -2.0, 1.0, -2.0}) {
    meter.warn_of_falls(std::vector<uav::Pose>{{{30.0, 0.0, z_m}, {}}},
                        [&](const Warning& w) { warnings.push_back(to_line(w)); });
    EXPECT_EQ(warnings.size(), z_m <= -0.7 || !warnings.empty() ? 1U : 0U) << z_m;
  }
}

}  // namespace
}  // namespace tether::sim
