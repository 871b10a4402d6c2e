#include "fake_back_end.h"
#include "sensors/imu.h"
#include "sensors/range.h"

#include <algorithm>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/sim_sensing/sensor_suite.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::kCamera;
using testing::kImu;
using testing::kRange;
using uav::Pose;
using uav::Vec3;

// Two UAVs with noisy sensors mounted askew, and a loose box.
World noisy_world() {
  World world = testing::test_world();
  world.uavs.push_back(testing::test_uav("beta", {2.0, 0.0, 1.0}));
  world.models.push_back(testing::box_model("loose", {}, {1.0, 1.0, 1.0}, {}, false));
  for (Uav& uav : world.uavs) {
    const Pose X_BS{{0.1, 0.2, 0.3}, uav::from_rpy(0.4, 0.5, 0.6)};
    for (Sensor& sensor : uav.sensors) sensor.X_BS = X_BS;
    std::get<ImuModel>(uav.sensors[kImu].model).angular_velocity[0].stddev = 0.1;
    auto& range = std::get<RangeModel>(uav.sensors[kRange].model);
    range.rays_S = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    range.noise.stddev = 0.1;
  }
  return world;
}

const std::vector<Pose> kPoses{{{1.0, 2.0, 3.0}, uav::from_rpy(0.1, 0.2, 0.3)},
                               {{4.0, 5.0, 6.0}, uav::from_rpy(0.3, 0.1, 2.0)},
                               {{7.0, 8.0, 9.0}, {}}};
const std::vector<BodyMotion> kMotions{{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}},
                                       {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0.8, 0.9}}};
const SimTime kAt{std::chrono::milliseconds(70)};

class SensorSuiteTest : public ::testing::Test {
 protected:
  SensorSuiteTest() {
    StateRecorder recorder(world_);
    recorder.reset(kPoses);
    recorder.capture(kPoses, kMotions, snapshot_.state);
    snapshot_.at = kAt;
  }

  template <class S>
  S measure(std::size_t uav, std::size_t sensor, std::uint64_t index) {
    return std::get<S>(suite_.measure(snapshot_, uav, sensor, index));
  }
  Pose X_BS() const { return world_.uavs[0].sensors[kImu].X_BS; }

  const World world_ = noisy_world();
  testing::DrawLog log_;
  testing::FakeRays rays_{{3.0, 2.0, 5.0}};
  SensorSuite suite_{world_, {rays_, testing::fake_renderers(log_)}, [](const Warning& warning) {
                       ADD_FAILURE() << to_line(warning);
                     }};
  Snapshot snapshot_;
};

TEST_F(SensorSuiteTest, AnImuMeasuresItsCarriersMotion) {
  suite_.reset(9);
  const auto sample = measure<uav::ImuSample>(1, kImu, 4);
  const auto expected =
      measure_imu(std::get<ImuModel>(world_.uavs[1].sensors[kImu].model), X_BS(), kPoses[1],
                  kMotions[1], felt_at_rest(world_), {9, "beta", "imu", 4, kAt});
  EXPECT_EQ(sample.sampled_at, kAt);
  EXPECT_EQ(sample.index, 4U);
  EXPECT_EQ(sample.angular_velocity_rad_s, expected.angular_velocity_rad_s);
  EXPECT_EQ(sample.specific_force_m_s2, expected.specific_force_m_s2);
  EXPECT_EQ(sample.q_WS, expected.q_WS);
}

TEST_F(SensorSuiteTest, ARangefinderReadsTheNearestOfItsRays) {
  const auto& model = std::get<RangeModel>(world_.uavs[1].sensors[kRange].model);
  const auto sample = measure<uav::RangeSample>(1, kRange, 4);
  ASSERT_EQ(rays_.seen.size(), 1U);
  const testing::FakeRays::Seen& seen = rays_.seen[0];
  EXPECT_EQ(seen.bundle.X_WS, kPoses[1] * X_BS());
  EXPECT_EQ(seen.bundle.ignored, 1U);
  EXPECT_EQ(seen.bundle.max_m, farthest_read_m(model));
  EXPECT_EQ(seen.rays_S, model.rays_S);
  EXPECT_EQ(seen.X_WB, kPoses);
  const std::vector<double> nearest{2.0};
  EXPECT_EQ(sample.range_m, measure_range(model, nearest, {0, "beta", "range", 4, kAt}).range_m);
  EXPECT_EQ(sample.sampled_at, kAt);
  EXPECT_EQ(sample.index, 4U);
}

