#include "renderer.h"

#include "scene.h"
#include "test_simulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using testing::box_model;
using testing::box_visual;
using testing::camera_intrinsics;
using testing::no_warnings;
using uav::Pose;
using uav::Vec3;

// A world that shows colours as they are: full ambient light, nothing else.
World flat_world() {
  World world;
  world.ambient_rgb = {1.0, 1.0, 1.0};
  world.background_rgb = {0.0, 0.0, 0.0};
  return world;
}

Renderer renderer_of(const World& world) {
  return Renderer(std::make_shared<const raster::Scene>(make_scene(world, no_warnings())));
}

struct Picture {
  int width_px;
  int height_px;
  std::vector<std::uint8_t> rgb;

  const std::uint8_t* pixel(int column, int row) const {
    return rgb.data() + 3 * static_cast<std::size_t>(row * width_px + column);
  }
};

Picture draw(Renderer& renderer, const uav::CameraModel& camera, const Pose& X_WS,
             const std::vector<Pose>& bodies = {}, std::optional<std::size_t> hidden = {}) {
  Picture picture{camera.width_px, camera.height_px, {}};
  picture.rgb.resize(static_cast<std::size_t>(3 * picture.width_px * picture.height_px));
  const raster::Instant instant{X_WS * Pose{{}, uav::q_body_from_optical()}, bodies};
  raster::View view;
  view.camera = camera;
  view.instants = {&instant, 1};
  view.hidden = hidden;
  raster::Picture into;
  into.rgb = picture.rgb;
  renderer.draw(view, into);
  return picture;
}

Picture render(const World& world, const uav::CameraModel& camera, const Pose& X_WS,
               const std::vector<Pose>& bodies = {}, std::optional<std::size_t> hidden = {}) {
  Renderer renderer = renderer_of(world);
  return draw(renderer, camera, X_WS, bodies, hidden);
}

std::array<int, 3> colour(const Picture& image, int column, int row) {
  const std::uint8_t* p = image.pixel(column, row);
  return {p[0], p[1], p[2]};
}

// One sample a pixel decides it whole; so an edge is seen within half a pixel.
constexpr double kHalfPixel = 0.51;

// The rectangle of red pixels.
struct Rectangle {
  double left, right, top, bottom;
};

Rectangle red_rectangle(const Picture& image) {
  std::vector<double> columns(static_cast<std::size_t>(image.width_px));
  std::vector<double> rows(static_cast<std::size_t>(image.height_px));
  for (int row = 0; row < image.height_px; ++row) {
    for (int column = 0; column < image.width_px; ++column) {
      const double red = image.pixel(column, row)[0] / 255.0;
      auto& c = columns[static_cast<std::size_t>(column)];
      auto& r = rows[static_cast<std::size_t>(row)];
      c = std::max(c, red);
      r = std::max(r, red);
    }
  }
  const auto edges = [](const std::vector<double>& v) {
    const auto is_red = [](double red) { return red > 0.0; };
    const auto first = std::find_if(v.begin(), v.end(), is_red);
    const auto last = std::find_if(v.rbegin(), v.rend(), is_red);
    return std::pair{static_cast<double>(first - v.begin()) - 0.5,
                     static_cast<double>(v.rend() - last) - 0.5};
  };
  const auto [left, right] = edges(columns);
  const auto [top, bottom] = edges(rows);
  return {left, right, top, bottom};
}

// Where a box's front face, facing the camera, must appear.
Rectangle projected_front(const uav::CameraModel& camera, const Pose& X_WS, const Vec3& centre,
                          const Vec3& size) {
  const Pose X_CW = inverse(X_WS * Pose{{}, uav::q_body_from_optical()});
  const double x = centre.x - 0.5 * size.x;
  const auto at = [&](double sign_y, double sign_z) {
    return *camera.project(
        transform(X_CW, {x, centre.y + sign_y * 0.5 * size.y, centre.z + sign_z * 0.5 * size.z}));
  };
  return {at(1, 1).u_px, at(-1, 1).u_px, at(1, 1).v_px, at(1, -1).v_px};
}

