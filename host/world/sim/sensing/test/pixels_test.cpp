#include "pixels.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::sim {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const MeasurementKey kKey{1, "uav", "depth", 2, SimTime{}};

CameraModel depth_camera(uav::CameraKind kind = uav::CameraKind::kDepth) {
  CameraModel camera;
  camera.kind = kind;
  camera.depth_min_m = 0.5;
  camera.depth_max_m = 8.0;
  return camera;
}

TEST(Depths, BeyondTheLimitsAreInfinite) {
  std::array depths{0.499F, 0.5F, 8.0F, 8.001F, kInf, kNan};
  finish_depths(depth_camera(), kKey, depths);
  EXPECT_EQ((std::array{depths[0], depths[1], depths[2], depths[3], depths[4]}),
            (std::array{-kInf, 0.5F, 8.0F, kInf, kInf}));
  EXPECT_TRUE(std::isnan(depths[5]));
}

TEST(Depths, HaveTheNoiseOfADepthCameraOnly) {
  for (const auto kind : {uav::CameraKind::kDepth, uav::CameraKind::kRgbd}) {
    CameraModel camera = depth_camera(kind);
    camera.pixel_noise.mean = 0.1;
    camera.pixel_noise.stddev = 0.02;
    std::vector<float> depths(10'000, 3.0F), again = depths;
    finish_depths(camera, kKey, depths);
    finish_depths(camera, kKey, again);
    EXPECT_EQ(depths, again);
    double sum = 0.0, squares = 0.0;
    for (const float depth : depths) sum += depth, squares += double{depth} * depth;
    const double mean = sum / 1e4, stddev = std::sqrt(squares / 1e4 - mean * mean);
    const bool is_noisy = kind == uav::CameraKind::kDepth;
    EXPECT_NEAR(mean, is_noisy ? 3.1 : 3.0, 1e-3);
    EXPECT_NEAR(stddev, is_noisy ? 0.02 : 0.0, 1e-3);
  }
}

TEST(Depths, AreSeenFromNearerThanTheLimit) {
  EXPECT_LT(near_m(depth_camera()), 0.01);
  EXPECT_EQ(near_m(CameraModel{}), CameraModel{}.near_m);
}

TEST(Labels, HaveSixteenBits) {
  const Sensor sensor{"eye", {}, 0.0, CameraModel{}, {"uav.sdf", 3}};
  EXPECT_EQ(labels_of(std::array{0U, 65535U}, sensor), (std::vector<std::uint16_t>{0, 65535}));
  const Error error = bad_file_error([&] { labels_of(std::array{1U, 65536U}, sensor); });
  EXPECT_EQ(error.where(), sensor.declared_at);
}

World world_with(std::vector<std::string> models, std::vector<std::string> anchors) {
  World world;
  for (auto& name : models) world.models.emplace_back().name = std::move(name);
  for (auto& name : anchors) world.anchors.emplace_back().anchor.name = std::move(name);
  world.uavs.emplace_back().name = "uav";
  return world;
}

TEST(Anchors, AreWhereTheirPixelsAre) {
  const World world = world_with({"wall", "box", "box::lid", "boxes", "ball"}, {"ball", "box"});
  // Five columns: the lid is a part of the box, and "boxes" and the UAV (6) are not.
  const std::vector<std::uint32_t> models{
      2, 0, 0, 1, 4,  //
      0, 0, 3, 2, 6,  //
      0, 2, 0, 0, 1,  //
  };
  const std::vector<uav::SeenAnchor> box{{"box", 0, 0, 3, 2, 4}};
  EXPECT_EQ(find_anchors(world, models, 5), box);
  EXPECT_TRUE(find_anchors(world, {}, 5).empty());
}

TEST(Anchors, AreFoundUpToTheCornersOfTheImage) {
  const World world = world_with({"box"}, {"box"});
  const std::vector<uav::SeenAnchor> corners{{"box", 0, 0, 2, 1, 2}};
  EXPECT_EQ(find_anchors(world, std::vector<std::uint32_t>{1, 0, 0, 0, 0, 1}, 3), corners);
  const std::vector<uav::SeenAnchor> all{{"box", 0, 0, 2, 1, 6}};
  EXPECT_EQ(find_anchors(world, std::vector<std::uint32_t>(6, 1), 3), all);
}

}  // namespace
}  // namespace tether::sim
