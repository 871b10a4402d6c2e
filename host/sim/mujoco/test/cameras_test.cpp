#include "renderer.h"
#include "test_simulator.h"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/sim_mujoco/mujoco_simulator.h>

// What the camera's options do, measured in images of the whole simulator.
namespace tether::sim {
namespace {

using testing::box_model;
using testing::box_visual;
using testing::kCamera;
using testing::make_simulator;
using testing::measure_now;
using testing::no_warnings;
using testing::test_uav;
using uav::Vec3;

using namespace std::chrono_literals;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kWall_m = 5.0;

// Whatever the light, colours are seen as they are.
World flat_world() {
  World world;
  world.ambient_rgb = {1.0, 1.0, 1.0};
  world.background_rgb = {0.0, 0.0, 0.0};
  world.uavs.push_back(test_uav("alpha", {0.0, 0.0, 1.0}));
  Sensor& sensor = world.uavs[0].sensors[kCamera];
  sensor = testing::camera_sensor("camera", kWidth, kHeight);
  sensor.X_BS = {};
  return world;
}

CameraModel& camera_of(World& world) {
  return std::get<CameraModel>(world.uavs[0].sensors[kCamera].model);
}

// Ahead, black from y = 0 to the left and white to the right: one upright edge. It is seen aslant,
// so that in a band of rows it lies anywhere within a pixel: a renderer's pixel is one point.
World edge_world() {
  World world = flat_world();
  world.models.push_back(
      box_model("right", {kWall_m + 0.5, -20.0, 0.0}, {1.0, 40.0, 40.0}, {1.0, 1.0, 1.0}));
  world.uavs[0].sensors[kCamera].X_BS.q = uav::from_rpy(0.1, 0.0, 0.0);
  return world;
}

World with_shutter(World world, double exposure_s, double readout_s) {
  camera_of(world).exposure_s = exposure_s;
  camera_of(world).readout_s = readout_s;
  return world;
}

// A flight whose attitude was noted at every step.
struct Flight {
  std::unique_ptr<Simulator> simulator;
  std::vector<uav::BodyState> truth;

  explicit Flight(World world) : simulator(make_simulator(std::move(world))) { note(); }

  void advance(Duration d) {
    const SimTime end = simulator->now() + d;
    while (simulator->now() < end) {
      simulator->advance_to(simulator->now() + 1ms);
      note();
    }
  }
  uav::CameraSample image() { return measure_now<uav::CameraSample>(*simulator, kCamera); }

  uav::Pose X_WB(double ago_s) const {
    const uav::BodyState& b =
        truth[truth.size() - 1 - static_cast<std::size_t>(std::lround(1000.0 * ago_s))];
    return {b.p_WB, b.q_WB};
  }

 private:
  void note() { truth.push_back(simulator->ground_truth(0).body); }
};

// Turning to the left at about 1 rad/s, the edge near the middle.
Flight turning(World world) {
  world.uavs[0].X_WB.q = uav::from_rpy(0.0, 0.0, -0.8);
  Flight flight(std::move(world));
  flight.simulator->apply(0, {{}, 1.0});
  flight.advance(1s);
  return flight;
}

double light(std::uint8_t byte) {
  const double c = byte / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Where a line of light from dark to bright has its edge, and the square of how wide the edge is
// beyond the distance of two pixels: from mean and variance of the steps between neighbours.
struct Edge {
  double at_px = 0.0;
  double width_px2 = 0.0;
};
Edge measure_edge(const std::vector<double>& line) {
  double sum = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double step = line[i + 1] - line[i];
    const double at = static_cast<double>(i) + 0.5;
    sum += step;
    first += step * at;
    second += step * at * at;
  }
  const double mean = first / sum;
  return {mean, 12.0 * (second / sum - mean * mean) - 1.0};
}

std::size_t byte_of(int column, int row) {
  return 3 * static_cast<std::size_t>(row * kWidth + column);
}

Edge edge_of_row(const uav::CameraSample& image, int row) {
  std::vector<double> line;
  for (int column = 0; column < kWidth; ++column) {
    line.push_back(light(image.rgb[byte_of(column, row)]));
  }
  return measure_edge(line);
}

// Where the edge is to be seen in a row by a UAV posed so.
double expected_edge_px(const World& world, const uav::Pose& X_WB, int row) {
  const Sensor& sensor = world.uavs[0].sensors[kCamera];
  const uav::CameraModel& camera = std::get<CameraModel>(sensor.model).intrinsics;
  const uav::Pose X_CW = inverse(X_WB * sensor.X_BS * uav::Pose{{}, uav::q_body_from_optical()});
  double low_z = -20.0;
  double high_z = 20.0;
  uav::Pixel pixel;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low_z + high_z);
    pixel = *camera.project(transform(X_CW, {kWall_m, 0.0, z}));
    (pixel.v_px > row ? low_z : high_z) = z;
  }
  return pixel.u_px;
}

