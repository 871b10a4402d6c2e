// Depths, labels and the truth about anchors, against known geometry.

#include <cmath>

#include <gtest/gtest.h>

#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::box_model;
using testing::kCamera;
using testing::measure_now;
using uav::CameraKind;
using uav::Vec3;

constexpr double kSlab_m = 5.0;

// A wall ahead, in front of it a box that hides the left part of another, and an unseen one behind.
World walled_world(CameraKind kind) {
  World world;
  world.uavs.push_back(testing::test_uav("alpha", {0.0, 0.0, 1.0}));
  Sensor& sensor = world.uavs[0].sensors[kCamera];
  sensor = testing::camera_sensor("camera", 160, 120);
  sensor.X_BS = {};
  auto& camera = std::get<CameraModel>(sensor.model);
  camera.kind = kind;
  camera.depth_min_m = 0.2;
  camera.depth_max_m = 50.0;
  const Vec3 grey{0.5, 0.5, 0.5};
  world.models = {box_model("wall", {kSlab_m + 0.5, 0.0, 1.0}, {1.0, 8.0, 2.0}, grey),
                  box_model("far", {4.0, 0.0, 1.0}, {0.4, 1.0, 1.0}, grey),
                  box_model("near", {2.0, 0.5, 1.0}, {0.4, 1.0, 1.0}, grey),
                  box_model("behind", {kSlab_m + 3.0, 0.0, 1.0}, {0.4, 0.4, 0.4}, grey)};
  for (const char* name : {"far", "near", "behind"})
    world.anchors.emplace_back().anchor.name = name;
  return world;
}

CameraModel& eye_of(World& world) {
  return std::get<CameraModel>(world.uavs[0].sensors[kCamera].model);
}

uav::CameraSample image_of(World world) {
  const auto simulator = make_mujoco_simulator(std::move(world), [](const Warning&) {});
  return measure_now<uav::CameraSample>(*simulator, kCamera);
}

std::size_t pixel_at(const uav::CameraSample& image, int u_px, int v_px) {
  return static_cast<std::size_t>(v_px * image.width_px + u_px);
}

// The wall is slanted against the camera, through a lens too: the depth of each pixel is that of
// its viewing direction.
TEST(Depth, IsThatOfTheGeometry) {
  for (const double k1 : {0.0, -0.15}) {
    for (const double yaw_rad : {0.0, 0.4}) {
      World world = walled_world(CameraKind::kDepth);
      world.models.resize(1);
      world.anchors.clear();
      eye_of(world).intrinsics.k1 = k1;
      world.uavs[0].sensors[kCamera].X_BS.q = uav::from_rpy(0.0, 0.1, yaw_rad);
      const uav::CameraModel lens = eye_of(world).intrinsics;
      const uav::Quat q_WC = world.uavs[0].sensors[kCamera].X_BS.q * uav::q_body_from_optical();
      const uav::CameraSample image = image_of(world);
      ASSERT_TRUE(image.rgb.empty());
      int on_wall = 0;
      for (int v = 0; v < lens.height_px; v += 3) {
        for (int u = 0; u < lens.width_px; ++u) {
          const Vec3 ray_W = rotate(q_WC, lens.unproject({double(u), double(v)}));  // NOLINT
          const double depth_m = kSlab_m / ray_W.x;
          const Vec3 hit = depth_m * ray_W;
          const bool is_inside = std::abs(hit.y) < 3.9 && std::abs(hit.z) < 0.9;
          if (!is_inside) continue;
          ++on_wall;
          ASSERT_NEAR(image.depth_m[pixel_at(image, u, v)], depth_m, 1e-4 * depth_m)
              << u << " " << v;
        }
      }
      EXPECT_GT(on_wall, 1000);
    }
  }
}

TEST(Depth, IsInfiniteWhereThereIsNothingOrItIsTooNear) {
  World world = walled_world(CameraKind::kRgbd);
  eye_of(world).depth_max_m = 4.5;
  eye_of(world).depth_min_m = 1.9;
  const uav::CameraSample image = image_of(world);
  EXPECT_FALSE(image.rgb.empty());
  constexpr float kInf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(image.depth_m[pixel_at(image, 80, 0)], kInf);    // nothing
  EXPECT_EQ(image.depth_m[pixel_at(image, 130, 60)], kInf);  // the wall, beyond the maximum
  EXPECT_EQ(image.depth_m[pixel_at(image, 70, 60)], -kInf);  // the near box at 1.8 m
  EXPECT_NEAR(image.depth_m[pixel_at(image, 85, 60)], 3.8, 1e-3);
}

