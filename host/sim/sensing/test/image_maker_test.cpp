#include "image_maker.h"

#include "fake_back_end.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_sensing/state_recorder.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::kCamera;
using testing::RenderLog;
using testing::SeenView;
using uav::Pose;

constexpr int kWidth = 16;
constexpr int kHeight = 12;
constexpr double kWindow_s = 0.02;
constexpr int kSteps = 20;

// One UAV, and a loose box of 0.5 m radius far behind it.
World small_world() {
  World world = testing::test_world();
  world.models.push_back(testing::box_model("loose", {}, {}, {}, false));
  world.uavs[0].sensors[kCamera] = testing::camera_sensor("camera", kWidth, kHeight);
  return world;
}

CameraModel& camera_of(World& world) {
  return std::get<CameraModel>(world.uavs[0].sensors[kCamera].model);
}

World shutter_world(double exposure_s, double readout_s) {
  World world = small_world();
  camera_of(world).exposure_s = exposure_s;
  camera_of(world).readout_s = readout_s;
  return world;
}

World lens_world(World world) {
  camera_of(world).intrinsics.k1 = -0.2;
  camera_of(world).intrinsics.fy_px *= 1.2;
  return world;
}

// Where the UAV and the box are over the window: 0 at its beginning, 1 at the image's instant.
using Course = std::function<std::vector<Pose>(double)>;

std::vector<Pose> at_rest(double) {
  return {{{0.0, 0.0, 1.0}, {}}, {{-50.0, 0.0, 0.0}, {}}};
}
// One metre along x, with the camera 0.2 m ahead.
std::vector<Pose> flying(double t) {
  return {{{t, 0.0, 1.0}, {}}, {{-50.0, 0.0, 0.0}, {}}};
}

// The images of a world's first camera at the end of a course.
struct Studio {
  World world;
  RenderLog log;
  std::vector<std::string> warnings;
  ImageMaker maker;

  explicit Studio(World w)
      : world(std::move(w)),
        maker(world, {0.3, 0.5}, testing::fake_renderers(log),
              [this](const Warning& warning) { warnings.push_back(to_line(warning)); }) {}

  uav::CameraSample image(const Course& course, std::uint64_t seed = 0, std::uint64_t index = 0) {
    StateRecorder recorder(world);
    recorder.reset(course(0.0));
    for (int i = 0; i < kSteps; ++i) recorder.begin_step(course(1.0 * i / kSteps));
    std::vector<double> state;
    recorder.capture(course(1.0), std::vector<BodyMotion>(1), state);
    const Sensor& sensor = world.uavs[0].sensors[kCamera];
    const MeasurementKey key{seed, "alpha", "camera", index, SimTime(std::chrono::seconds(3))};
    return maker.make(camera_of(world), {state, 0, sensor, key});
  }
};

