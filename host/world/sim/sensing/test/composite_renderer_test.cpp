#include "composite_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using uav::Pose;

constexpr int kWidth = 16;
constexpr int kHeight = 12;
constexpr double kWindow_s = 0.02;
constexpr int kSteps = 20;

// A view with a copy of its poses.
struct SeenView {
  View view;
  std::vector<Pose> X_WB;
};

struct ViewLog {
  int depths = 0;  // how often the depth was asked for
  std::vector<SeenView> views;
  double nearest_m = 1.0;
  // The grey of a pixel; `row` as in the picture that is drawn.
  std::function<std::uint8_t(const View& view, int column, int row)> paint =
      [](const View&, int, int) { return std::uint8_t{0}; };
};

class FakeViews final : public ViewRenderer {
 public:
  explicit FakeViews(ViewLog& log) : log_(log) {}

  void render(const View& view, std::span<std::uint8_t> rgb) override {
    log_.views.push_back({view, {view.X_WB.begin(), view.X_WB.end()}});
    EXPECT_EQ(rgb.size(),
              static_cast<std::size_t>(3 * view.camera.width_px * view.camera.height_px));
    std::uint8_t* out = rgb.data();
    for (int row = 0; row < view.camera.height_px; ++row) {
      for (int column = 0; column < view.camera.width_px; ++column) {
        out = std::fill_n(out, 3, log_.paint(view, column, row));
      }
    }
  }

  double nearest_depth_m() override {
    EXPECT_TRUE(log_.views.back().view.with_depth);
    ++log_.depths;
    return log_.nearest_m;
  }

  std::string name() const override { return "fake"; }

 private:
  ViewLog& log_;
};

uav::CameraModel bent(uav::CameraModel camera) {
  camera.k1 = -0.2;
  camera.fy_px *= 1.2;
  return camera;
}

// Where a UAV and a loose box of 0.5 m radius are over the window: 0 at its beginning, 1 at its
// end.
using Course = std::function<std::array<Pose, 2>(double)>;

std::array<Pose, 2> at_rest(double) {
  return {{{{0.0, 0.0, 1.0}, {}}, {{-50.0, 0.0, 0.0}, {}}}};
}
// One metre along x.
std::array<Pose, 2> flying(double t) {
  return {{{{t, 0.0, 1.0}, {}}, {{-50.0, 0.0, 0.0}, {}}}};
}

// Pictures that are put together over a course of kSteps.
struct Studio {
  Studio(double exposure_s, double readout_s) {
    view.camera = testing::camera_intrinsics(kWidth, kHeight);
    view.spacing_s = kWindow_s / kSteps;
    view.exposure_s = exposure_s;
    view.readout_s = readout_s;
    view.hidden = 0;
  }

  std::vector<std::uint8_t> picture(const Course& course) {
    std::vector<std::array<Pose, 2>> poses;
    for (int i = 0; i <= kSteps; ++i) poses.push_back(course(1.0 * i / kSteps));
    std::vector<raster::Instant> instants;
    for (const auto& X_WB : poses) {
      instants.push_back({X_WB[0] * Pose{{}, uav::q_body_from_optical()}, X_WB});
    }
    view.instants = instants;
    std::vector<std::uint8_t> rgb(
        static_cast<std::size_t>(3 * view.camera.width_px * view.camera.height_px));
    raster::Picture into;
    into.rgb = rgb;
    renderer->draw(view, into);
    return rgb;
  }

  ViewLog log;
  raster::View view;
  std::unique_ptr<CameraRenderer> renderer =
      make_composite_renderer(std::make_unique<FakeViews>(log), {0.3, 0.5});
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
  return byte_of(0.2 + 0.6 * (view.X_WS.p.x));
}
// A grey that tells the row of the whole image, whichever part of it is drawn.
std::uint8_t paint_row(const View& view, int, int row) {
  const double below_axis = row - view.camera.cy_px;
  return static_cast<std::uint8_t>(std::lround(100.0 + 10.0 * below_axis));
}

double light_of_row(const std::vector<std::uint8_t>& rgb, int row) {
  return light(rgb[static_cast<std::size_t>(3 * kWidth * row)]);
}

TEST(CompositeRenderer, WithoutAShutterAPictureIsOneView) {
  Studio studio(0.0, 0.0);
  studio.log.paint = [](const View&, int column, int row) {
    return static_cast<std::uint8_t>(16 * row + column);
  };
  const std::vector<std::uint8_t> rgb = studio.picture(flying);
  for (std::size_t i = 0; i < rgb.size(); ++i) EXPECT_EQ(rgb[i], i / 3);
  ASSERT_EQ(studio.log.views.size(), 1U);
  const SeenView& seen = studio.log.views[0];
  EXPECT_EQ(seen.view.camera, studio.view.camera);
  EXPECT_EQ(seen.view.near_m, studio.view.near_m);
  EXPECT_EQ(seen.view.far_m, studio.view.far_m);
  EXPECT_EQ(seen.view.X_WS, (Pose{{1.0, 0.0, 1.0}, {}}));
  EXPECT_EQ(seen.X_WB, (std::vector<Pose>{flying(1.0)[0], flying(1.0)[1]}));
  EXPECT_EQ(seen.view.hidden, 0U);
  EXPECT_FALSE(seen.view.with_depth);
  EXPECT_EQ(studio.log.depths, 0);
  EXPECT_EQ(studio.renderer->name(), "fake");
}

