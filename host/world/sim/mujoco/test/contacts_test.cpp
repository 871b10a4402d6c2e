#include "test_simulator.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/sim_mujoco/mujoco_simulator.h>

// What the embedded simulator reports of its contacts.
namespace tether::sim {
namespace {

using namespace std::chrono_literals;
using testing::box_model;
using testing::make_simulator;
using testing::test_uav;
using testing::test_world;

World world_with_wall() {
  World world = test_world();
  world.models.push_back(box_model("wall", {5.0, 0.0, 1.5}, {0.2, 40.0, 3.0}, {1.0, 1.0, 1.0}));
  return world;
}

World world_from(World world, const uav::Vec3& p_WB) {
  world.uavs[0].X_WB.p = p_WB;
  return world;
}

World world_with_two() {
  World world = test_world();
  world.uavs.push_back(test_uav("beta", {4.0, 0.0, 1.0}));
  world.uavs[1].X_WB.q = uav::from_axis_angle({0.0, 0.0, 1.0}, std::numbers::pi);
  return world;
}

// A disc as hull, far from the middle of a thin and wide floor, in a fall.
World world_with_fall(double fall_m_s) {
  World world = test_world();
  world.uavs[0].X_WB.p = {8.5, -2.0, 3.0};
  world.uavs[0].airframe.max_vertical_speed_m_s = fall_m_s;
  world.uavs[0].body.collisions = {{"hull", {}, CylinderGeometry{0.26, 0.1}, 1.0}};
  return world;
}

World with_bits_of_wall(std::uint32_t bits) {
  World world = world_with_wall();
  for (Model& model : world.models)
    if (model.name == "wall") model.links[0].collisions[0].bits = bits;
  return world;
}

struct ContactCase {
  std::string name;
  World world;
  uav::Vec3 velocity_H_m_s;
  std::string first_with;  ///< of the first contact of UAV 0; empty: there is none
  double hardest_m_s;      ///< of all its contacts
  double tolerance_m_s;
};

class MujocoContactsTest : public ::testing::TestWithParam<ContactCase> {};

TEST_P(MujocoContactsTest, ReportsWhatWasHitAndHowHard) {
  const ContactCase& flight = GetParam();
  const auto simulator = make_simulator(flight.world);
  ASSERT_TRUE(simulator->reports_contacts());
  for (std::size_t i = 0; i < flight.world.uavs.size(); ++i) {
    simulator->apply(i, uav::to_setpoint({flight.velocity_H_m_s, 0.0}));
  }
  simulator->advance_to(SimTime(4s));
  std::string first_with;
  double hardest_m_s = 0.0;
  for (const Contact& contact : simulator->take_contacts()) {
    if (contact.uav != 0) continue;
    if (first_with.empty()) first_with = contact.with;
    hardest_m_s = std::max(hardest_m_s, contact.speed_m_s);
  }
  EXPECT_EQ(first_with, flight.first_with);
  EXPECT_NEAR(hardest_m_s, flight.hardest_m_s, flight.tolerance_m_s);
}

const std::vector<ContactCase> kContactCases = {
    {"Hovering", world_with_wall(), {}, "", 0.0, 0.0},
    {"IntoAWall", world_with_wall(), {4.0, 0.0, 0.0}, "wall", 4.0, 0.2},
    {"IntoAWallWithABitInCommon", with_bits_of_wall(0x10100), {4.0, 0.0, 0.0}, "wall", 4.0, 0.2},
    {"ThroughAWallWithoutABitInCommon", with_bits_of_wall(0x10000), {4.0, 0.0, 0.0}, "", 0.0, 0.0},
    {"AlongAWall",
     world_from(world_with_wall(), {4.69, 0.0, 1.0}),
     {0.1, 2.0, 0.0},
     "wall",
     0.2,
     0.2},
    {"Landing", test_world(), {0.0, 0.0, -0.4}, "floor", 0.4, 0.02},
    {"OnTheFloor", world_from(test_world(), {0.0, 0.0, 0.05}), {}, "floor", 0.0, 0.02},
    {"AnotherUav", world_with_two(), {1.0, 0.0, 0.0}, "beta", 2.0, 0.1},
};

INSTANTIATE_TEST_SUITE_P(Flights, MujocoContactsTest, ::testing::ValuesIn(kContactCases),
                         [](const auto& named) { return named.param.name; });

TEST(MujocoContactsTest, StopAUavThatFalls) {
  for (const double fall_m_s : {1.0, 2.0, 3.0, 4.0, 6.0}) {
    SCOPED_TRACE(fall_m_s);
    const World world = world_with_fall(fall_m_s);
    const auto simulator = make_simulator(world);
    simulator->apply(0, uav::to_setpoint({{0.0, 0.0, -fall_m_s}, 0.0}));
    double hit_m_s = 0.0, sunk_m = 0.0, fastest_m_s = 0.0;
    for (auto t = SimTime(1ms); t <= SimTime(5s); t += 1ms) {
      simulator->advance_to(t);
      const GroundTruth truth = simulator->ground_truth(0);
      sunk_m = std::max(sunk_m, 0.05 - truth.body.p_WB.z);
      if (hit_m_s > 0.0) fastest_m_s = std::max(fastest_m_s, uav::norm(truth.body.v_WB));
      for (const Contact& contact : simulator->take_contacts())
        hit_m_s = std::max(hit_m_s, contact.speed_m_s);
    }
    EXPECT_GT(hit_m_s, 0.7 * fall_m_s);
    EXPECT_LT(hit_m_s, fall_m_s + 0.1);
    EXPECT_LT(fastest_m_s, fall_m_s + 0.1);
    EXPECT_LT(sunk_m, 0.04);
  }
}

// A roof of 5 cm, between two instants of a fall that are up to half a metre apart; and a wall that
// is as fast.
TEST(MujocoContactsTest, NothingIsPassedUnseenHoweverLongTheStep) {
  for (const Duration step : {1ms, 5ms, 20ms}) {
    SCOPED_TRACE(to_seconds(step));
    World world = test_world();
    world.step = step;
    world.models.push_back(box_model("roof", {0.0, 0.0, 4.0}, {9.0, 9.0, 0.05}, {1.0, 1.0, 1.0}));
    world.uavs[0].X_WB.p = {0.0, 0.0, 40.0};
    Model wall = box_model("wall", {-5.0, 20.0, 4.5}, {0.05, 3.0, 9.0}, {1.0, 1.0, 1.0});
    wall.is_static = false;
    wall.path = DrivenPath{{{{1s, {}, 0.0}, {1500ms, {15.0, 0.0, 0.0}, 0.0}}}, {}};
    world.models.push_back(wall);
    world.uavs.push_back(test_uav("hovers", {0.0, 20.0, 4.0}));
    const WarningSink of_falls = [](const Warning&) {};  // what is hit so hard goes through
    const auto simulator = prepare_mujoco_simulator(world, of_falls)(of_falls, 0);
    uav::Setpoint falls;
    falls.mask = uav::kRotorSpeeds;
    falls.rotor_speeds_rad_s.assign(world.uavs[0].airframe.rotors.size(), 0.0);
    simulator->apply(0, falls);
    simulator->advance_to(SimTime(4s));
    std::map<std::string, double> hardest_m_s;
    for (const Contact& contact : simulator->take_contacts())
      hardest_m_s[contact.with] = std::max(hardest_m_s[contact.with], contact.speed_m_s);
    EXPECT_GT(hardest_m_s["roof"], 15.0);
    EXPECT_GT(hardest_m_s["wall"], 20.0);
  }
}

// With one point of contact, it rocked for ever, with 0.2 rad/s.
TEST(MujocoContactsTest, WhatStandsOnAnyFaceOfABoxIsAtRest) {
  const uav::Vec3 flat{20.0, 20.0, 1.0}, on_edge{1.0, 20.0, 20.0};
  for (const auto& [size_m, q] : {std::pair{flat, uav::Quat{}},
                                  {flat, uav::from_rpy(std::numbers::pi, 0.0, 0.4)},
                                  {on_edge, uav::from_rpy(0.0, std::numbers::pi / 2, 0.0)},
                                  {on_edge, uav::from_rpy(0.0, -std::numbers::pi / 2, 0.3)}}) {
    World world = world_with_fall(1.0);
    world.models.resize(1);
    world.models[0] = {};
    world.models[0].name = "floor";
    world.models[0].is_static = true;
    world.models[0].links.resize(1);
    world.models[0].links[0].collisions = {{"box", {}, BoxGeometry{size_m}, 1.0}};
    world.models[0].X_WM = {{0.0, 0.0, -0.5}, q};
    world.uavs[0].X_WB.p.z = 0.06;
    const auto simulator = make_simulator(world);
    uav::Setpoint off;
    off.mask = uav::kRotorSpeeds;
    off.rotor_speeds_rad_s = {0.0, 0.0, 0.0, 0.0};
    simulator->apply(0, off);
    simulator->advance_to(SimTime(2s));
    const uav::BodyState body = simulator->ground_truth(0).body;
    EXPECT_LT(uav::norm(body.w_WB_B), 1e-3);
    EXPECT_LT(uav::norm(body.v_WB), 1e-3);
    EXPECT_NEAR(body.p_WB.z, 0.05, 0.001);
  }
}

TEST(MujocoContactsTest, UavsThatCollideNameEachOther) {
  const auto simulator = make_simulator(world_with_two());
  for (std::size_t i = 0; i < 2; ++i) simulator->apply(i, uav::to_setpoint({{1.0, 0.0, 0.0}, 0.0}));
  simulator->advance_to(SimTime(4s));
  std::map<std::size_t, std::string> first_with;
  for (const Contact& contact : simulator->take_contacts())
    first_with.try_emplace(contact.uav, contact.with);
  EXPECT_EQ(first_with, (std::map<std::size_t, std::string>{{0, "beta"}, {1, "alpha"}}));
  ASSERT_TRUE(simulator->clearance(0) && simulator->clearance(1));
}

TEST(MujocoContactsTest, DoNotDependOnHowTheAdvanceIsSplit) {
  const auto whole = make_simulator(world_with_wall());
  const auto pieces = make_simulator(world_with_wall());
  whole->apply(0, uav::to_setpoint({{4.0, 0.0, 0.0}, 0.0}));
  pieces->apply(0, uav::to_setpoint({{4.0, 0.0, 0.0}, 0.0}));
  whole->advance_to(SimTime(4s));
  std::vector<Contact> contacts;
  for (auto t = SimTime(1ms); t <= SimTime(4s); t += 1ms) {
    pieces->advance_to(t);
    for (const Contact& contact : pieces->take_contacts()) {
      contacts.push_back(contact);
      EXPECT_EQ(contact.at, t - 1ms);
    }
  }
  EXPECT_EQ(whole->take_contacts(), contacts);
  whole->reset(1);
  whole->advance_to(SimTime(1s));
  EXPECT_EQ(whole->take_contacts(), std::vector<Contact>{});
}

}  // namespace
}  // namespace tether::sim