double light(std::uint8_t byte) {
  const double c = byte / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
std::uint8_t byte_of(double light) {
  return static_cast<std::uint8_t>(
      std::lround(255.0 * (1.055 * std::pow(light, 1.0 / 2.4) - 0.055)));
}

// Each picture of one grey, which tells how far the camera has flown: light 0.2 to 0.8.
std::uint8_t paint_progress(const View& view, int, int) {
  return byte_of(0.2 + 0.6 * (view.X_WS.p.x - 0.2));
}
// A grey that tells the row of the whole image, whichever part of it is drawn.
std::uint8_t paint_row(const View& view, int, int row) {
  const double below_axis = row - view.camera.cy_px;
  return static_cast<std::uint8_t>(std::lround(100.0 + 10.0 * below_axis));
}

double light_of_row(const uav::CameraSample& image, int row) {
  return light(image.rgb[static_cast<std::size_t>(3 * kWidth * row)]);
}

TEST(ImageMakerTest, WithoutAShutterTheImageIsWhatTheRendererDraws) {
  Studio studio(small_world());
  studio.log.paint = [](const View&, int column, int row) {
    return static_cast<std::uint8_t>(16 * row + column);
  };
  const uav::CameraSample image = studio.image(flying, 0, 4);
  EXPECT_EQ(image.index, 4U);
  EXPECT_EQ(image.sampled_at, SimTime(std::chrono::seconds(3)));
  EXPECT_EQ(image.width_px, kWidth);
  EXPECT_EQ(image.height_px, kHeight);
  ASSERT_EQ(image.rgb.size(), std::size_t{3} * kWidth * kHeight);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) EXPECT_EQ(image.rgb[i], i / 3);
  ASSERT_EQ(studio.log.views.size(), 1U);
  const SeenView& seen = studio.log.views[0];
  EXPECT_EQ(seen.view.camera.cx_px, camera_of(studio.world).intrinsics.cx_px);
  EXPECT_EQ(seen.view.near_m, camera_of(studio.world).near_m);
  EXPECT_EQ(seen.view.far_m, camera_of(studio.world).far_m);
  EXPECT_EQ(seen.view.X_WS.p, (uav::Vec3{1.2, 0.0, 1.0}));
  EXPECT_EQ(seen.X_WB, flying(1.0));
  EXPECT_EQ(seen.view.hidden, 0U);
  EXPECT_FALSE(seen.view.with_depth);
}

TEST(ImageMakerTest, TheRendererIsMadeOnceForTheLargestCamera) {
  World world = small_world();
  Sensor large = testing::camera_sensor("large", 64, 6);
  std::get<CameraModel>(large.model).intrinsics.k1 = 0.1;
  world.uavs[0].sensors.push_back(large);
  Studio studio(std::move(world));
  EXPECT_EQ(studio.log.made, 0);
  EXPECT_EQ(studio.maker.renderer_name(), "");
  studio.image(at_rest);
  studio.image(at_rest);
  EXPECT_EQ(studio.log.made, 1);
  EXPECT_EQ(studio.maker.renderer_name(), "fake");
  const ImageWarp warp(std::get<CameraModel>(large.model).intrinsics);
  EXPECT_EQ(studio.log.max_width_px, std::max(kWidth, warp.source().width_px));
  EXPECT_EQ(studio.log.max_height_px, std::max(kHeight, warp.source().height_px));
}

TEST(ImageMakerTest, AtRestOnePictureIsEnough) {
  Studio studio(shutter_world(0.01, 0.01));
  studio.log.paint = paint_row;
  Studio without(small_world());
  without.log.paint = paint_row;
  EXPECT_EQ(studio.image(at_rest).rgb, without.image(at_rest).rgb);
  EXPECT_EQ(studio.log.views.size(), 1U);
  EXPECT_EQ(studio.log.depths, 1);
  EXPECT_EQ(without.log.depths, 0) << "without a shutter nobody asks how far things are";
}

TEST(ImageMakerTest, MakesAPictureForEachPixelOfMotion) {
  Studio studio(shutter_world(kWindow_s, 0.0));
  const double focal_px = camera_of(studio.world).intrinsics.fx_px;
  for (const double pixels : {0.5, 3.5, 9.2}) {
    studio.log.views.clear();
    studio.log.nearest_m = focal_px / pixels;
    studio.image(flying);
    EXPECT_EQ(studio.log.views.size(), 1.0 + std::ceil(pixels));
  }
  studio.log.views.clear();
  studio.log.nearest_m = 1e-3;
  studio.image(flying);
  EXPECT_EQ(studio.log.views.size(), static_cast<std::size_t>(kMaxInstants));
  // The nearest point of another body is 4 m away, and turns by 0.25 m.
  studio.log.views.clear();
  studio.image([](double t) {
    return std::vector<Pose>{{{0.0, 0.0, 1.0}, {}},
                             {{4.7, 0.0, 1.0}, uav::from_rpy(0.0, 0.0, 0.5 * t)}};
  });
  EXPECT_EQ(studio.log.views.size(), 1.0 + std::ceil(focal_px * 0.25 / 4.0));
}

