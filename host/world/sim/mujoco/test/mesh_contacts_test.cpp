#include "physics_model.h"
#include "test_simulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

// What a UAV meets in meshes that are not convex: rooms, doors, sheets.
namespace tether::sim {
namespace {

using namespace std::chrono_literals;
using testing::make_simulator;
using testing::test_world;
using uav::Vec3;

/// An OBJ file of quads.
std::string obj_of(const std::vector<std::array<Vec3, 4>>& quads) {
  std::string text;
  for (const auto& quad : quads)
    for (const Vec3& p : quad) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  for (std::size_t i = 0; i < quads.size(); ++i)
    text += fmt::format("f {} {} {} {}\n", 4 * i + 1, 4 * i + 2, 4 * i + 3, 4 * i + 4);
  return text;
}

/// A UAV whose hull is a disc of 0.2 m, in the mesh alone.
World world_in(const std::filesystem::path& file, const Vec3& p_WB, double friction = 1.0) {
  World world = test_world();
  world.models.resize(1);
  Model& model = world.models[0];
  model = {};
  model.name = "house";
  model.is_static = true;
  model.links.resize(1);
  model.links[0].collisions = {{"mesh", {}, MeshGeometry{file, "", {1.0, 1.0, 1.0}}, friction}};
  world.uavs[0].X_WB.p = p_WB;
  world.uavs[0].body.collisions = {{"hull", {}, CylinderGeometry{0.2, 0.1}, 1.0}};
  return world;
}

/// A wall at x = 2 m with a door of 1 m × 2.5 m in its middle, and a floor.
std::string house_obj() {
  const auto wall = [](double y0, double y1, double z0, double z1) {
    return std::array<Vec3, 4>{{{2, y0, z0}, {2, y0, z1}, {2, y1, z1}, {2, y1, z0}}};
  };
  return obj_of({wall(-5, -0.5, 0, 2.5),
                 wall(0.5, 5, 0, 2.5),
                 wall(-5, -0.5, 2.5, 4),
                 wall(-0.5, 0.5, 2.5, 4),
                 wall(0.5, 5, 2.5, 4),
                 {{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}}});
}

struct PushedAlong {
  std::vector<Contact> contacts;
  double x_m = 0.0;
};

PushedAlong fly(const World& world, const Vec3& velocity_H_m_s) {
  const auto simulator = make_simulator(world);
  EXPECT_TRUE(simulator->take_contacts().empty()) << "where it starts";
  simulator->apply(0, uav::to_setpoint({velocity_H_m_s, 0.0}));
  simulator->advance_to(SimTime(4s));
  return {simulator->take_contacts(), simulator->ground_truth(0).body.p_WB.x};
}

TEST(MeshContacts, AWallOfARoomIsHitWhereItIs) {
  const ScratchFolder folder;
  const Vec3 a{-3, -3, 0}, b{3, -3, 0}, c{3, 3, 0}, d{-3, 3, 0}, up{0, 0, 3};
  const auto room = folder.write("room.obj", obj_of({{{a, b, c, d}},
                                                     {{a + up, d + up, c + up, b + up}},
                                                     {{a, a + up, b + up, b}},
                                                     {{b, b + up, c + up, c}},
                                                     {{c, c + up, d + up, d}},
                                                     {{d, d + up, a + up, a}}}));
  const PushedAlong flight = fly(world_in(room, {0, 0, 1.5}), {1.0, 0.0, 0.0});
  ASSERT_FALSE(flight.contacts.empty());
  EXPECT_EQ(flight.contacts.front().with, "house");
  EXPECT_NEAR(flight.contacts.front().speed_m_s, 1.0, 0.1);
  EXPECT_NEAR(flight.x_m, 2.8, 0.03);
}

TEST(MeshContacts, ADoorIsOpenAndTheWallBesideItIsNot) {
  const ScratchFolder folder;
  const auto house = folder.write("house.obj", house_obj());
  const PushedAlong through = fly(world_in(house, {0, 0, 1.5}), {1.5, 0.0, 0.0});
  EXPECT_TRUE(through.contacts.empty());
  EXPECT_GT(through.x_m, 4.0);
  const PushedAlong beside = fly(world_in(house, {0, 1.5, 1.5}), {1.5, 0.0, 0.0});
  EXPECT_FALSE(beside.contacts.empty());
  EXPECT_NEAR(beside.x_m, 1.8, 0.03);
}

// The edge of a thin wall must not be taken for a deep contact with its side.
TEST(MeshContacts, TheEdgeOfADoorDoesNotThrowAUavOut) {
  const ScratchFolder folder;
  World world = world_in(folder.write("house.obj", house_obj()), {0, 0.32, 1.5});
  const auto simulator = make_simulator(world);
  simulator->apply(0, uav::to_setpoint({{1.0, 0.0, 0.0}, 0.0}));
  double fastest_m_s = 0.0;
  bool has_touched = false;
  for (auto t = SimTime(1ms); t <= SimTime(4s); t += 1ms) {
    simulator->advance_to(t);
    has_touched = has_touched || !simulator->take_contacts().empty();
    fastest_m_s = std::max(fastest_m_s, norm(simulator->ground_truth(0).body.v_WB));
  }
  EXPECT_TRUE(has_touched);
  EXPECT_LT(fastest_m_s, 1.5);
}

void expect_at_rest(World world) {
  const auto simulator = make_simulator(std::move(world));
  uav::Setpoint off;
  off.mask = uav::kRotorSpeeds;
  off.rotor_speeds_rad_s = {0.0, 0.0, 0.0, 0.0};
  simulator->apply(0, off);
  simulator->advance_to(SimTime(2s));
  const uav::BodyState body = simulator->ground_truth(0).body;
  EXPECT_LT(norm(body.w_WB_B), 2e-3);
  EXPECT_LT(norm(body.v_WB), 1e-3);
  EXPECT_NEAR(body.p_WB.z, 0.05, 0.002);
}

// Far from the middle of a solid, the engine's normals point sideways.
TEST(MeshContacts, WhatStandsOnAWideSlabIsAtRest) {
  const ScratchFolder folder;
  const Vec3 a{-20, -20, -1}, b{20, -20, -1}, c{20, 20, -1}, d{-20, 20, -1}, up{0, 0, 1};
  const auto slab = folder.write("slab.obj", obj_of({{{a, d, c, b}},
                                                     {{a + up, b + up, c + up, d + up}},
                                                     {{a, b, b + up, a + up}},
                                                     {{b, c, c + up, b + up}},
                                                     {{c, d, d + up, c + up}},
                                                     {{d, a, a + up, d + up}}}));
  expect_at_rest(world_in(slab, {8.5, -2.0, 0.06}));
}

TEST(MeshContacts, WhatStandsOnASheetIsAtRestAlsoOnASeamAndWhateverItsFriction) {
  const ScratchFolder folder;
  const auto strip = [](double x0, double x1) {
    return std::array<Vec3, 4>{{{x0, -9, 0}, {x1, -9, 0}, {x1, 9, 0}, {x0, 9, 0}}};
  };
  // The L keeps the strips apart: all of it is not convex.
  const auto floor = folder.write(
      "floor.obj",
      obj_of({strip(-9, 0.05), strip(0.05, 9), {{{9, 0, 0}, {15, 0, 0}, {15, 9, 0}, {9, 9, 0}}}}));
  for (const double friction : {0.5, 1.0, 100.0}) {
    for (const double x_m : {0.0, 0.25, 6.0}) {
      SCOPED_TRACE(fmt::format("friction {}, at x = {} m", friction, x_m));
      expect_at_rest(world_in(floor, {x_m, 0.0, 0.06}, friction));
    }
  }
}

/// 6 × 3 pixels, from black on the left to white on the right.
constexpr std::string_view kSlope(
    "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x06\x00\x00"
    "\x00\x03\x08\x00\x00\x00\x00\x95\x6a\x21\x27\x00\x00\x00\x12\x49\x44\x41\x54\x78\xda\x63"
    "\x60\x30\x4e\x9b\x79\xe6\x3f\x03\x0a\x05\x00\x53\xc1\x08\xf8\x74\x23\xf2\x2a\x00\x00\x00"
    "\x00\x49\x45\x4e\x44\xae\x42\x60\x82",
    75);

/// 2 × 2 pixels: white on the upper left and the lower right.
constexpr std::string_view kSaddle(
    "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x02\x00\x00"
    "\x00\x02\x08\x00\x00\x00\x00\x57\xdd\x52\xf8\x00\x00\x00\x0e\x49\x44\x41\x54\x78\xda\x63"
    "\xf8\xcf\xc0\xc0\xf0\x1f\x00\x06\x00\x01\xff\x65\x34\xf8\xf7\x00\x00\x00\x00\x49\x45\x4e"
    "\x44\xae\x42\x60\x82",
    71);

World world_on(const std::filesystem::path& picture, const Vec3& size_m, const Vec3& p_WB) {
  World world = world_in(picture, p_WB);
  std::get<MeshGeometry>(world.models[0].links[0].collisions[0].geometry).scale = size_m;
  return world;
}

// The engine's field is the mesh that is drawn: a slope of 2 m in 10 m.
TEST(MeshContacts, AHeightmapIsTouchedWhereItIsDrawn) {
  const ScratchFolder folder;
  World world =
      world_on(folder.write("slope.png", std::string(kSlope)), {10, 6, 2}, {1.3, -0.7, 2});
  struct Hull {
    Geometry shape;
    double under_m;  ///< its origin, when it touches the slope
  };
  for (const auto& [shape, under_m] : {Hull{SphereGeometry{0.2}, 0.2 * std::hypot(1.0, 0.2)},
                                       Hull{CylinderGeometry{0.2, 0.1}, 0.05 + 0.2 * 0.2},
                                       Hull{BoxGeometry{{0.4, 0.4, 0.1}}, 0.05 + 0.2 * 0.2}}) {
    SCOPED_TRACE(shape.index());
    world.uavs[0].body.collisions = {{"hull", {}, shape, 1.0}};
    const auto simulator = make_simulator(world);
    simulator->apply(0, uav::to_setpoint({{0.0, 0.0, -0.3}, 0.0}));
    std::vector<Contact> contacts;
    for (auto t = SimTime(1ms); contacts.empty() && t <= SimTime(8s); t += 1ms) {
      simulator->advance_to(t);
      contacts = simulator->take_contacts();
    }
    ASSERT_FALSE(contacts.empty());
    EXPECT_EQ(contacts.front().with, "house");
    const auto height_m = [&] {
      const Vec3 p_W = simulator->ground_truth(0).body.p_WB;
      return p_W.z - 0.2 * (p_W.x + 5.0);
    };
    EXPECT_NEAR(height_m(), under_m, 0.01);
    simulator->advance_to(SimTime(10s));
    EXPECT_GT(height_m(), 0.04);
  }
}

TEST(MeshContacts, CellsOfAHeightmapHaveTheDiagonalsOfItsMesh) {
  const ScratchFolder folder;
  const World world =
      world_on(folder.write("saddle.png", std::string(kSaddle)), {2, 2, 1}, {0, 0, 5});
  const ModelPtr model = make_physics_model(world, [](const Warning&) {});
  const DataPtr data = make_data(*model);
  mj_forward(model.get(), data.get());
  const auto height_m = [&](double x, double y) {
    const std::array<mjtNum, 3> from{x, y, 3.0}, down{0.0, 0.0, -1.0};
    int geom = -1;
    return 3.0 - mj_ray(model.get(), data.get(), from.data(), down.data(), nullptr, 1, 1, &geom);
  };
  EXPECT_NEAR(height_m(-0.9, 0.9), 0.9, 1e-6);
  EXPECT_NEAR(height_m(0.9, -0.9), 0.9, 1e-6);
  EXPECT_NEAR(height_m(0.1, 0.1), 0.0, 1e-6);
  EXPECT_NEAR(height_m(-0.1, 0.1), 0.1, 1e-6);
}

}  // namespace
}  // namespace tether::sim