constexpr int kBand = 40;

// Over a band of rows: how the edge lies to where it would be with all rows exposed for an instant
// at the image's time, where the shutter's formula has it, and the same of its width.
struct Band {
  double offset_px = 0.0;
  double expected_offset_px = 0.0;
  double width_px = 0.0;
  double expected_width_px = 0.0;
};
Band measure_band(const Flight& flight, const uav::CameraSample& image, int first_row) {
  const World& world = flight.simulator->world();
  const auto& camera = std::get<CameraModel>(world.uavs[0].sensors[kCamera].model);
  Band band;
  for (int row = first_row; row < first_row + kBand; ++row) {
    const double end_s = camera.readout_s * (kHeight - 1 - row) / (kHeight - 1);
    const double now_px = expected_edge_px(world, flight.X_WB(0.0), row);
    const double end_px = expected_edge_px(world, flight.X_WB(end_s), row);
    const double begin_px = expected_edge_px(world, flight.X_WB(end_s + camera.exposure_s), row);
    const Edge edge = edge_of_row(image, row);
    band.offset_px += (edge.at_px - now_px) / kBand;
    band.expected_offset_px += (0.5 * (begin_px + end_px) - now_px) / kBand;
    band.width_px += edge.width_px2 / kBand;
    band.expected_width_px += (end_px - begin_px) / kBand;
  }
  band.width_px = std::sqrt(std::max(0.0, band.width_px));
  return band;
}

// Rows between two instants, and pixels between two of an undistorted image, are mixed of both.
struct Slack {
  double offset_px = 0.15;
  double width_px = 0.25;
};
constexpr Slack kMixedRows{0.15, 1.1};
constexpr Slack kMixedPixels{0.35, 1.1};

void expect_the_edge_as_the_shutter_has_it(World world, const Slack& slack = {}) {
  Flight flight = turning(std::move(world));
  const uav::CameraSample image = flight.image();
  for (int row = 0; row < kHeight; row += kBand) {
    const Band band = measure_band(flight, image, row);
    EXPECT_NEAR(band.offset_px, band.expected_offset_px, slack.offset_px) << row;
    EXPECT_NEAR(band.width_px, band.expected_width_px,
                slack.width_px + 0.05 * band.expected_width_px)
        << row;
  }
}

TEST(CamerasTest, WithoutAShutterTheImageIsWhatTheRendererDraws) {
  World world = edge_world();
  Flight flight = turning(world);
  const uav::CameraSample image = flight.image();
  Renderer renderer(make_scene(world, no_warnings()), kWidth, kHeight);
  const std::vector<uav::Pose> poses{flight.X_WB(0.0)};
  const CameraModel& camera = camera_of(world);
  std::vector<std::uint8_t> expected(image.rgb.size());
  renderer.render({camera.intrinsics, camera.near_m, camera.far_m,
                   poses[0] * world.uavs[0].sensors[kCamera].X_BS, poses, std::size_t{0}},
                  expected);
  EXPECT_EQ(image.rgb, expected);
}

TEST(CamerasTest, ExposureBlursByRateTimesFocalLength) {
  const double focal_px = testing::camera_intrinsics(kWidth, kHeight).fx_px;
  for (const double exposure_s : {0.0, 0.01, 0.03, 0.06}) {
    SCOPED_TRACE(exposure_s);
    const World world = with_shutter(edge_world(), exposure_s, 0.0);
    expect_the_edge_as_the_shutter_has_it(world);
    Flight flight = turning(world);
    const double blur_px = flight.truth.back().w_WB_B.z * focal_px * exposure_s;
    EXPECT_NEAR(measure_band(flight, flight.image(), 100).width_px, blur_px, 0.25 + 0.1 * blur_px);
  }
}

