#include "test_simulator.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
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

}  // namespace
}  // namespace tether::sim