void expect_box_where_it_projects(const uav::CameraModel& camera) {
  const Vec3 centre{3.0, 0.35, 1.2};
  const Vec3 size{0.02, 0.5, 0.3};
  World world = flat_world();
  world.models.push_back(box_model("box", centre, size, {1.0, 0.0, 0.0}));
  const Pose X_WS{{0.0, 0.1, 1.0}, {}};
  const Rectangle seen = red_rectangle(render(world, camera, X_WS));
  const Rectangle expected = projected_front(camera, X_WS, centre, size);
  EXPECT_NEAR(seen.left, expected.left, kHalfPixel);
  EXPECT_NEAR(seen.right, expected.right, kHalfPixel);
  EXPECT_NEAR(seen.top, expected.top, kHalfPixel);
  EXPECT_NEAR(seen.bottom, expected.bottom, kHalfPixel);
}

TEST(RendererTest, ABoxAppearsWhereTheCameraModelProjectsIt) {
  expect_box_where_it_projects(camera_intrinsics(640, 480));
  expect_box_where_it_projects(camera_intrinsics(321, 240));
  uav::CameraModel off_centre = camera_intrinsics(320, 240);
  off_centre.cx_px += 37.25;
  off_centre.cy_px -= 18.5;
  expect_box_where_it_projects(off_centre);
}

TEST(RendererTest, DrawsUpToTheFarPlane) {
  for (const auto& [x_m, red] : {std::pair{99.0, 255}, {101.0, 51}}) {
    World world = flat_world();
    world.background_rgb = {0.2, 0.4, 0.8};
    world.models.push_back(box_model("far", {x_m, 0.0, 0.0}, {0.1, 90.0, 90.0}, {1.0, 0.0, 0.0}));
    EXPECT_EQ(colour(render(world, camera_intrinsics(64, 48), {}), 30, 20)[0], red);
  }
}

// Black things are not the background, and neither are those behind glass.
TEST(RendererTest, TheBackgroundShowsThroughGlass) {
  World world = flat_world();
  world.background_rgb = {0.2, 0.4, 0.85};
  const uav::CameraModel camera = camera_intrinsics(65, 49);
  world.models.push_back(box_model("black", {2.0, 0.0, 0.0}, {0.1, 0.2, 0.2}, {}));
  const Picture open = render(world, camera, {});
  world.models.push_back(box_model("glass", {1.0, 0.3, 0.0}, {0.01, 0.2, 0.2}, {1.0, 1.0, 1.0}));
  world.models.back().links[0].visuals[0].material.alpha = 0.2;
  const Picture glazed = render(world, camera, {});
  EXPECT_EQ(colour(open, 32, 24), (std::array{0, 0, 0}));
  EXPECT_EQ(colour(glazed, 32, 24), (std::array{0, 0, 0}));
  EXPECT_EQ(colour(glazed, 2, 2), colour(open, 2, 2));
  const int glass_px = static_cast<int>(camera.cx_px - 0.3 * camera.fx_px);
  EXPECT_GT(colour(glazed, glass_px, 24)[0], colour(open, glass_px, 24)[0]);
  EXPECT_GT(colour(glazed, glass_px, 24)[2], colour(glazed, glass_px, 24)[0]) << "bluish";
}

// quarters.png: red, green (above), blue, white (below).
TEST(RendererTest, ATextureIsUprightAndRepeatsPerMetre) {
  World world = flat_world();
  world.models.push_back(box_model("card", {2.0, 0.0, 0.0}, {0.1, 2.0, 1.0}, {1.0, 1.0, 1.0}));
  Material& material = world.models[0].links[0].visuals[0].material;
  material.albedo_map = std::filesystem::path(TETHER_TEST_DIR) / "data/quarters.png";
  const uav::CameraModel camera = camera_intrinsics(401, 301);
  const Picture image = render(world, camera, {});
  // Seen from the camera, the card's left edge is at y = 1 m; each metre holds one picture.
  const auto at = [&](double right_m, double down_m) {
    const double scale = camera.fx_px / 1.95;
    return colour(image, static_cast<int>(std::lround(camera.cx_px + scale * (right_m - 1.0))),
                  static_cast<int>(std::lround(camera.cy_px + scale * (down_m - 0.5))));
  };
  for (const double metre : {0.0, 1.0}) {
    EXPECT_EQ(at(metre + 0.25, 0.25), (std::array{255, 0, 0}));
    EXPECT_EQ(at(metre + 0.75, 0.25), (std::array{0, 255, 0}));
    EXPECT_EQ(at(metre + 0.25, 0.75), (std::array{0, 0, 255}));
    EXPECT_EQ(at(metre + 0.75, 0.75), (std::array{255, 255, 255}));
  }
}

