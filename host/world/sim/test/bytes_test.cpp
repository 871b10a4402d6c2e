#include <gtest/gtest.h>

#include <tether/sim/world_parts.h>

namespace tether::sim {
namespace {

/// With something in each kind of part.
World full_world() {
  World world;
  world.name = "w";
  world.file = "/w.sdf";
  world.place = Place{};
  world.files = {"/a", "/b"};
  Model& model = world.models.emplace_back();
  model.path = DrivenPath{{{{Duration(5), {1, 2, 3}, 0.5}}, true, Duration(7)}, {4, 5, 6}};
  Link& link = model.links.emplace_back();
  link.visuals.push_back({"box", {}, BoxGeometry{{1, 2, 3}}, {}});
  MeshGeometry mesh;
  mesh.file = "made";
  mesh.companions = {"/c.mtl"};
  mesh.piece = 3;
  mesh.made = std::make_shared<const std::string>("v 0 0 0");
  link.collisions.push_back({"mesh", {}, mesh});
  world.lights.emplace_back().name = "sun";
  Uav& uav = world.uavs.emplace_back();
  uav.airframe = uav::hummingbird();
  uav.sensors.push_back({"camera", {}, 25.0, CameraModel{}});
  uav.sensors.push_back({"range", {}, 0.0, RangeModel{}});
  uav.sensors.push_back({"imu", {}, 0.0, ImuModel{}});
  uav.energy = energy::Model{};
  uav.energy->battery.voltage_at_charge = {{0.0, 10.0}, {1.0, 12.0}};
  uav.joints.push_back({"pitch", {}, {0, 1, 0}, -1.0, 1.0, 2.0});
  world.anchors.push_back({{"tower", uav::AnchorShape::kBox, {}, {}}, {}});
  return world;
}

std::string bytes_of(const World& world) {
  ByteWriter out;
  out(world);
  return out.take();
}

TEST(Bytes, GiveAWorldAgain) {
  const World world = full_world();
  const std::string bytes = bytes_of(world);
  ByteReader in(bytes);
  World again;
  in(again);
  EXPECT_TRUE(in.is_at_end());
  EXPECT_TRUE(bytes_of(again) == bytes);
  const auto& mesh =
      std::get<MeshGeometry>(again.models.at(0).links.at(0).collisions.at(0).geometry);
  EXPECT_EQ(*mesh.made, "v 0 0 0");
  EXPECT_EQ(mesh.piece, 3U);
  EXPECT_EQ(static_cast<const uav::Path&>(*again.models.at(0).path),
            static_cast<const uav::Path&>(*world.models.at(0).path));
  EXPECT_EQ(again.uavs.at(0).sensors.at(1).kind(), uav::SensorKind::kRange);
}

TEST(Bytes, ThatEndAnywhereAreRefused) {
  const std::string bytes = bytes_of(full_world());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ByteReader in(std::string_view(bytes).substr(0, size));
    World again;
    EXPECT_THROW(in(again), std::out_of_range) << size;
  }
}

}  // namespace
}  // namespace tether::sim
