#include "sdf_text.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sdf/sdf.hh>

#include <tether/base/random.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::test_uav;

void expect_near(const ignition::math::Pose3d& actual, const uav::Pose& expected) {
  EXPECT_NEAR(actual.Pos().X(), expected.p.x, 1e-12);
  EXPECT_NEAR(actual.Pos().Y(), expected.p.y, 1e-12);
  EXPECT_NEAR(actual.Pos().Z(), expected.p.z, 1e-12);
  const uav::Quat q{actual.Rot().W(), actual.Rot().X(), actual.Rot().Y(), actual.Rot().Z()};
  const uav::Quat difference = uav::inverse(q) * expected.q;
  EXPECT_NEAR(std::abs(difference.w), 1.0, 1e-12);
}

/// A UAV's text as libsdformat reads it.
class SdfText : public ::testing::Test {
 protected:
  const sdf::Model& read(const Uav& uav) {
    const std::string text = to_sdf(uav, [](const Warning&) {});
    EXPECT_NE(text.find("<sdf version='1.6'>"), std::string::npos);
    const sdf::Errors errors = root_.LoadSdfString(text);
    for (const sdf::Error& error : errors) ADD_FAILURE() << error.Message() << "\n" << text;
    return *root_.Model();
  }
  sdf::Root root_;
};

Uav turned_uav() {
  Uav uav = test_uav("alpha & co", {1.0, -2.0, 0.5});
  uav.X_WB.q = uav::from_rpy(0.0, 0.0, 2.5);
  uav.body.visuals[0].X_LV = {{0.1, 0.2, -0.3}, uav::from_rpy(0.3, -0.4, 1.7)};
  uav.body.visuals[0].material = {
      {0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0.8, 0.9}, {0.05, 0.15, 0.25}, 0.75, {}, 1.0, 1.0};
  uav.body.visuals[0].cast_shadows = false;
  uav.body.collisions[0].X_LC = {{0.0, 0.0, 0.125}, {}};
  uav.body.collisions[0].friction = 0.6;
  return uav;
}

TEST_F(SdfText, IsOneModelWithOneLink) {
  const Uav uav = turned_uav();
  const sdf::Model& model = read(uav);
  EXPECT_EQ(model.Name(), "alpha & co");
  EXPECT_FALSE(model.Static());
  EXPECT_EQ(model.LinkCount(), 1u);
  EXPECT_EQ(model.JointCount(), 0u);
  expect_near(model.RawPose(), uav.X_WB);
  const sdf::Link& link = *model.LinkByIndex(0);
  EXPECT_EQ(link.Name(), "base_link");
  expect_near(link.RawPose(), {});
  EXPECT_EQ(link.SensorCount(), 0u);
  expect_near(link.Inertial().Pose(), {});
  const auto& mass = link.Inertial().MassMatrix();
  const uav::Vec3& inertia = uav.airframe.inertia_kg_m2;
  EXPECT_EQ(mass.Mass(), uav.airframe.mass_kg);
  EXPECT_EQ(mass.DiagonalMoments(), ignition::math::Vector3d(inertia.x, inertia.y, inertia.z));
  EXPECT_EQ(mass.OffDiagonalMoments(), ignition::math::Vector3d::Zero);
}

TEST_F(SdfText, HasVisualsAndCollisions) {
  const Uav uav = turned_uav();
  const sdf::Link& link = *read(uav).LinkByIndex(0);
  const sdf::Visual& visual = *link.VisualByIndex(0);
  expect_near(visual.RawPose(), uav.body.visuals[0].X_LV);
  EXPECT_EQ(visual.Geom()->BoxShape()->Size(), ignition::math::Vector3d(0.4, 0.4, 0.1));
  EXPECT_FALSE(visual.CastShadows());
  EXPECT_FLOAT_EQ(visual.Transparency(), 0.25F);
  EXPECT_EQ(visual.Material()->Diffuse(), ignition::math::Color(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(visual.Material()->Ambient(), ignition::math::Color(0.4F, 0.5F, 0.6F));
  EXPECT_EQ(visual.Material()->Specular(), ignition::math::Color(0.7F, 0.8F, 0.9F));
  EXPECT_EQ(visual.Material()->Emissive(), ignition::math::Color(0.05F, 0.15F, 0.25F));
  const sdf::Collision& collision = *link.CollisionByIndex(0);
  expect_near(collision.RawPose(), uav.body.collisions[0].X_LC);
  EXPECT_EQ(collision.Geom()->BoxShape()->Size(), ignition::math::Vector3d(0.4, 0.4, 0.1));
  const auto ode =
      collision.Element()->GetElement("surface")->GetElement("friction")->GetElement("ode");
  EXPECT_EQ(ode->Get<double>("mu"), 0.6);
  EXPECT_EQ(ode->Get<double>("mu2"), 0.6);
}

TEST_F(SdfText, WritesEveryShape) {
  Uav uav = test_uav("alpha", {});
  const Visual box = uav.body.visuals[0];
  const std::vector<Geometry> shapes{CylinderGeometry{0.5, 2.0}, SphereGeometry{0.25},
                                     PlaneGeometry{{0.0, 1.0, 0.0}, 3.0, 4.0},
                                     MeshGeometry{"/m/a&b.dae", "part", {1.0, 2.0, 3.0}, true}};
  uav.body.visuals.clear();
  for (const Geometry& shape : shapes) {
    uav.body.visuals.push_back(box);
    uav.body.visuals.back().name = "v" + std::to_string(uav.body.visuals.size());
    uav.body.visuals.back().geometry = shape;
  }
  const sdf::Link& link = *read(uav).LinkByIndex(0);
  EXPECT_EQ(link.VisualByIndex(0)->Geom()->CylinderShape()->Radius(), 0.5);
  EXPECT_EQ(link.VisualByIndex(0)->Geom()->CylinderShape()->Length(), 2.0);
  EXPECT_EQ(link.VisualByIndex(1)->Geom()->SphereShape()->Radius(), 0.25);
  EXPECT_EQ(link.VisualByIndex(2)->Geom()->PlaneShape()->Normal(),
            ignition::math::Vector3d(0.0, 1.0, 0.0));
  EXPECT_EQ(link.VisualByIndex(2)->Geom()->PlaneShape()->Size(),
            ignition::math::Vector2d(3.0, 4.0));
  const sdf::Mesh& mesh = *link.VisualByIndex(3)->Geom()->MeshShape();
  EXPECT_EQ(mesh.Uri(), "file:///m/a&b.dae");
  EXPECT_EQ(mesh.Submesh(), "part");
  EXPECT_TRUE(mesh.CenterSubmesh());
  EXPECT_EQ(mesh.Scale(), ignition::math::Vector3d(1.0, 2.0, 3.0));
}

TEST(RollPitchYaw, GivesTheRotationBack) {
  KeyedRandom random({3, 1, 4});
  const auto angle = [&] { return std::numbers::pi * (2.0 * random.uniform() - 1.0); };
  std::vector<uav::Quat> rotations;
  for (int i = 0; i < 1000; ++i) rotations.push_back(uav::from_rpy(angle(), angle(), angle()));
  for (const double pitch : {0.5, -0.5}) {
    rotations.push_back(uav::from_rpy(0.4, pitch * std::numbers::pi, 1.1));
  }
  for (const uav::Quat& q : rotations) {
    const uav::Vec3 rpy = to_rpy_rad(q);
    const uav::Quat difference = uav::inverse(q) * uav::from_rpy(rpy.x, rpy.y, rpy.z);
    ASSERT_NEAR(std::abs(difference.w), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace tether::sim
