#include "image_maker.h"

#include "fake_back_end.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_sensing/state_layout.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::DrawLog;
using testing::kCamera;
using uav::Pose;

constexpr int kFlownSteps = 20;

// One UAV and a loose box.
World small_world() {
  World world = testing::test_world();
  world.models.push_back(testing::box_model("loose", {}, {}, {}, false));
  world.uavs[0].sensors[kCamera] = testing::camera_sensor("camera", 16, 12);
  return world;
}

CameraModel& camera_of(World& world) {
  return std::get<CameraModel>(world.uavs[0].sensors[kCamera].model);
}

// Where the UAV and the box are at step `k` of a flight.
std::vector<Pose> flying(int k) {
  return {{{0.1 * k, 0.0, 1.0}, {}}, {{-50.0, 0.0, 0.5 * k}, {}}};
}

// The images of a world's first camera at the end of a flight of kFlownSteps.
struct Camera {
  World world;
  DrawLog log;
  std::vector<std::string> warnings;
  ImageMaker maker;

  explicit Camera(World w)
      : world(std::move(w)),
        maker(world, testing::fake_renderers(log), nullptr,
              [this](const Warning& warning) { warnings.push_back(to_line(warning)); }) {}

  uav::CameraSample image(std::uint64_t seed = 0, std::uint64_t index = 0) {
    StateRecorder recorder(world);
    recorder.reset(flying(0));
    for (int k = 0; k < kFlownSteps; ++k) recorder.begin_step(flying(k));
    std::vector<double> state;
    recorder.capture(flying(kFlownSteps), std::vector<BodyMotion>(1), state);
    const Sensor& sensor = world.uavs[0].sensors[kCamera];
    const MeasurementKey key{seed, "alpha", "camera", index, SimTime(std::chrono::seconds(3))};
    return maker.make(camera_of(world), {state, 0, sensor, key});
  }
};

TEST(ImageMakerTest, AnImageIsThePictureThatTheRendererDraws) {
  Camera shot(small_world());
  shot.log.grey = 77;
  EXPECT_EQ(shot.maker.renderer_name(), "");
  EXPECT_EQ(shot.log.made, 0);
  shot.image();
  const uav::CameraSample image = shot.image(0, 4);
  EXPECT_EQ(shot.log.made, 1);
  EXPECT_EQ(shot.maker.renderer_name(), "fake");
  EXPECT_EQ(image.index, 4U);
  EXPECT_EQ(image.sampled_at, SimTime(std::chrono::seconds(3)));
  EXPECT_EQ(image.width_px, 16);
  EXPECT_EQ(image.height_px, 12);
  EXPECT_EQ(image.rgb, std::vector<std::uint8_t>(std::size_t{3} * 16 * 12, 77));
  const DrawLog::Drawn& drawn = shot.log.drawn.at(1);
  EXPECT_EQ(drawn.view.camera, camera_of(shot.world).intrinsics);
  EXPECT_EQ(drawn.view.near_m, camera_of(shot.world).near_m);
  EXPECT_EQ(drawn.view.far_m, camera_of(shot.world).far_m);
  EXPECT_EQ(drawn.view.hidden, 0U);
  EXPECT_FALSE(drawn.view.antialias);
}

// Step by step, from the last that is not after the shutter's window begins.
TEST(ImageMakerTest, APictureHasTheStepsOfItsShutter) {
  for (const auto& [exposure_s, readout_s, steps] :
       {std::tuple{0.0, 0.0, 0}, {0.002, 0.0, 2}, {0.0, 0.0021, 3}, {0.004, 0.0155, 20}}) {
    World world = small_world();
    camera_of(world).exposure_s = exposure_s;
    camera_of(world).readout_s = readout_s;
    Camera shot(std::move(world));
    shot.image();
    const DrawLog::Drawn& drawn = shot.log.drawn.at(0);
    EXPECT_EQ(drawn.view.exposure_s, exposure_s);
    EXPECT_EQ(drawn.view.readout_s, readout_s);
    EXPECT_EQ(drawn.view.spacing_s, 0.001);
    ASSERT_EQ(drawn.X_WC.size(), static_cast<std::size_t>(steps + 1));
    const Pose X_BC =
        shot.world.uavs[0].sensors[kCamera].X_BS * Pose{{}, uav::q_body_from_optical()};
    for (int i = 0; i <= steps; ++i) {
      const std::vector<Pose> X_WB = flying(kFlownSteps - steps + i);
      EXPECT_EQ(drawn.X_WB.at(static_cast<std::size_t>(i)), X_WB);
      EXPECT_EQ(drawn.X_WC.at(static_cast<std::size_t>(i)), X_WB[0] * X_BC);
    }
  }
}

