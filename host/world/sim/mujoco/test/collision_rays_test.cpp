#include "collision_rays.h"

#include "physics_model.h"
#include "test_simulator.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

// What rays meet, alone and as rangefinders of the whole simulator read it.
namespace tether::sim {
namespace {

using testing::box_model;
using testing::kRange;
using testing::make_simulator;
using testing::measure_now;
using testing::no_warnings;
using testing::test_uav;
using testing::test_world;
using uav::Pose;
using uav::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Cast {
  World world;
  ModelPtr model = make_physics_model(world, no_warnings());
  CollisionRays rays{*model, world};

  std::vector<double> distances_m(const RayBundle& bundle) {
    std::vector<double> distances(bundle.rays_S.size(), -1.0);
    rays.cast(bundle, distances);
    return distances;
  }
};

TEST(CollisionRaysTest, MeasuresTheDistanceAlongEach) {
  Cast cast{test_world()};
  const std::vector<Pose> X_WB{{{0.0, 0.0, 5.0}, {}}};
  const std::vector<Vec3> rays_S{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.6, 0.0, 0.8}};
  const Pose X_WS{{1.0, 0.0, 1.5}, uav::from_rpy(std::numbers::pi, 0.0, 0.0)};
  const auto distances_m = cast.distances_m({X_WS, rays_S, X_WB, 0});
  EXPECT_NEAR(distances_m[0], 1.5, 1e-12) << "the floor, upside down";
  EXPECT_EQ(distances_m[1], kInfinity);
  EXPECT_NEAR(distances_m[2], 1.5 / 0.8, 1e-12);
}

TEST(CollisionRaysTest, HitsBodiesAtTheGivenPosesButNotTheCarrier) {
  World world = test_world();
  world.uavs.push_back(test_uav("beta", {9.0, 9.0, 9.0}));
  Cast cast{std::move(world)};
  const std::vector<Vec3> rays_S{{1.0, 0.0, 0.0}};
  const std::vector<Pose> row{{{0.0, 0.0, 1.0}, {}}, {{3.0, 0.0, 1.0}, {}}};
  const std::vector<Pose> aside{{{0.0, 0.0, 1.0}, {}}, {{3.0, 1.0, 1.0}, {}}};
  const Pose before{{-2.0, 0.0, 1.0}, {}};
  EXPECT_NEAR(cast.distances_m({before, rays_S, row, 0})[0], 4.8, 1e-12);
  EXPECT_NEAR(cast.distances_m({before, rays_S, row, 1})[0], 1.8, 1e-12);
  EXPECT_EQ(cast.distances_m({before, rays_S, aside, 0})[0], kInfinity);
  EXPECT_NEAR(cast.distances_m({before, rays_S, row, 0})[0], 4.8, 1e-12) << "as before";
}

TEST(CollisionRaysTest, MeasuresTheNearestWallAhead) {
  World world = test_world();
  world.models.push_back(box_model("wall", {3.1, 0.0, 1.0}, {0.2, 6.0, 3.0}, {1.0, 1.0, 1.0}));
  world.models.push_back(box_model("behind", {5.0, 0.0, 1.0}, {0.2, 6.0, 3.0}, {1.0, 1.0, 1.0}));
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m, 3.0, 1e-12);
  world.uavs[0].X_WB.q = uav::from_axis_angle({0.0, 0.0, 1.0}, 0.5);
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m,
              3.0 / std::cos(0.5), 1e-12);
  world.uavs[0].sensors[kRange].X_BS.q = uav::from_rpy(0.0, 0.5 * std::numbers::pi, 0.0);
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m, 1.0, 1e-12)
      << "the floor, through its own body";
}

TEST(WallsBetween, CountsWallsButNoUavs) {
  World world = test_world();
  for (const double x_m : {3.0, 4.0, 8.0, 14.0})
    world.uavs.push_back(test_uav("at" + std::to_string(x_m), {x_m, 0.0, 1.0}));
  for (const double x_m : {2.0, 6.0, 10.0, 12.0})
    world.models.push_back(
        box_model("wall" + std::to_string(x_m), {x_m, 0.0, 1.0}, {0.2, 6.0, 3.0}, {1, 1, 1}));
  const auto simulator = make_simulator(std::move(world));
  EXPECT_EQ(simulator->walls_between(0, 1), 1);
  EXPECT_EQ(simulator->walls_between(1, 0), 1);
  EXPECT_EQ(simulator->walls_between(1, 2), 0);
  EXPECT_EQ(simulator->walls_between(0, 3), 2) << "through two UAVs";
  EXPECT_EQ(simulator->walls_between(4, 0), 4);
}

TEST(CollisionRaysTest, TheSurfaceThatIsMetGivesTheIntensity) {
  World world = test_world();  // floor
  world.models[0].links[0].collisions[0].intensity = 0.25;
  world.models.push_back(testing::box_model("loose", {3.0, 0.0, 1.0}, {1, 1, 1}, {}, false));
  world.models.back().links[0].collisions[0].intensity = 200.0;
  Cast cast{world};
  const std::vector<Pose> X_WB{{{0.0, 0.0, 1.0}, {}}, {{3.0, 0.0, 1.0}, {}}};
  const std::vector<Vec3> rays_S{{0.0, 0.0, -1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  std::vector<double> distances_m(3);
  std::vector<float> intensities(3, -1.0F);
  ASSERT_TRUE(
      cast.rays.cast_with_intensities({X_WB[0], rays_S, X_WB, 0}, distances_m, intensities));
  EXPECT_EQ(intensities, (std::vector<float>{0.25F, 200.0F, 0.0F}));
  EXPECT_EQ(distances_m, cast.distances_m({X_WB[0], rays_S, X_WB, 0}));
}

}  // namespace
}  // namespace tether::sim
