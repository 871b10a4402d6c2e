#include "sdf_folder.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/units.h>

/// The worlds and models that Tether ships with.
namespace tether::sim {
namespace {

using ::testing::IsEmpty;
using uav::Vec3;

const std::filesystem::path kProject = TETHER_SOURCE_DIR;
const std::filesystem::path kHummingbird = kProject / "data/models/hummingbird/model.sdf";

/// Each world is read once for all of its tests.
const Loaded& load_once(const std::string& world) {
  static std::map<std::string, Loaded> worlds;
  const auto known = worlds.find(world);
  if (known != worlds.end()) return known->second;
  const Vec3 start{world == "room" ? 1.2 : 0.0, 0.0, 1.2};
  return worlds[world] = load({kProject / "data/worlds" / (world + ".sdf"),
                               {{"uav", kHummingbird, start, 0.0}},
                               {"blue_box"}});
}

class ShippedWorld : public ::testing::TestWithParam<const char*> {
 protected:
  const Loaded& loaded_ = load_once(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Worlds, ShippedWorld, ::testing::Values("room", "corridor"),
                         [](const auto& given) { return std::string(given.param); });

TEST_P(ShippedWorld, LoadsWithoutAWarning) {
  EXPECT_THAT(loaded_.warnings, IsEmpty());
  EXPECT_EQ(loaded_.world.step, std::chrono::milliseconds(1));
  EXPECT_DOUBLE_EQ(loaded_.world.gravity_m_s2, 9.81);
}

TEST_P(ShippedWorld, IsLightEnoughToRenderInSoftware) {
  std::size_t visuals = 0;
  std::size_t collisions = 0;
  for (const Model& model : loaded_.world.models) {
    EXPECT_TRUE(model.is_static) << model.name;
    for (const Link& link : model.links) {
      visuals += link.visuals.size();
      collisions += link.collisions.size();
    }
  }
  EXPECT_LE(visuals, 120u);
  EXPECT_LE(collisions, 24u);
  EXPECT_LE(loaded_.world.lights.size(), 4u);
}

TEST_P(ShippedWorld, ShowsTheAnchorFromTheStart) {
  const auto& camera = loaded_.world.uavs.at(0).sensors.at(0);
  const uav::Pose X_WC =
      loaded_.world.uavs[0].X_WB * camera.X_BS * uav::Pose{{}, uav::q_body_from_optical()};
  const auto& model = std::get<CameraModel>(camera.model).intrinsics;
  const auto pixel =
      model.project(uav::transform(uav::inverse(X_WC), loaded_.world.anchors[0].X_WA.p));
  ASSERT_TRUE(pixel.has_value());
  EXPECT_TRUE(model.contains(*pixel));
}

/// Hue in degrees and saturation (HSV) of a colour.
struct HueSaturation {
  double hue_deg = 0.0;
  double saturation = 0.0;
};

HueSaturation hue_saturation(const Vec3& rgb) {
  const double top = std::max({rgb.x, rgb.y, rgb.z});
  const double spread = top - std::min({rgb.x, rgb.y, rgb.z});
  if (spread <= 0.0) return {};
  const double hue = top == rgb.x   ? (rgb.y - rgb.z) / spread
                     : top == rgb.y ? 2.0 + (rgb.z - rgb.x) / spread
                                    : 4.0 + (rgb.x - rgb.y) / spread;
  return {std::fmod(60.0 * hue + 360.0, 360.0), spread / top};
}

TEST_P(ShippedWorld, HasNoOtherSaturatedBlueButHasBluishClutter) {
  bool has_bluish = false;
  for (const Model& model : loaded_.world.models) {
    if (model.name == "blue_box") continue;
    for (const Visual& visual : model.links.at(0).visuals) {
      const HueSaturation colour = hue_saturation(visual.material.diffuse_rgb);
      if (std::abs(colour.hue_deg - 232.0) > 40.0 || colour.saturation == 0.0) continue;
      EXPECT_LT(colour.saturation, 0.35) << model.name << " " << visual.name;
      has_bluish = true;
    }
  }
  EXPECT_TRUE(has_bluish);
}

TEST(ShippedWorlds, CorridorHasTheAnchorOnTheLeftWallEightMetresAlong) {
  const auto anchor = load_once("corridor").world.anchors.at(0);
  EXPECT_EQ(anchor.X_WA.p.x, 8.0);
  EXPECT_NEAR(anchor.X_WA.p.y + 0.5 * anchor.anchor.size_m.y, 1.2, 1e-9);
  EXPECT_EQ(anchor.X_WA.p.z, 1.2);
}

TEST(Hummingbird, IsTheAirframeOfTheUavLibrary) {
  const uav::MultirotorParameters& file = load_once("room").world.uavs.at(0).airframe;
  const uav::MultirotorParameters code = uav::hummingbird();
  EXPECT_EQ(file.mass_kg, code.mass_kg);
  EXPECT_EQ(file.inertia_kg_m2, code.inertia_kg_m2);
  ASSERT_EQ(file.rotors.size(), code.rotors.size());
  for (std::size_t i = 0; i < file.rotors.size(); ++i) {
    EXPECT_EQ(file.rotors[i].p_BR, code.rotors[i].p_BR);
    EXPECT_EQ(file.rotors[i].direction, code.rotors[i].direction);
  }
  for (const auto member :
       {&uav::MultirotorParameters::thrust_coefficient,
        &uav::MultirotorParameters::moment_coefficient_m,
        &uav::MultirotorParameters::drag_coefficient, &uav::MultirotorParameters::linear_drag_N_s_m,
        &uav::MultirotorParameters::max_rotor_speed_rad_s,
        &uav::MultirotorParameters::time_constant_up_s,
        &uav::MultirotorParameters::time_constant_down_s, &uav::MultirotorParameters::max_tilt_rad,
        &uav::MultirotorParameters::max_horizontal_speed_m_s,
        &uav::MultirotorParameters::max_vertical_speed_m_s,
        &uav::MultirotorParameters::max_yaw_rate_rad_s}) {
    EXPECT_EQ(file.*member, code.*member);
  }
}

TEST(Hummingbird, CarriesCameraImuAndRangefinder) {
  const auto& sensors = load_once("room").world.uavs.at(0).sensors;
  ASSERT_EQ(sensors.size(), 3u);
  EXPECT_EQ(sensors[0].name, "camera");
  EXPECT_EQ(sensors[0].update_rate_hz, 30.0);
  EXPECT_EQ(sensors[0].X_BS.p, (Vec3{0.1, 0, 0}));
  const auto& camera = std::get<CameraModel>(sensors[0].model);
  EXPECT_EQ(camera.intrinsics.width_px, 640);
  EXPECT_NEAR(camera.intrinsics.horizontal_fov_rad(), rad_from_deg(80.0), 1e-6);
  EXPECT_EQ(sensors[1].name, "imu");
  EXPECT_GT(std::get<ImuModel>(sensors[1].model).angular_velocity[2].stddev, 0.0);
  EXPECT_EQ(sensors[2].name, "range");
  EXPECT_EQ(std::get<RangeModel>(sensors[2].model).max_m, 4.0);
}

TEST(ShippedFiles, AreSmall) {
  for (const char* name : {"chair/chair.obj", "plant/leaves.obj"}) {
    std::ifstream file(kProject / "data/models" / name);
    int triangles = 0;
    for (std::string line; std::getline(file, line);) triangles += line.starts_with("f ") ? 1 : 0;
    EXPECT_GT(triangles, 0) << name;
    EXPECT_LT(triangles, 500) << name;
  }
  for (const auto& file : std::filesystem::directory_iterator(kProject / "data/models/textures")) {
    EXPECT_LT(file.file_size(), 100'000u) << file.path();
  }
}

TEST(ShippedFiles, AreAllNamedByTheirWorld) {
  const World& world = load_once("room").world;
  EXPECT_TRUE(world.files.contains(kProject / "data/worlds/room.sdf"));
  std::set<std::string> extensions;
  for (const auto& file : world.files) {
    EXPECT_TRUE(std::filesystem::is_regular_file(file)) << file;
    extensions.insert(file.extension().string());
  }
  EXPECT_THAT(extensions, ::testing::IsSupersetOf({".sdf", ".png", ".obj"}));
}

// As worlds from others include them.
TEST(ShippedModels, OfTutorialsAreUsable) {
  const ScratchFolder folder;
  std::string includes;
  for (const char* name : {"sun", "ground_plane", "asphalt_plane", "grass_plane", "cardboard_box",
                           "wood_cube_10cm", "brick_box_3x1x3", "construction_barrel"})
    includes += "<include><uri>model://" + std::string(name) + "</uri></include>";
  WorldRequest request{folder.write("w.sdf", world_sdf(includes)), {}, {}};
  request.options.model_folders = {kProject / "data/models"};
  const Loaded loaded = load(request);
  EXPECT_THAT(loaded.warnings, IsEmpty());
  EXPECT_EQ(loaded.world.models.size(), 7u);
  ASSERT_EQ(loaded.world.lights.size(), 1u);
  EXPECT_TRUE(loaded.world.lights[0].cast_shadows);
}

}  // namespace
}  // namespace tether::sim