TEST(CamerasTest, RollingShutterLeansAnUprightEdge) {
  constexpr double kReadout_s = 0.03;
  const World world = with_shutter(edge_world(), 0.0, kReadout_s);
  expect_the_edge_as_the_shutter_has_it(world, kMixedRows);
  Flight flight = turning(world);
  const uav::CameraSample image = flight.image();
  const int last_band = kHeight - kBand;
  const double lean_px =
      measure_band(flight, image, last_band).offset_px - measure_band(flight, image, 0).offset_px;
  const double rate_px_s =
      flight.truth.back().w_WB_B.z * testing::camera_intrinsics(kWidth, kHeight).fx_px;
  EXPECT_NEAR(lean_px, rate_px_s * kReadout_s * last_band / (kHeight - 1), 0.1 * lean_px);
}

TEST(CamerasTest, TheLastRowIsThatOfAGlobalShutter) {
  const uav::CameraSample rolling = turning(with_shutter(edge_world(), 0.0, 0.03)).image();
  const uav::CameraSample global = turning(edge_world()).image();
  const auto last_row = static_cast<std::ptrdiff_t>(byte_of(0, kHeight - 1));
  EXPECT_TRUE(
      std::equal(rolling.rgb.begin() + last_row, rolling.rgb.end(), global.rgb.begin() + last_row));
  EXPECT_NE(rolling.rgb, global.rgb);
}

TEST(CamerasTest, ExposureAndReadoutTogether) {
  expect_the_edge_as_the_shutter_has_it(with_shutter(edge_world(), 0.02, 0.03));
  expect_the_edge_as_the_shutter_has_it(with_shutter(edge_world(), 0.05, 0.01));
}

// Rows are those of the image that comes out, not of the ideal one that it is made of.
TEST(CamerasTest, RowsOfADistortedImageHaveTheirOwnTimes) {
  World world = with_shutter(edge_world(), 0.005, 0.03);
  uav::CameraModel& camera = camera_of(world).intrinsics;
  camera.k1 = -0.25;
  camera.k2 = 0.05;
  camera.p1 = 0.01;
  camera.p2 = -0.005;
  camera.fy_px *= 1.1;
  expect_the_edge_as_the_shutter_has_it(world, kMixedPixels);
}

// Falling past a camera at rest, in front of a dark background.
TEST(CamerasTest, WhatMovesIsBlurredBeforeWhatRests) {
  constexpr double kExposure_s = 0.02;
  World world = with_shutter(flat_world(), kExposure_s, 0.0);
  world.models.push_back(
      box_model("card", {3.1, 0.0, 1.5}, {0.2, 4.0, 0.6}, {1.0, 1.0, 1.0}, false));
  Flight flight(world);
  flight.advance(300ms);
  const uav::CameraSample image = flight.image();
  std::vector<double> upper_half;
  for (int row = 0; row < kHeight / 2; ++row) {
    upper_half.push_back(light(image.rgb[byte_of(160, row)]));
  }
  const double px_per_m = testing::camera_intrinsics(kWidth, kHeight).fx_px / 3.0;
  const double fallen_m = 0.5 * 9.81 * (0.3 * 0.3 - 0.28 * 0.28);
  EXPECT_NEAR(std::sqrt(measure_edge(upper_half).width_px2), px_per_m * fallen_m, 0.5);
}

TEST(CamerasTest, AtRestAShutterChangesNoByte) {
  World world = edge_world();
  world.models.push_back(box_model("box", {2.0, 0.3, 1.0}, {0.3, 0.3, 0.3}, {0.7, 0.4, 0.1}));
  Flight with(with_shutter(world, 0.02, 0.03));
  Flight without(world);
  EXPECT_EQ(with.image().rgb, without.image().rgb) << "at ST 0 there is nothing before";
  with.advance(500ms);
  without.advance(500ms);
  EXPECT_EQ(with.image().rgb, without.image().rgb);
}

TEST(CamerasTest, AResetForgetsWhatWasBefore) {
  Flight flight = turning(with_shutter(edge_world(), 0.02, 0.03));
  Flight fresh(flight.simulator->world());
  flight.simulator->reset(0);
  EXPECT_EQ(flight.image().rgb, fresh.image().rgb);
}

TEST(CamerasTest, RefusesAnImpossibleShutter) {
  for (const auto& [exposure_s, readout_s] :
       {std::pair{-0.01, 0.02}, {0.02, -0.01}, {0.6, 0.6}, {std::nan(""), 0.0}}) {
    EXPECT_THROW(make_simulator(with_shutter(flat_world(), exposure_s, readout_s)), Error);
  }
}

