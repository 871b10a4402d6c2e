#include "physics_model.h"

#include "test_simulator.h"

#include <filesystem>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::no_warnings;
using ::testing::Pair;
using testing::test_world;

Collision collision_of(const Geometry& geometry) {
  Collision collision;
  collision.name = "shape";
  collision.geometry = geometry;
  return collision;
}

TEST(PhysicsModelTest, KeepsStepGravityAndMass) {
  World world = test_world();
  world.step = std::chrono::microseconds(2500);
  world.gravity_m_s2 = 1.62;
  const ModelPtr model = make_physics_model(world, no_warnings());
  EXPECT_EQ(model->opt.timestep, 0.0025);
  EXPECT_EQ(model->opt.gravity[2], -1.62);
  EXPECT_EQ(model->nbody, 2);
  EXPECT_EQ(model->body_mass[1], world.uavs[0].airframe.mass_kg);
  EXPECT_EQ(model->body_inertia[5], world.uavs[0].airframe.inertia_kg_m2.z);
  EXPECT_EQ(model->qpos0[2], 1.0);
}

TEST(PhysicsModelTest, EveryShapeIsSolid) {
  World world = test_world();
  world.models.resize(1);
  auto& collisions = world.models[0].links[0].collisions;
  collisions = {collision_of(BoxGeometry{{1.0, 2.0, 3.0}}),
                collision_of(CylinderGeometry{0.5, 2.0}),
                collision_of(SphereGeometry{0.5}),
                collision_of(CapsuleGeometry{0.5, 2.0}),
                collision_of(EllipsoidGeometry{{1.0, 2.0, 3.0}}),
                collision_of(PlaneGeometry{{0.0, 0.0, 1.0}, 1.0, 1.0})};
  const ModelPtr model = make_physics_model(world, no_warnings());
  ASSERT_EQ(model->ngeom, 7);
  const int types[] = {mjGEOM_BOX,     mjGEOM_CYLINDER,  mjGEOM_SPHERE,
                       mjGEOM_CAPSULE, mjGEOM_ELLIPSOID, mjGEOM_PLANE};
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(model->geom_type[i], types[i]);
    EXPECT_EQ(model->geom_contype[i], 0);
    EXPECT_EQ(model->geom_conaffinity[i], 0xffff);
  }
  EXPECT_EQ(model->geom_size[0], 0.5);
  EXPECT_EQ(model->geom_size[3 + 1], 1.0) << "half the cylinder's length";
}

/// The warnings of a world, and the shapes of its model.
std::pair<std::vector<std::string>, std::vector<int>> build(const World& world) {
  std::vector<std::string> warnings;
  const ModelPtr model = make_physics_model(
      world, [&](const Warning& warning) { warnings.push_back(to_line(warning)); });
  return {warnings, {model->geom_type, model->geom_type + model->ngeom}};
}

TEST(PhysicsModelTest, MeshesOfOneFileAndScaleAreOne) {
  World world = test_world();
  MeshGeometry tetra{
      std::filesystem::path(TETHER_TEST_DIR) / "data/tetra.stl", "", {1.0, 1.0, 1.0}};
  for (int i = 0; i < 150; ++i) world.models[0].links[0].collisions.push_back(collision_of(tetra));
  tetra.scale.x = 2.0;
  world.models[0].links[0].collisions.push_back(collision_of(tetra));
  EXPECT_EQ(make_physics_model(world, [](const Warning&) {})->nmesh, 2);
}

TEST(PhysicsModelTest, WarnsOfMeshesThatAreNotConvexAndOfPlanesThatMove) {
  World world = test_world();
  const std::filesystem::path data = std::filesystem::path(TETHER_TEST_DIR) / "data";
  const MeshGeometry tetra{data / "tetra.stl", "", {1.0, 1.0, 1.0}};
  world.models[0].links[0].collisions = {collision_of(tetra)};
  EXPECT_THAT(build(world), Pair(IsEmpty(), ElementsAre(mjGEOM_MESH, mjGEOM_BOX)));
  const MeshGeometry slab_and_card{data / "slab.obj", "", {1.0, 1.0, 1.0}};
  world.models[0].links[0].collisions = {collision_of(slab_and_card)};
  EXPECT_THAT(build(world),
              Pair(ElementsAre(AllOf(HasSubstr("slab.obj"), HasSubstr("convex hull"))),
                   ElementsAre(mjGEOM_MESH, mjGEOM_BOX)));
  world = test_world();
  world.uavs[0].body.collisions = {collision_of(PlaneGeometry{{0.0, 0.0, 1.0}, 1.0, 1.0})};
  EXPECT_THAT(build(world), Pair(ElementsAre(HasSubstr("'shape'")), ElementsAre(mjGEOM_BOX)));
}

TEST(PhysicsModelTest, AFlatMeshCollidesWithAThickness) {
  World world = test_world();
  const auto slab = std::filesystem::path(TETHER_TEST_DIR) / "data/slab.obj";
  world.models[0].links[0].collisions = {collision_of(MeshGeometry{slab, "card", {1.0, 1.0, 1.0}})};
  EXPECT_THAT(build(world), Pair(IsEmpty(), ElementsAre(mjGEOM_MESH, mjGEOM_BOX)));
  const auto corners = MeshFiles().corners({slab, "card", {1.0, 1.0, 1.0}});
  const auto [low, high] = std::ranges::minmax(corners, {}, &uav::Vec3::x);
  EXPECT_NEAR(high.x - low.x, 0.002, 1e-6);
}

TEST(PhysicsModelTest, RefusesAnImpossibleInertia) {
  World world = test_world();
  world.uavs[0].airframe.inertia_kg_m2 = {1.0, 1.0, 3.0};
  thrown_error(ErrorCode::kBadFile, [&] { make_physics_model(world, no_warnings()); });
}

}  // namespace
}  // namespace tether::sim
