#include "collision_rays.h"

#include "physics_model.h"
#include "test_simulator.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <tether/sim/range_rays.h>

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

using namespace std::chrono_literals;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Cast {
  World world;
  ModelPtr model = make_physics_model(world, no_warnings());
  CollisionRays rays{*model};

  std::vector<double> distances_m(const RayBundle& bundle) {
    std::vector<double> distances(bundle.rays_S.size(), -1.0);
    rays.cast(bundle, distances);
    return distances;
  }
};

TEST(CollisionRaysTest, TellTheDistanceAlongEach) {
  Cast cast{test_world()};
  const std::vector<Pose> X_WB{{{0.0, 0.0, 5.0}, {}}};
  const std::vector<Vec3> rays_S{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.6, 0.0, 0.8}};
  const Pose X_WS{{1.0, 0.0, 1.5}, uav::from_rpy(std::numbers::pi, 0.0, 0.0)};
  const auto distances_m = cast.distances_m({X_WS, rays_S, X_WB, 0});
  EXPECT_NEAR(distances_m[0], 1.5, 1e-12) << "the floor, upside down";
  EXPECT_EQ(distances_m[1], kInfinity);
  EXPECT_NEAR(distances_m[2], 1.5 / 0.8, 1e-12);
}

TEST(CollisionRaysTest, MeetBodiesWhereTheyAreToldToBeButNotTheCarrier) {
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

RangeModel& range_of(World& world) {
  return std::get<RangeModel>(world.uavs[0].sensors[kRange].model);
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

TEST(CollisionRaysTest, ACloserHitOfAnyRayCounts) {
  World world = test_world();
  world.models.push_back(box_model("wall", {4.1, 0.0, 1.0}, {0.2, 6.0, 3.0}, {1.0, 1.0, 1.0}));
  // Its near edge is 2 m ahead and 0.25 m aside: 7.1° off the axis.
  world.models.push_back(box_model("post", {2.1, 0.35, 1.0}, {0.2, 0.2, 0.6}, {1.0, 1.0, 1.0}));
  const auto read = [&](double field_of_view_rad) {
    range_of(world).rays_S = cone_of_rays(field_of_view_rad);
    return measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m;
  };
  EXPECT_NEAR(read(0.0), 4.0, 1e-12) << "a single ray passes beside the post";
  EXPECT_NEAR(read(0.2), 4.0, 1e-12) << "as does a cone of 5.7° to each side";
  // The rings of a cone of 0.47 rad (27°): 3.4°, 6.7°, 10.1°, 13.5°; the third is the first to hit.
  EXPECT_NEAR(read(0.47), 2.0 / std::cos(0.235 * 0.75), 1e-9);
  range_of(world).rays_S = {{std::cos(0.13), std::sin(0.13), 0.0}};
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m,
              2.0 / std::cos(0.13), 1e-9)
      << "a ray of its own: along itself, to the post's near face";
}

TEST(CollisionRaysTest, RaysAreMountedAsTheSensorIs) {
  World world = test_world();
  world.uavs[0].sensors[kRange].X_BS = {{0.0, 0.0, 0.2}, uav::from_rpy(0.0, 1.0, 0.0)};
  range_of(world).rays_S = {{std::cos(0.3), 0.0, std::sin(0.3)},
                            {std::cos(0.3), 0.0, std::sin(-0.3)}};
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m,
              1.2 / std::sin(1.3), 1e-9)
      << "the floor, along the steeper one";
}

TEST(CollisionRaysTest, SeesOtherUavs) {
  World world = test_world();
  world.uavs.push_back(test_uav("beta", {2.2, 0.0, 1.0}));
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m, 2.0, 1e-12);
}

TEST(CollisionRaysTest, MeasuresAsOfTheSnapshot) {
  World world = test_world();
  world.models.push_back(box_model("wall", {3.1, 0.0, 1.0}, {0.2, 6.0, 3.0}, {1.0, 1.0, 1.0}));
  const auto simulator = make_simulator(world);
  Snapshot snapshot;
  simulator->capture(snapshot);
  simulator->apply(0, {{1.0, 0.0, 0.0}, 0.0});
  simulator->advance_to(SimTime(1s));
  const auto then = std::get<uav::RangeSample>(simulator->measure(snapshot, 0, kRange, 0));
  EXPECT_NEAR(then.range_m, 3.0, 1e-12);
  EXPECT_LT(measure_now<uav::RangeSample>(*simulator, kRange).range_m, 2.9);
}

}  // namespace
}  // namespace tether::sim