// Small bright cards here and there, each alone in the picture.
TEST(CamerasTest, DistortedPointsAreWhereTheModelProjectsThem) {
  World world = flat_world();
  uav::CameraModel& camera = camera_of(world).intrinsics;
  camera.k1 = -0.2;
  camera.k2 = 0.06;
  camera.k3 = -0.01;
  camera.p1 = 0.01;
  camera.p2 = -0.015;
  const uav::CameraModel ideal = testing::camera_intrinsics(kWidth, kHeight);
  double most_px = 0.0;
  for (const auto& [y, z] :
       {std::pair{0.0, 0.0}, {1.2, 0.9}, {-1.2, 0.8}, {1.1, -0.8}, {-0.4, -0.9}}) {
    World one = world;
    const Vec3 p_W{2.0, y, 1.0 + z};
    one.models.push_back(box_model("card", p_W, {0.001, 0.03, 0.03}, {1.0, 1.0, 1.0}));
    const uav::CameraSample image = Flight(one).image();
    double sum = 0.0;
    uav::Pixel seen;
    for (int row = 0; row < kHeight; ++row) {
      for (int column = 0; column < kWidth; ++column) {
        const double value = light(image.rgb[byte_of(column, row)]);
        sum += value;
        seen.u_px += value * column;
        seen.v_px += value * row;
      }
    }
    const Vec3 p_C{-y, -z, 2.0};
    const uav::Pixel expected = *camera.project(p_C);
    ASSERT_GT(sum, 4.0);
    EXPECT_NEAR(seen.u_px / sum, expected.u_px, 0.3);
    EXPECT_NEAR(seen.v_px / sum, expected.v_px, 0.3);
    const uav::Pixel undistorted = *ideal.project(p_C);
    most_px = std::max(
        most_px, std::hypot(expected.u_px - undistorted.u_px, expected.v_px - undistorted.v_px));
  }
  EXPECT_GT(most_px, 10.0) << "or distortion was not there to be seen";
}

TEST(CamerasTest, NamesACameraWhoseDistortionLeavesPixelsBlack) {
  World world = edge_world();
  camera_of(world).intrinsics.k1 = -1.0;
  std::vector<std::string> warnings;
  const auto simulator =
      make_mujoco_simulator(world, [&](const std::string& line) { warnings.push_back(line); });
  measure_now<uav::CameraSample>(*simulator, kCamera);
  measure_now<uav::CameraSample>(*simulator, kCamera, 1);
  EXPECT_THAT(warnings, ::testing::ElementsAre(::testing::AllOf(
                            ::testing::HasSubstr("camera 'camera'"),
                            ::testing::HasSubstr("distortion maps no direction"))));
}

// A grey wall, seen with and without noise.
struct NoisyWall {
  World world = flat_world();
  explicit NoisyWall(const Noise& noise) {
    world.models.push_back(box_model("wall", {3.0, 0.0, 1.0}, {1.0, 40.0, 40.0}, {0.5, 0.5, 0.5}));
    camera_of(world).pixel_noise = noise;
  }
  std::vector<std::uint8_t> image(std::uint64_t seed, std::uint64_t index) const {
    const auto simulator = make_simulator(world);
    simulator->reset(seed);
    return measure_now<uav::CameraSample>(*simulator, kCamera, index).rgb;
  }
};

TEST(CamerasTest, PixelNoiseHasItsMeanAndDeviation) {
  const auto clean = NoisyWall({}).image(1, 0);
  const NoisyWall noisy({0.02, 0.03, 0.0, 0.0, 0.0, 0.0});
  const auto image = noisy.image(1, 0);
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const double difference = image[i] - clean[i];
    sum += difference;
    squares += difference * difference;
  }
  const double mean = sum / static_cast<double>(image.size());
  EXPECT_NEAR(mean, 255.0 * 0.02, 0.06);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(image.size()) - mean * mean), 255.0 * 0.03,
              0.06);
}

TEST(CamerasTest, PixelNoiseDiffersByImageAndSeed) {
  const NoisyWall noisy({0.0, 0.03, 0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(noisy.image(1, 0), noisy.image(1, 0));
  EXPECT_NE(noisy.image(1, 0), noisy.image(1, 1));
  EXPECT_NE(noisy.image(1, 0), noisy.image(2, 0));
}

}  // namespace
}  // namespace tether::sim
