#include "scene.h"
#include "test_simulator.h"

#include <filesystem>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>

#include <tether/base_testing/golden.h>
#include <tether/sim/bodies.h>
#include <tether/sim_raster/renderer.h>

// Pictures of the shipped worlds: the first one of each shipped scenario's camera, and some more.
namespace tether::sim {
namespace {

struct Viewpoint {
  const char* name;
  const char* world;
  uav::Vec3 p_WS;
  double yaw_deg;
  double pitch_deg = 0.0;  // downwards
};

constexpr Viewpoint kViewpoints[] = {
    {"closed_path", "room.sdf", {1.4, -0.6, 1.2}, 0.0},
    {"face_anchor", "room.sdf", {1.2, 0.0, 1.2}, -29.0},
    {"mission", "room.sdf", {1.2, 0.0, 1.2}, -20.0},
    {"relative_position", "room.sdf", {2.2, 0.0, 1.2}, 0.0},
    {"sensor_characterization", "room.sdf", {2.2, 0.0, 1.2}, 90.0},
    {"room_from_above", "room.sdf", {1.0, -1.0, 2.2}, 200.0, 40.0},
    {"move_forward", "corridor.sdf", {0.0, -0.8, 1.2}, 0.0},
    {"corridor_back", "corridor.sdf", {9.0, 0.5, 1.5}, 180.0},
    {"corridor_floor", "corridor.sdf", {4.0, 0.0, 1.5}, 30.0, 60.0},
};

std::uint64_t hash_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211ULL;
  return hash;
}

void write_png(const std::filesystem::path& file, const uav::CameraModel& camera,
               const std::vector<std::uint8_t>& rgb) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.format = PNG_FORMAT_RGB;
  image.width = static_cast<png_uint_32>(camera.width_px);
  image.height = static_cast<png_uint_32>(camera.height_px);
  EXPECT_NE(png_image_write_to_file(&image, file.c_str(), 0, rgb.data(), 0, nullptr), 0) << file;
}

// The UAV, which carries the camera, is not drawn.
std::uint64_t drawn_hash(raster::Renderer& renderer, const std::vector<uav::Pose>& bodies,
                         const Viewpoint& from) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const uav::Quat q_WS = uav::from_axis_angle({0.0, 0.0, 1.0}, from.yaw_deg * kRadians) *
                         uav::from_axis_angle({0.0, 1.0, 0.0}, from.pitch_deg * kRadians);
  const raster::Instant instant{
      uav::Pose{from.p_WS, q_WS} * uav::Pose{{}, uav::q_body_from_optical()}, bodies};
  raster::View view;
  view.camera = uav::CameraModel::from_horizontal_fov(640, 480, 1.396);
  view.instants = {&instant, 1};
  view.hidden = 0;
  std::vector<std::uint8_t> rgb(std::size_t{3} * 640 * 480);
  raster::Picture picture;
  picture.rgb = rgb;
  renderer.draw(view, picture);
  if (!golden_folder().empty()) {
    write_png(golden_folder() / (std::string(from.name) + ".png"), view.camera, rgb);
  }
  return hash_of(rgb);
}

TEST(GoldenPictures, ShippedWorldsLookTheSameOnEveryMachine) {
  GoldenHashes hashes;
  for (const char* name : {"room.sdf", "corridor.sdf"}) {
    const World world = testing::shipped_world(name);
    const raster::Scene scene(make_scene(world, testing::no_warnings()));
    std::vector<uav::Pose> bodies;
    for (const MovingBody& body : moving_bodies(world)) bodies.push_back(body.X_WB);
    raster::Renderer renderer(scene);
    for (const Viewpoint& from : kViewpoints) {
      if (std::string(from.world) != name) continue;
      hashes[from.name] = drawn_hash(renderer, bodies, from);
    }
  }
  expect_golden(std::filesystem::path(TETHER_TEST_DIR) / "data/golden.txt", hashes);
}

}  // namespace
}  // namespace tether::sim