TEST(CompositeRenderer, TheLargestViewHasRoomForEachLens) {
  World world = testing::test_world();
  EXPECT_EQ(largest_view(world).width_px, 160);
  Sensor wide = testing::camera_sensor("wide", 64, 600);
  std::get<CameraModel>(wide.model).intrinsics.k1 = 0.1;
  world.uavs[0].sensors.push_back(wide);
  const ImageWarp warp(std::get<CameraModel>(wide.model).intrinsics);
  EXPECT_EQ(largest_view(world).width_px, std::max(160, warp.source().width_px));
  EXPECT_EQ(largest_view(world).height_px, warp.source().height_px);
}

TEST(CompositeRenderer, AtRestOneViewIsEnough) {
  Studio studio(0.01, 0.01);
  studio.log.paint = paint_row;
  Studio without(0.0, 0.0);
  without.log.paint = paint_row;
  EXPECT_EQ(studio.picture(at_rest), without.picture(at_rest));
  EXPECT_EQ(studio.log.views.size(), 1U);
  EXPECT_EQ(studio.log.depths, 1);
}

TEST(CompositeRenderer, DrawsAViewForEachPixelOfMotion) {
  Studio studio(kWindow_s, 0.0);
  const double focal_px = studio.view.camera.fx_px;
  for (const double pixels : {0.5, 3.5, 9.2}) {
    studio.log.views.clear();
    studio.log.nearest_m = focal_px / pixels;
    studio.picture(flying);
    EXPECT_EQ(studio.log.views.size(), 1.0 + std::ceil(pixels));
  }
  studio.log.views.clear();
  studio.log.nearest_m = 1e-3;
  studio.picture(flying);
  EXPECT_EQ(studio.log.views.size(), 32U);
}

TEST(CompositeRenderer, ExposureGivesTheMeanOfTheLight) {
  Studio studio(kWindow_s, 0.0);
  studio.log.paint = paint_progress;
  const auto rgb = studio.picture(flying);
  EXPECT_GT(studio.log.views.size(), 5U);
  for (int row = 0; row < kHeight; ++row) EXPECT_NEAR(light_of_row(rgb, row), 0.5, 0.005) << row;
}

TEST(CompositeRenderer, EachRowOfARollingShutterHasItsOwnInstant) {
  Studio studio(0.0, kWindow_s);
  studio.log.paint = paint_progress;
  const auto rgb = studio.picture(flying);
  for (int row = 0; row < kHeight; ++row) {
    EXPECT_NEAR(light_of_row(rgb, row), 0.2 + 0.6 * row / (kHeight - 1), 0.007) << row;
  }
}

TEST(CompositeRenderer, RowsThatAreDrawnAloneLieWhereTheyBelong) {
  Studio studio(0.0, kWindow_s);
  studio.log.paint = paint_row;
  Studio still(0.0, 0.0);
  still.log.paint = paint_row;
  EXPECT_EQ(studio.picture(flying), still.picture(flying));
  int rows = 0;
  for (const SeenView& seen : studio.log.views) rows += seen.view.camera.height_px;
  EXPECT_LT(rows, kHeight * static_cast<int>(studio.log.views.size()) / 2);
}

TEST(CompositeRenderer, ALensIsMadeFromWholeIdealViews) {
  Studio studio(0.0, kWindow_s);
  studio.view.camera = bent(studio.view.camera);
  studio.log.paint = [](const View& view, int column, int) {
    return static_cast<std::uint8_t>(
        std::lround(120.0 + 100.0 * (column - view.camera.cx_px) / view.camera.fx_px));
  };
  const auto rgb = studio.picture(flying);
  const ImageWarp warp(studio.view.camera);
  EXPECT_GT(studio.log.views.size(), 1U);
  for (const SeenView& seen : studio.log.views) EXPECT_EQ(seen.view.camera, warp.source());
  for (int column = 0; column < kWidth; ++column) {
    const uav::Vec3 p = studio.view.camera.unproject({1.0 * column, 0.0});
    EXPECT_NEAR(rgb[static_cast<std::size_t>(3 * column)], 120.0 + 100.0 * p.x, 1.1);
  }
  EXPECT_EQ(studio.renderer->blind_pixels(studio.view.camera), 0U);
  studio.view.camera.k1 = -1.0;
  EXPECT_GT(studio.renderer->blind_pixels(studio.view.camera), 0U);
}

}  // namespace
}  // namespace tether::sim