TEST_F(SensorSuiteTest, ACameraSeesFromItsCarrierWithALateRenderer) {
  measure<uav::RangeSample>(0, kRange, 0);
  EXPECT_EQ(log_.made, 0) << "no renderer without an image";
  EXPECT_EQ(suite_.renderer_name(), "");
  const auto sample = measure<uav::CameraSample>(1, kCamera, 4);
  EXPECT_EQ(suite_.renderer_name(), "fake");
  EXPECT_EQ(sample.rgb.size(), std::size_t{3} * 160 * 120);
  EXPECT_EQ(sample.sampled_at, kAt);
  EXPECT_EQ(sample.index, 4U);
  ASSERT_EQ(log_.drawn.size(), 1U);
  const testing::DrawLog::Drawn& drawn = log_.drawn[0];
  EXPECT_EQ(drawn.X_WC.at(0), kPoses[1] * (X_BS() * Pose{{}, uav::q_body_from_optical()}));
  EXPECT_EQ(drawn.view.hidden, 1U);
  EXPECT_EQ(drawn.X_WB.at(0), kPoses);
}

TEST_F(SensorSuiteTest, TheSeedKeysTheNoise) {
  const auto read = [&](std::uint64_t index) {
    return measure<uav::RangeSample>(0, kRange, index).range_m;
  };
  const double at_first = read(1);
  EXPECT_NE(at_first, read(2));
  suite_.reset(5);
  EXPECT_NE(at_first, read(1));
  suite_.reset(0);
  EXPECT_EQ(at_first, read(1));
}

// Greys that depend on the camera's place; used by several threads.
class PlaceRenderer final : public CameraRenderer {
 public:
  void draw(const raster::View& view, const raster::Picture& picture) override {
    const double x_m = view.instants.back().X_WC.p.x;
    if (x_m < 0.0) throw Error(ErrorCode::kSetup, "lost");
    std::ranges::fill(picture.rgb, static_cast<std::uint8_t>(x_m));
  }
  std::size_t blind_pixels(const uav::CameraModel&) override { return 0; }
  std::string name() const override { return "place"; }
};

TEST_F(SensorSuiteTest, PicturesDrawnAheadAreThoseOfTheirSnapshots) {
  SensorSuite suite{world_,
                    {rays_, [](raster::Helpers*) { return std::make_unique<PlaceRenderer>(); }, 3},
                    [](const Warning&) {}};
  std::vector<Snapshot> snapshots(100, snapshot_);
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    snapshots[i].at = SimTime(std::chrono::milliseconds(i));
    snapshots[i].state[0] = i == 70 ? -10.0 : static_cast<double>(2 * i + 10);
    snapshots[i].state[7] = static_cast<double>(i + 10);
  }
  const auto grey = [&](std::size_t i, std::size_t uav) {
    return std::get<uav::CameraSample>(suite.measure(snapshots[i], uav, kCamera, i)).rgb.at(0);
  };
  suite.reset(0);
  const int offset[] = {grey(0, 0) - 10, grey(0, 1) - 10};
  for (std::size_t i = 1; i < snapshots.size(); ++i) {
    const std::size_t next = std::min(i + i % 3, snapshots.size() - 1);
    for (std::size_t uav = 0; uav < 2; ++uav) suite.expect(snapshots[next], uav, kCamera, next);
    if (i % 3 == 0) suite.expect(snapshots[i], 0, kRange, i);
    if (i == 70) {
      EXPECT_THROW(grey(i, 0), Error);
    } else if (i % 7 != 0) {
      EXPECT_EQ(grey(i, 0), static_cast<int>(2 * i + 10) + offset[0]);
    }
    EXPECT_EQ(grey(i, 1), static_cast<int>(i + 10) + offset[1]);
  }
  const SimulatorWork work = suite.work();
  EXPECT_GE(work.pictures, 2 * snapshots.size() - 14);
  EXPECT_LE(work.drawn_in_vain, 14u);
  suite.reset(0);
  EXPECT_EQ(suite.work(), SimulatorWork{});
}

TEST_F(SensorSuiteTest, RefusesUnknownUavsAndSensors) {
  EXPECT_THROW(suite_.measure(snapshot_, 2, kImu, 0), Error);
  EXPECT_THROW(suite_.measure(snapshot_, 0, 3, 0), Error);
}

}  // namespace
}  // namespace tether::sim