TEST(ImageMakerTest, ExposureGivesTheMeanOfTheLight) {
  Studio studio(shutter_world(kWindow_s, 0.0));
  studio.log.paint = paint_progress;
  const uav::CameraSample image = studio.image(flying);
  EXPECT_GT(studio.log.views.size(), 5U);
  for (int row = 0; row < kHeight; ++row) EXPECT_NEAR(light_of_row(image, row), 0.5, 0.005) << row;
}

TEST(ImageMakerTest, EachRowOfARollingShutterHasItsOwnInstant) {
  Studio studio(shutter_world(0.0, kWindow_s));
  studio.log.paint = paint_progress;
  const uav::CameraSample image = studio.image(flying);
  for (int row = 0; row < kHeight; ++row) {
    EXPECT_NEAR(light_of_row(image, row), 0.2 + 0.6 * row / (kHeight - 1), 0.007) << row;
  }
}

TEST(ImageMakerTest, RowsThatAreDrawnAloneLieWhereTheyBelong) {
  Studio studio(shutter_world(0.0, kWindow_s));
  studio.log.paint = paint_row;
  Studio still(small_world());
  still.log.paint = paint_row;
  EXPECT_EQ(studio.image(flying).rgb, still.image(flying).rgb);
  int rows = 0;
  for (const SeenView& seen : studio.log.views) rows += seen.view.camera.height_px;
  EXPECT_LT(rows, kHeight * static_cast<int>(studio.log.views.size()) / 2);
}

TEST(ImageMakerTest, ALensIsMadeFromWholeIdealPictures) {
  Studio studio(lens_world(shutter_world(0.0, kWindow_s)));
  studio.log.paint = [](const View& view, int column, int) {
    return static_cast<std::uint8_t>(
        std::lround(120.0 + 100.0 * (column - view.camera.cx_px) / view.camera.fx_px));
  };
  const uav::CameraSample image = studio.image(flying);
  const ImageWarp warp(camera_of(studio.world).intrinsics);
  EXPECT_GT(studio.log.views.size(), 1U);
  for (const SeenView& seen : studio.log.views) {
    EXPECT_EQ(seen.view.camera.height_px, warp.source().height_px);
    EXPECT_EQ(seen.view.camera.fx_px, seen.view.camera.fy_px);
    EXPECT_FALSE(seen.view.camera.has_distortion());
  }
  for (int column = 0; column < kWidth; ++column) {
    const uav::Vec3 p = camera_of(studio.world).intrinsics.unproject({1.0 * column, 0.0});
    EXPECT_NEAR(image.rgb[static_cast<std::size_t>(3 * column)], 120.0 + 100.0 * p.x, 1.1);
  }
}

TEST(ImageMakerTest, WarnsOnceOfDistortionThatLeavesPixelsBlack) {
  World world = small_world();
  camera_of(world).intrinsics.k1 = -1.0;
  Studio studio(std::move(world));
  studio.image(at_rest);
  studio.image(at_rest);
  EXPECT_THAT(studio.warnings, ::testing::ElementsAre(::testing::HasSubstr("camera 'camera'")));
}

TEST(ImageMakerTest, PixelNoiseDiffersByImageAndSeed) {
  World world = small_world();
  camera_of(world).pixel_noise.stddev = 0.1;
  Studio studio(std::move(world));
  EXPECT_EQ(studio.image(at_rest, 1, 0).rgb, studio.image(at_rest, 1, 0).rgb);
  EXPECT_NE(studio.image(at_rest, 1, 0).rgb, studio.image(at_rest, 1, 1).rgb);
  EXPECT_NE(studio.image(at_rest, 1, 0).rgb, studio.image(at_rest, 2, 0).rgb);
}

}  // namespace
}  // namespace tether::sim