TEST(ImageMakerTest, WarnsOnceOfDistortionThatLeavesPixelsBlack) {
  World world = small_world();
  camera_of(world).intrinsics.k1 = -1.0;
  Camera shot(std::move(world));
  shot.log.blind_pixels = 9;
  shot.image();
  shot.image();
  EXPECT_THAT(shot.warnings, ::testing::ElementsAre(::testing::HasSubstr("camera 'camera'")));
}

// Each kind in one picture, with the truth about the anchor if the renderer knows it.
TEST(ImageMakerTest, ACameraMeasuresWhatItsKindSays) {
  using uav::CameraKind;
  constexpr std::size_t kPixels = 16 * 12;
  for (const auto kind :
       {CameraKind::kColor, CameraKind::kDepth, CameraKind::kRgbd, CameraKind::kSegmentation}) {
    World world = small_world();
    world.anchors.emplace_back().anchor.name = world.models.at(0).name;
    camera_of(world).kind = kind;
    camera_of(world).depth_max_m = 10.0;
    Camera shot(std::move(world));
    shot.log.knows_pixels = true;
    shot.log.depth_m = 3.0F;
    shot.log.model = 1;
    const uav::CameraSample image = shot.image();
    EXPECT_EQ(image.rgb.size(), uav::has_color(kind) ? 3 * kPixels : 0);
    EXPECT_EQ(image.depth_m, std::vector(uav::has_depth(kind) ? kPixels : 0, 3.0F));
    EXPECT_EQ(image.labels,
              std::vector(kind == CameraKind::kSegmentation ? kPixels : 0, std::uint16_t{1}));
    EXPECT_TRUE(image.knows_anchors);
    ASSERT_EQ(image.seen_anchors.size(), 1U);
    EXPECT_EQ(image.seen_anchors[0].pixels, static_cast<std::int64_t>(kPixels));
    EXPECT_EQ(shot.log.drawn.size(), 1U);
  }
}

TEST(ImageMakerTest, ARendererOfColoursKnowsNoAnchors) {
  World world = small_world();
  world.anchors.emplace_back().anchor.name = world.models.at(0).name;
  const uav::CameraSample image = Camera(std::move(world)).image();
  EXPECT_FALSE(image.knows_anchors);
  EXPECT_TRUE(image.seen_anchors.empty());
}

// Anchors and depths are those of the centre of each pixel, which antialiasing does not sample.
TEST(ImageMakerTest, OnlyColoursAreAntialiased) {
  using uav::CameraKind;
  for (const bool knows_pixels : {false, true}) {
    for (const auto kind : {CameraKind::kColor, CameraKind::kRgbd}) {
      if (kind == CameraKind::kRgbd && !knows_pixels) continue;
      World world = small_world();
      world.anchors.emplace_back().anchor.name = world.models.at(0).name;
      camera_of(world).kind = kind;
      camera_of(world).antialias = true;
      Camera shot(std::move(world));
      shot.log.knows_pixels = knows_pixels;
      shot.image();
      ASSERT_EQ(shot.log.drawn.size(), knows_pixels ? 2U : 1U);
      const DrawLog::Drawn& colors = shot.log.drawn[0];
      EXPECT_TRUE(colors.view.antialias);
      EXPECT_TRUE(colors.has_rgb && !colors.has_depth && !colors.has_models);
      if (!knows_pixels) continue;
      const DrawLog::Drawn& rest = shot.log.drawn[1];
      EXPECT_FALSE(rest.view.antialias);
      EXPECT_TRUE(!rest.has_rgb && rest.has_models);
      EXPECT_EQ(rest.has_depth, kind == CameraKind::kRgbd);
    }
  }
}

TEST(ImageMakerTest, PixelNoiseDiffersByImageAndSeed) {
  World world = small_world();
  camera_of(world).pixel_noise.stddev = 0.1;
  Camera shot(std::move(world));
  shot.log.grey = 100;
  EXPECT_EQ(shot.image(1, 0).rgb, shot.image(1, 0).rgb);
  EXPECT_NE(shot.image(1, 0).rgb, shot.image(1, 1).rgb);
  EXPECT_NE(shot.image(1, 0).rgb, shot.image(2, 0).rgb);
}

}  // namespace
}  // namespace tether::sim
