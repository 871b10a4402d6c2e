#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using uav::Vec3;

/// One world with an anchor of each shape.
const char* const kAnchors = R"(
    <model name='box'><static>true</static><pose>1 0 0 0 0 0</pose><link name='l'>
      <pose>0 1 0 0 0 0</pose><visual name='v'><pose>0 0 1 0 0 0</pose>
      <geometry><box><size>1 2 3</size></box></geometry>
      <material><diffuse>0 0.25 1 1</diffuse></material></visual></link></model>
    <model name='cylinder'><link name='l'><visual name='v'>
      <geometry><cylinder><radius>0.5</radius><length>2</length></cylinder></geometry></visual></link></model>
    <model name='sphere'><link name='l'><visual name='v'>
      <geometry><sphere><radius>0.5</radius></sphere></geometry></visual></link></model>
    <model name='two'><link name='l'>
      <visual name='v'><geometry><sphere><radius>0.5</radius></sphere></geometry></visual>
      <visual name='w'><geometry><sphere><radius>0.5</radius></sphere></geometry></visual></link></model>
    <model name='plane'><link name='l'><visual name='v'><geometry><plane/></geometry></visual></link></model>
    <model name='textured'><link name='l'><visual name='v'>
      <geometry><sphere><radius>0.5</radius></sphere></geometry>
      <material><pbr><metal><albedo_map>t.png</albedo_map></metal></pbr></material></visual></link></model>
    <model name='gate'><static>true</static><pose>4 0 2 0 0 0</pose><link name='l'>
      <visual name='post'><pose>0 0.7 0 0 0 0</pose><geometry><box><size>0.2 0.2 2</size></box></geometry></visual>
      <visual name='beam'><pose>0 0 0.9 0 0 0</pose><geometry><box><size>0.2 1.2 0.2</size></box></geometry></visual></link></model>
    <model name='motley'><link name='l'>
      <visual name='v'><geometry><box><size>1 1 1</size></box></geometry><material><diffuse>1 0 0 1</diffuse></material></visual>
      <visual name='w'><geometry><box><size>1 1 1</size></box></geometry></visual></link></model>)";

TEST(Anchor, IsABoxACylinderOrASphereOfOneColour) {
  const ScratchFolder folder;
  folder.write("t.png", "png");
  const auto file = folder.write("w.sdf", world_sdf(kAnchors));
  const auto anchors = load({file, {}, {"cylinder", "box", "sphere"}}).world.anchors;
  ASSERT_EQ(anchors.size(), 3u);
  EXPECT_EQ(anchors[0].anchor.shape, uav::AnchorShape::kCylinder);
  EXPECT_EQ(anchors[0].anchor.size_m, (Vec3{1, 1, 2}));
  EXPECT_EQ(anchors[1].anchor.name, "box");
  EXPECT_EQ(anchors[1].anchor.size_m, (Vec3{1, 2, 3}));
  EXPECT_EQ(anchors[1].anchor.color_rgb, (Vec3{0, 0.25, 1}));
  EXPECT_EQ(anchors[1].X_WA.p, (Vec3{1, 1, 1}));
  EXPECT_EQ(anchors[2].anchor.size_m, (Vec3{1, 1, 1}));
  for (const auto& [name, line] :
       {std::pair{"nothing", 0}, {"two", 12}, {"plane", 15}, {"textured", 16}, {"motley", 22}}) {
    expect_error(refusal({file, {}, {name}}), file, line, name);
  }
  expect_error(refusal({file, {}, {"bx"}, {"scenario.toml", 7}}), "scenario.toml", 7, "bx");
}

TEST(Anchor, OfSeveralBoxesIsTheBoxAroundThem) {
  const ScratchFolder folder;
  folder.write("t.png", "png");
  const auto file = folder.write("w.sdf", world_sdf(kAnchors));
  const auto anchors = load({file, {}, {"gate"}}).world.anchors;
  ASSERT_EQ(anchors.size(), 1u);
  EXPECT_EQ(anchors[0].anchor.shape, uav::AnchorShape::kBox);
  EXPECT_LT(uav::norm(anchors[0].anchor.size_m - Vec3{0.2, 1.4, 2.0}), 1e-12);
  EXPECT_LT(uav::norm(anchors[0].X_WA.p - Vec3{4.0, 0.1, 2.0}), 1e-12);
}

TEST(Anchor, OfAUavIsTheBoxAroundItsShapesInTheColourOfTheLargest) {
  const ScratchFolder folder;
  folder.write("t.png", "png");
  const auto file = folder.write("w.sdf", world_sdf(kAnchors));
  const std::filesystem::path model =
      std::filesystem::path(TETHER_SOURCE_DIR) / "data/models/hummingbird/model.sdf";
  const World world = load({file, {{"scout", model, {3, 0, 1}, 0.0}}, {"scout"}}).world;
  ASSERT_EQ(world.anchors.size(), 1u);
  const uav::Anchor& anchor = world.anchors[0].anchor;
  EXPECT_EQ(anchor.name, "scout");
  EXPECT_EQ(anchor.shape, uav::AnchorShape::kBox);
  EXPECT_NEAR(anchor.size_m.x, 0.54, 1e-9);  // from rotor to rotor
  EXPECT_NEAR(anchor.size_m.y, 0.54, 1e-9);
  EXPECT_LT(uav::norm(anchor.color_rgb - Vec3{0.85, 0.42, 0.08}), 1e-6);
  EXPECT_NEAR(world.anchors[0].X_WA.p.x, 3.0, 1e-9);
}

}  // namespace
}  // namespace tether::sim