TEST(RendererTest, EveryShapeIsDrawn) {
  const std::filesystem::path tetra = std::filesystem::path(TETHER_TEST_DIR) / "data/tetra.stl";
  const std::vector<Geometry> shapes{BoxGeometry{{0.5, 0.5, 0.5}},
                                     CylinderGeometry{0.3, 0.5},
                                     SphereGeometry{0.3},
                                     CapsuleGeometry{0.2, 0.3},
                                     EllipsoidGeometry{{0.3, 0.2, 0.4}},
                                     PlaneGeometry{{-1.0, 0.0, 0.0}, 0.5, 0.5},
                                     MeshGeometry{tetra, "", {1.0, 1.0, 1.0}}};
  for (const Geometry& shape : shapes) {
    World world = flat_world();
    world.models.push_back(box_model("shape", {2.0, -0.1, -0.1}, {1.0, 1.0, 1.0}, {0.0, 1.0, 0.0}));
    world.models[0].links[0].visuals[0].geometry = shape;
    EXPECT_EQ(colour(render(world, camera_intrinsics(65, 49), {}), 32, 24), (std::array{0, 255, 0}))
        << shape.index();
  }
}

TEST(RendererTest, LightsShadeByDistanceAndAngle) {
  World world = flat_world();
  world.ambient_rgb = {};
  world.models.push_back(box_model("wall", {2.0, 0.0, 0.0}, {0.1, 8.0, 8.0}, {1.0, 1.0, 1.0}));
  Light lamp;
  lamp.X_WL.p = {1.0, 0.0, 0.0};
  lamp.diffuse_rgb = {0.8, 0.4, 0.0};
  world.lights = {lamp};
  const Picture image = render(world, camera_intrinsics(161, 121), {});
  const auto centre = colour(image, 80, 60);
  EXPECT_NEAR(centre[0], 204, 6);
  EXPECT_NEAR(centre[1], 102, 4);
  EXPECT_EQ(centre[2], 0);
  EXPECT_LT(colour(image, 5, 60)[0], 150);
}

TEST(RendererTest, MovingBodiesFollowTheirPoseAndMayBeHidden) {
  World world = flat_world();
  Uav uav;
  uav.body.visuals.push_back(box_visual({0.2, 0.2, 0.2}, {1.0, 0.0, 0.0}));
  world.uavs = {uav};
  const uav::CameraModel camera = camera_intrinsics(65, 49);
  const std::vector<Pose> ahead{{{2.0, 0.0, 0.0}, {}}};
  const std::vector<Pose> aside{{{2.0, 0.5, 0.0}, {}}};
  EXPECT_EQ(colour(render(world, camera, {}, ahead), 32, 24)[0], 255);
  EXPECT_EQ(colour(render(world, camera, {}, aside), 32, 24)[0], 0);
  EXPECT_EQ(colour(render(world, camera, {}, ahead, 0), 32, 24)[0], 0);
}

TEST(RendererTest, SameInputSameBytesInAnyThread) {
  World world = flat_world();
  world.ambient_rgb = {0.3, 0.3, 0.3};
  world.models.push_back(box_model("box", {2.0, 0.3, 0.1}, {0.5, 0.5, 0.5}, {0.7, 0.3, 0.2}));
  world.models.back().links[0].visuals[0].material.albedo_map =
      std::filesystem::path(TETHER_TEST_DIR) / "data/quarters.png";
  world.lights.resize(2);
  const uav::CameraModel camera = camera_intrinsics(320, 240);
  const Pose X_WS{{0.0, 0.0, 0.1}, {}};
  Renderer a = renderer_of(world);
  Renderer b = renderer_of(world);
  const std::vector<std::uint8_t> first = draw(a, camera, X_WS).rgb;
  EXPECT_TRUE(first == draw(b, camera, X_WS).rgb);
  EXPECT_TRUE(first == draw(a, camera, X_WS).rgb);
  std::thread other([&] { EXPECT_TRUE(first == draw(a, camera, X_WS).rgb); });
  other.join();
}

}  // namespace
}  // namespace tether::sim
