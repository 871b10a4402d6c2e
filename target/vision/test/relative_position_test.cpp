#include <cmath>

#include <gmock/gmock.h>

#include <tether/base/units.h>
#include <tether/vision/anchor_tracker.h>
#include <tether/vision/testing/synthetic_scene.h>

namespace tether::vision {
namespace {

const uav::Anchor kBox{"box", uav::AnchorShape::kBox, {0.6, 0.6, 0.6}, {0.1, 0.2, 0.9}};

uav::SensorDescription camera(double fov_deg = 80) {
  return {"camera",
          {},
          30.0,
          uav::CameraProperties{
              uav::CameraModel::from_horizontal_fov(640, 480, rad_from_deg(fov_deg))}};
}

const uav::CameraModel& model_of(const uav::SensorDescription& camera) {
  return std::get<uav::CameraProperties>(camera.properties).model;
}

struct View {
  double bearing_deg;  // of the anchor
  double distance_m;   // to its centre, horizontally
  double turned_deg;   // the anchor about its own axis
  double above_m;      // the camera above the anchor's centre
};

std::optional<RelativePosition> look(const uav::SensorDescription& camera, const View& view,
                                     double noise = 0.0) {
  testing::SyntheticScene scene;
  const double bearing = rad_from_deg(view.bearing_deg);
  scene.boxes = {{{view.distance_m * std::cos(bearing), view.distance_m * std::sin(bearing), 0},
                  bearing + rad_from_deg(view.turned_deg),
                  kBox.size_m,
                  kBox.color_rgb}};
  scene.noise_stddev = noise;
  const auto image =
      scene.render(model_of(camera), testing::level_camera({0, 0, view.above_m}, 0.0));
  Result<AnchorTracker> tracker = AnchorTracker::create(kBox);
  const auto roi = tracker->track(image);
  if (!roi) return std::nullopt;
  return relative_position(camera, kBox, *roi);
}

/// Half a pixel at the image's centre.
double half_pixel_rad(const uav::SensorDescription& camera) {
  return std::atan(0.5 / model_of(camera).fx_px);
}

TEST(RelativePosition, IsWithinHalfAPixelAndAFewPercentFromAnySide) {
  for (const double bearing : {-30.0, -12.0, 3.3, 28.0}) {
    for (const double turned : {0.0, 20.0, 45.0}) {
      for (const double distance : {2.0, 4.0, 8.0}) {
        SCOPED_TRACE(::testing::Message() << bearing << " " << turned << " " << distance);
        const auto p = look(camera(), {bearing, distance, turned, 0});
        ASSERT_TRUE(p && p->distance_m);
        EXPECT_NEAR(*p->distance_m, distance, 0.05 + 0.025 * distance);
        // Turned, its silhouette is not symmetric about its centre.
        if (turned != 0.0) continue;
        EXPECT_NEAR(p->bearing_rad, rad_from_deg(bearing), half_pixel_rad(camera()));
      }
    }
  }
}

TEST(RelativePosition, NoiseBlursItLittle) {
  for (const double bearing : {-20.0, 10.0}) {
    const auto p = look(camera(), {bearing, 4.0, 0, 0}, 5.0);
    ASSERT_TRUE(p && p->distance_m);
    EXPECT_NEAR(p->bearing_rad, rad_from_deg(bearing), 2 * half_pixel_rad(camera()));
    EXPECT_NEAR(*p->distance_m, 4.0, 0.2);
  }
}

TEST(RelativePosition, UndoesTheLens) {
  uav::SensorDescription wide = camera(95);
  auto& model = std::get<uav::CameraProperties>(wide.properties).model;
  model.k1 = -0.2;
  model.k2 = 0.05;
  model.k3 = -0.01;
  model.p1 = 0.002;
  model.p2 = -0.003;
  for (const double bearing : {-35.0, -15.0, 25.0}) {
    const auto p = look(wide, {bearing, 4.0, 0, 0.4});
    ASSERT_TRUE(p && p->distance_m);
    EXPECT_NEAR(p->bearing_rad, rad_from_deg(bearing), 2 * half_pixel_rad(wide));
    EXPECT_NEAR(*p->distance_m, 4.0, 0.25);
  }
}

TEST(RelativePosition, CountsTheMountingOfTheCamera) {
  uav::SensorDescription sideways = camera();
  sideways.X_BS.q = uav::from_rpy(0, 0, rad_from_deg(30));
  Roi roi;
  roi.center = {model_of(sideways).cx_px, model_of(sideways).cy_px};
  roi.width_px = 50;
  roi.edge_height_px = 50;
  EXPECT_NEAR(relative_position(sideways, kBox, roi).bearing_rad, rad_from_deg(30), 1e-12);

  // Pitched down, the same edge seen at the same distance has the same height in the world.
  uav::SensorDescription down = camera();
  down.X_BS.q = uav::from_rpy(0, rad_from_deg(20), 0);
  const auto pixel_of = [&down](double z) {
    const uav::Quat q_CB = inverse(down.X_BS.q * uav::q_body_from_optical());
    return *model_of(down).project(rotate(q_CB, {4.0, 0, z}));
  };
  const uav::Pixel top = pixel_of(-0.7);
  const uav::Pixel bottom = pixel_of(-1.3);
  roi.center = {top.u_px, 0.5 * (top.v_px + bottom.v_px)};
  roi.edge_height_px = bottom.v_px - top.v_px;
  EXPECT_NEAR(*relative_position(down, kBox, roi).distance_m, 4.0 + 0.43 * 0.6, 1e-9);
}

TEST(RelativePosition, NoDistanceFromAHeightThatIsCutOff) {
  Roi roi;
  roi.center = {320, 20};
  roi.edge_height_px = 40;
  EXPECT_TRUE(relative_position(camera(), kBox, roi).distance_m);
  roi.cut_above_or_below = true;
  EXPECT_FALSE(relative_position(camera(), kBox, roi).distance_m);
}

}  // namespace
}  // namespace tether::vision