TEST(Depth, IsNotANumberWhereTheLensSeesNothing) {
  World world = walled_world(CameraKind::kDepth);
  eye_of(world).intrinsics = uav::CameraModel::from_horizontal_fov(160, 120, 1.5);
  eye_of(world).intrinsics.k1 = -1.0;
  const uav::CameraSample image = image_of(world);
  EXPECT_TRUE(std::isnan(image.depth_m[0]));
  EXPECT_FALSE(std::isnan(image.depth_m[pixel_at(image, 80, 60)]));
}

TEST(Depth, SeesWhatIsBeforeTheNearPlaneAsTooNear) {
  World world = walled_world(CameraKind::kDepth);
  eye_of(world).near_m = eye_of(world).depth_min_m = 3.0;
  EXPECT_EQ(image_of(world).depth_m[60 * 160 + 70], -std::numeric_limits<float>::infinity());
}

TEST(Segmentation, ShowsTheNumberOfEachPixelsModel) {
  const World world = walled_world(CameraKind::kSegmentation);
  const uav::CameraSample image = image_of(world);
  const std::vector<std::string> names = model_names(world);
  const auto shown = [&](int u_px, int v_px) {
    const std::size_t label = image.labels.at(pixel_at(image, u_px, v_px));
    return label == 0 ? "" : names.at(label - 1);
  };
  EXPECT_EQ(shown(80, 0), "");
  EXPECT_EQ(shown(130, 60), "wall");
  EXPECT_EQ(shown(70, 60), "near");
  EXPECT_EQ(shown(85, 60), "far");
}

// "far" is 1 m wide at 3.8 m, centred, and hidden left of the middle by "near"; "behind" is hidden.
TEST(SeenAnchors, AreWhatIsNotHidden) {
  for (const auto kind : {CameraKind::kColor, CameraKind::kDepth}) {
    World world = walled_world(kind);
    const uav::CameraModel lens = eye_of(world).intrinsics;
    const auto image = image_of(std::move(world));
    ASSERT_TRUE(image.knows_anchors);
    ASSERT_EQ(image.seen_anchors.size(), 2U);
    const uav::SeenAnchor& far = image.seen_anchors[0];
    EXPECT_EQ(far.anchor, "far");
    EXPECT_EQ(far.left_px, static_cast<int>(std::ceil(lens.cx_px)));
    const double half_px = lens.fx_px * 0.5 / 3.8;
    EXPECT_NEAR(far.right_px + 0.5, lens.cx_px + half_px, 0.51);
    EXPECT_NEAR(far.top_px - 0.5, lens.cy_px - half_px, 0.51);
    EXPECT_NEAR(far.bottom_px + 0.5, lens.cy_px + half_px, 0.51);
    EXPECT_EQ(far.pixels,
              std::int64_t{far.right_px - far.left_px + 1} * (far.bottom_px - far.top_px + 1));
    EXPECT_EQ(image.seen_anchors[1].anchor, "near");
  }
}

// A metric compares the edges of what is seen with the geometry, to less than a pixel.
TEST(SeenAnchors, AndDepthsAreTheSameInAnAntialiasedImage) {
  World world = walled_world(CameraKind::kRgbd);
  world.uavs[0].sensors[kCamera].X_BS.q = uav::from_rpy(0.1, 0.1, 0.2);
  const uav::CameraSample plain = image_of(world);
  eye_of(world).antialias = true;
  const uav::CameraSample smooth = image_of(world);
  EXPECT_NE(smooth.rgb, plain.rgb);
  EXPECT_EQ(smooth.depth_m, plain.depth_m);
  EXPECT_EQ(smooth.seen_anchors, plain.seen_anchors);
  EXPECT_FALSE(plain.seen_anchors.empty());
}

}  // namespace
}  // namespace tether::sim
