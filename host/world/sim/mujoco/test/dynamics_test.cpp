#include "dynamics.h"

#include "conversions.h"
#include "physics_model.h"
#include "test_simulator.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using testing::box_model;
using testing::no_warnings;
using testing::test_world;
using testing::world_with_battery;

void run(Dynamics& dynamics, int steps) {
  for (int i = 0; i < steps; ++i) dynamics.step();
}

TEST(DynamicsTest, HoversAndFollowsVelocityAndYawRateInTheHeadingFrame) {
  World world = test_world();
  world.uavs[0].X_WB.q = uav::from_axis_angle({0.0, 0.0, 1.0}, 0.5 * std::numbers::pi);
  Dynamics dynamics(world, no_warnings());
  run(dynamics, 10'000);
  EXPECT_LT(norm(dynamics.body_state(0).p_WB - uav::Vec3{0.0, 0.0, 1.0}), 1e-3);
  EXPECT_LT(norm(dynamics.body_state(0).v_WB), 1e-3);
  dynamics.set_setpoint(0, uav::to_setpoint({{0.8, -0.3, 0.2}, 0.0}));
  run(dynamics, 4'000);
  EXPECT_LT(norm(dynamics.body_state(0).v_WB - uav::Vec3{0.3, 0.8, 0.2}), 0.03);
  dynamics.set_setpoint(0, uav::to_setpoint({{}, 0.5}));
  run(dynamics, 4'000);
  EXPECT_LT(norm(dynamics.body_state(0).v_WB), 0.02);
  EXPECT_NEAR(dynamics.body_state(0).w_WB_B.z, 0.5, 0.01);
}

// A step's change of velocity is that of the same thrust on the greater mass. The controller, which
// does not know the payload, then holds it by its integral.
TEST(DynamicsTest, APayloadIsCarriedForItsTime) {
  World world = test_world();
  const double mass_kg = world.uavs[0].airframe.mass_kg, load_kg = 0.1 * mass_kg;
  world.uavs[0].payloads = {
      {load_kg, SimTime(std::chrono::seconds(1)), SimTime(std::chrono::seconds(9))}};
  Dynamics dynamics(world, no_warnings());
  std::vector<double> heights_m[2];
  for (std::vector<double>& heights : heights_m) {
    dynamics.reset(0);
    run(dynamics, 1000);
    const double before_m_s = dynamics.body_state(0).v_WB.z;
    run(dynamics, 1);
    const double change_m_s = dynamics.body_state(0).v_WB.z - before_m_s;
    EXPECT_NEAR(change_m_s, -1e-3 * world.gravity_m_s2 * load_kg / (mass_kg + load_kg), 1e-5);
    run(dynamics, 7000);
    EXPECT_LT(std::abs(dynamics.body_state(0).v_WB.z), 0.01) << "the controller holds it";
    heights.push_back(dynamics.body_state(0).p_WB.z);
    run(dynamics, 1100);
    EXPECT_GT(dynamics.body_state(0).v_WB.z, 0.02) << "it was dropped";
    run(dynamics, 9000);
    EXPECT_LT(std::abs(dynamics.body_state(0).v_WB.z), 0.01);
    heights.push_back(dynamics.body_state(0).p_WB.z);
  }
  EXPECT_EQ(heights_m[0], heights_m[1]) << "a reset takes it off";
}

TEST(DynamicsTest, AWallStopsTheUav) {
  World world = test_world();
  world.models.push_back(box_model("wall", {2.0, 0.0, 1.5}, {0.2, 6.0, 3.0}, {1.0, 1.0, 1.0}));
  Dynamics dynamics(world, no_warnings());
  dynamics.set_setpoint(0, uav::to_setpoint({{1.0, 0.0, 0.0}, 0.0}));
  run(dynamics, 5'000);
  const double front_m = dynamics.body_state(0).p_WB.x + 0.2;
  EXPECT_GT(front_m, 1.7);
  EXPECT_LT(front_m, 2.0) << "inside the wall, which begins at 1.9";
}

// What the fleet's flights rely on: both ways of applying a force give the same bytes.
TEST(DynamicsTest, RotorsActToTheBitAsForcesThatTheEngineApplies) {
  World world = test_world();
  world.uavs.push_back(testing::test_uav("beta", {1.0, 0.3, 2.0}));
  world.uavs[1].X_WB.q = uav::from_rpy(0.3, -0.2, 2.0);
  const uav::Setpoint command = uav::to_setpoint({{1.0, -0.4, -0.5}, 0.6});
  Dynamics dynamics(world, no_warnings());
  const ModelPtr model = make_physics_model(world, no_warnings());
  const DataPtr data = make_data(*model);
  const uav::Multirotor multirotor(world.uavs[0].airframe, world.gravity_m_s2, world.step);
  std::vector<uav::MultirotorState> states;
  for (std::size_t i = 0; i < 2; ++i) {
    dynamics.set_setpoint(i, command);
    states.push_back(uav::hover_state(world.uavs[i].airframe, world.gravity_m_s2,
                                      uav::yaw_rad(world.uavs[i].X_WB.q)));
  }
  for (int step = 0; step < 3'000; ++step) {  // both fly against each other, and on the ground
    for (std::size_t i = 0; i < 2; ++i) {
      const uav::BodyState body = dynamics.body_state(i);
      const uav::Wrench wrench = multirotor.step(body, command, states[i]);
      mjtNum* const out = data->xfrc_applied + 6 * engine_body(i);
      copy_to(rotate(body.q_WB, wrench.force_B), out);
      copy_to(rotate(body.q_WB, wrench.torque_B), out + 3);
    }
    dynamics.step();
    mj_step(model.get(), data.get());
    for (std::size_t i = 0; i < 2; ++i)
      ASSERT_EQ(dynamics.body_state(i).p_WB, vec3_from(data->qpos + qpos_address(i)))
          << "UAV " << i << " in step " << step;
  }
  EXPECT_FALSE(dynamics.contacts().take().empty());
}

TEST(DynamicsTest, ABatteryThatHoldsItsVoltageDoesNotChangeTheFlight) {
  const World plain = test_world(), powered = world_with_battery(1.0, 0.01);
  Dynamics without(plain, no_warnings()), with(powered, no_warnings());
  for (Dynamics* dynamics : {&without, &with}) {
    dynamics->set_setpoint(0, uav::to_setpoint({{1.0, 0.5, 0.5}, 0.5}));
    run(*dynamics, 1'000);
  }
  EXPECT_EQ(without.body_state(0).p_WB, with.body_state(0).p_WB);
  EXPECT_FALSE(without.battery(0));
  EXPECT_LT(with.battery(0)->charge, 1.0);
}

TEST(DynamicsTest, ASaggingBatteryLimitsTheClimb) {
  World sagging = world_with_battery(0.3, 0.35);
  const World plain = test_world();
  Dynamics without(plain, no_warnings()), with(sagging, no_warnings());
  for (Dynamics* dynamics : {&without, &with}) {
    dynamics->set_setpoint(0, uav::to_setpoint({{0.0, 0.0, 2.0}, 0.0}));
    run(*dynamics, 400);
  }
  EXPECT_LT(with.body_state(0).v_WB.z, without.body_state(0).v_WB.z - 0.05);
}

TEST(DynamicsTest, AnEmptyBatteryDropsTheUav) {
  const World world = world_with_battery(0.0005, 0.05);
  Dynamics dynamics(world, no_warnings());
  run(dynamics, 3'000);
  ASSERT_TRUE(dynamics.battery(0)->empty_at);
  EXPECT_LT(dynamics.body_state(0).p_WB.z, 0.3);
  dynamics.reset(0);
  EXPECT_FALSE(dynamics.battery(0)->empty_at);
}

TEST(DynamicsTest, LooseBodiesFallAndRest) {
  World world = test_world();
  Model loose = box_model("loose", {2.0, 0.0, 1.0}, {0.2, 0.2, 0.2}, {1.0, 0.0, 0.0}, false);
  loose.links[0].inertia_kg_m2 = {0.0067, 0.0067, 0.0067};
  world.models.push_back(loose);
  Dynamics dynamics(world, no_warnings());
  const StateLayout layout(world);
  std::vector<double> state;
  run(dynamics, 200);
  dynamics.capture(state);
  EXPECT_NEAR(layout.pose_of(state, 1).p.z, 1.0 - 0.5 * 9.81 * 0.04, 1.5e-3) << "free fall";
  run(dynamics, 3'000);
  dynamics.capture(state);
  EXPECT_NEAR(layout.pose_of(state, 1).p.z, 0.1, 5e-3) << "on the floor";
}

/// A platform 0.5 m above the ground that goes around in 8 s, and turns.
World world_with_platform() {
  World world = test_world();
  Model platform = box_model("platform", {0.0, 0.0, 0.45}, {1.2, 1.2, 0.1}, {1.0, 0.0, 0.0}, false);
  using std::chrono::seconds;
  const uav::Path path{{{seconds(0), {0, 0, 0}, 0.0},
                        {seconds(2), {1, 0, 0}, 1.5},
                        {seconds(4), {1, 1, 0.3}, 3.0},
                        {seconds(6), {0, 1, 0}, 4.5},
                        {seconds(8), {0, 0, 0}, 2.0 * std::numbers::pi}},
                       true};
  platform.path = DrivenPath{path, {}};
  world.models.push_back(std::move(platform));
  return world;
}

TEST(DynamicsTest, DrivenModelsFollowTheirPathWhateverTheyMeet) {
  World world = world_with_platform();
  world.models.push_back(
      box_model("in_the_way", {1.0, 0.0, 0.45}, {0.4, 0.4, 0.4}, {1.0, 1.0, 1.0}));
  world.uavs[0].X_WB.p = {0.0, 0.0, 0.5};  // inside the platform
  Dynamics dynamics(world, [](const Warning&) {});
  const StateLayout layout(world);
  std::vector<double> state;
  for (int step = 0; step < 9'000; ++step) {
    dynamics.capture(state);
    const SimTime now = SimTime{} + step * world.step;
    ASSERT_EQ(layout.pose_of(state, 1), driven_state(moving_bodies(world)[1], now).X_WB) << step;
    dynamics.step();
  }
}

TEST(DynamicsTest, WhatStandsOnADrivenModelIsCarriedAlong) {
  World world = world_with_platform();
  world.uavs[0].X_WB.p = {0.2, 0.1, 0.6};
  Dynamics dynamics(world, no_warnings());
  uav::Setpoint off;
  off.mask = uav::kRotorSpeeds;
  off.rotor_speeds_rad_s.assign(world.uavs[0].airframe.rotors.size(), 0.0);
  dynamics.set_setpoint(0, off);
  const auto in_platform = [&](int step) {
    const SimTime now = SimTime{} + step * world.step;
    return transform(inverse(driven_state(moving_bodies(world)[1], now).X_WB),
                     dynamics.body_state(0).p_WB);
  };
  run(dynamics, 500);
  const uav::Vec3 landed = in_platform(500);
  run(dynamics, 7'500);
  EXPECT_LT(norm(in_platform(8'000) - landed), 0.01);
}

// It leans as much to stand in the wind as to fly as fast through still air.
TEST(DynamicsTest, WindDragsAsTheUavsOwnMotionThroughTheAir) {
  World world = test_world();
  world.uavs[0].airframe.linear_drag_N_s_m = 0.5;
  world.uavs[0].X_WB.p.z = 5.0;
  World windy = world;
  windy.wind.v_WA_m_s = {2.0, -1.0, 0.0};
  Dynamics still(world, no_warnings()), dynamics(windy, no_warnings());
  run(dynamics, 20'000);
  EXPECT_LT(norm(dynamics.body_state(0).v_WB), 5e-3) << "the controller holds it";
  still.set_setpoint(0, uav::to_setpoint({{-2.0, 1.0, 0.0}, 0.0}));
  run(still, 20'000);
  const uav::Vec3 ahead = rotate(dynamics.body_state(0).q_WB, {0.0, 0.0, 1.0});
  EXPECT_LT(norm(ahead - rotate(still.body_state(0).q_WB, {0.0, 0.0, 1.0})), 5e-3);
  EXPECT_LT(ahead.x, -0.02) << "it leans into the wind";
}

TEST(DynamicsTest, GustsDependOnTheSeedAlone) {
  World world = test_world();
  world.wind = {.v_WA_m_s = {3.0, 0.0, 0.0}, .turbulence = 1.0};
  const auto flown = [&](std::uint64_t seed) {
    Dynamics dynamics(world, no_warnings());
    dynamics.reset(seed);
    run(dynamics, 1'000);
    return dynamics.body_state(0).p_WB;
  };
  EXPECT_EQ(flown(1), flown(1));
  EXPECT_NE(flown(1), flown(2));
}

TEST(DynamicsTest, ResetRestoresEverything) {
  World world = test_world();
  std::get<CameraModel>(world.uavs[0].sensors[testing::kCamera].model).exposure_s = 0.02;
  Dynamics dynamics(world, no_warnings());
  std::vector<double> fresh;
  dynamics.capture(fresh);
  dynamics.set_setpoint(0, uav::to_setpoint({{1.0, 0.0, 0.0}, 1.0}));
  run(dynamics, 500);
  dynamics.reset(0);
  std::vector<double> again;
  dynamics.capture(again);
  EXPECT_EQ(again, fresh);
  run(dynamics, 500);
  EXPECT_LT(norm(dynamics.body_state(0).v_WB), 1e-3) << "the command was forgotten";
}

TEST(DynamicsTest, MotionIsTheChangeOfVelocity) {
  const World world = test_world();
  Dynamics dynamics(world, no_warnings());
  dynamics.set_setpoint(0, uav::to_setpoint({{1.0, 0.5, 0.2}, 1.0}));
  run(dynamics, 150);
  const uav::BodyState before = dynamics.body_state(0);
  dynamics.step();
  const uav::BodyState after = dynamics.body_state(0);
  std::vector<double> state;
  dynamics.capture(state);
  const BodyMotion motion = StateLayout(world).motion_of(state, 0);
  EXPECT_EQ(motion.w_WB_B, after.w_WB_B);
  EXPECT_EQ(motion.v_WB_W, after.v_WB);
  EXPECT_LT(norm(motion.a_WB_W - 1000.0 * (after.v_WB - before.v_WB)), 1e-9);
  EXPECT_LT(norm(motion.alpha_WB_B - 1000.0 * (after.w_WB_B - before.w_WB_B)), 1e-9);
}

}  // namespace
}  // namespace tether::sim
