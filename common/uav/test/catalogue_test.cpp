#include <gmock/gmock.h>

#include <tether/uav/catalogue.h>

namespace tether::uav {
namespace {

Catalogue example() {
  Catalogue catalogue;
  catalogue.sensors.push_back({"camera", {}, 30.0, CameraProperties{}});
  catalogue.sensors.push_back({"imu", {}, 200.0, ImuProperties{}});
  catalogue.sensors.push_back({"front", {}, 0.0, RangeProperties{0.1, 4.0}});
  catalogue.anchors.push_back({"blue_box", AnchorShape::kBox, {0.4, 0.4, 0.4}, {0, 0, 1}});
  return catalogue;
}

TEST(Catalogue, FindsByName) {
  const Catalogue catalogue = example();
  ASSERT_NE(catalogue.find_sensor("imu"), nullptr);
  EXPECT_EQ(catalogue.find_sensor("imu")->rate_hz, 200.0);
  ASSERT_NE(catalogue.find_anchor("blue_box"), nullptr);
  EXPECT_EQ(catalogue.find_anchor("blue_box")->size_m.x, 0.4);
  EXPECT_EQ(catalogue.find_sensor("blue_box"), nullptr);
  EXPECT_EQ(catalogue.find_anchor("camera"), nullptr);
}

TEST(Catalogue, NamesKindsOfSensorsAndShapes) {
  std::vector<std::string_view> kinds;
  for (const SensorDescription& sensor : example().sensors) kinds.push_back(name(sensor.kind()));
  EXPECT_EQ(kinds, (std::vector<std::string_view>{"camera", "imu", "range"}));
  EXPECT_EQ(name(AnchorShape::kBox), "box");
  EXPECT_EQ(name(AnchorShape::kCylinder), "cylinder");
  EXPECT_EQ(name(AnchorShape::kSphere), "sphere");
}

}  // namespace
}  // namespace tether::uav
