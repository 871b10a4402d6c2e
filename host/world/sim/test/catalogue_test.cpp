#include <gtest/gtest.h>

#include <tether/sim/world.h>
#include <tether/sim_testing/fake_simulator.h>

namespace tether::sim {
namespace {

TEST(Catalogue, ListsSensorsAndAnchorsWithTheirProperties) {
  World world = make_fake_world(2);
  Sensor& camera = world.uavs[1].sensors[0];
  camera.X_BS = {{0.1, 0.0, 0.2}, uav::from_rpy(0.0, 0.3, 0.0)};
  std::get<CameraModel>(camera.model).intrinsics.k1 = -0.1;
  std::get<RangeModel>(world.uavs[1].sensors[2].model).min_m = 0.25;

  const uav::Catalogue catalogue = make_catalogue(world, world.uavs[1]);
  EXPECT_EQ(catalogue.uav, "uav1");
  ASSERT_EQ(catalogue.sensors.size(), 3u);
  const uav::SensorDescription& first = catalogue.sensors[0];
  EXPECT_EQ(first.name, "camera");
  EXPECT_EQ(first.kind(), uav::SensorKind::kCamera);
  EXPECT_EQ(first.X_BS, camera.X_BS);
  EXPECT_EQ(first.rate_hz, 30.0);
  const auto& model = std::get<uav::CameraProperties>(first.properties).model;
  EXPECT_EQ(model.width_px, 8);
  EXPECT_EQ(model.k1, -0.1);
  EXPECT_EQ(catalogue.sensors[1].kind(), uav::SensorKind::kImu);
  EXPECT_EQ(catalogue.sensors[2].kind(), uav::SensorKind::kRange);
  const auto& range = std::get<uav::RangeProperties>(catalogue.sensors[2].properties);
  EXPECT_EQ(range.min_m, 0.25);
  EXPECT_EQ(range.max_m, 20.0);
  ASSERT_EQ(catalogue.anchors.size(), 1u);
  EXPECT_EQ(catalogue.anchors[0].name, "blue_box");
  EXPECT_EQ(catalogue.anchors[0].shape, uav::AnchorShape::kBox);
  EXPECT_EQ(catalogue.anchors[0].size_m, (uav::Vec3{0.4, 0.4, 0.4}));
  EXPECT_EQ(catalogue.anchors[0].color_rgb, (uav::Vec3{0.05, 0.15, 0.85}));
  world.anchors[0].anchor.name = world.uavs[0].name;
  EXPECT_TRUE(make_catalogue(world, world.uavs[0]).anchors.empty()) << "it is the anchor itself";
}

}  // namespace
}  // namespace tether::sim
