#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/sim/simulator.h>

namespace tether::sim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr double kGravity_m_s2 = 9.81;

HoverLoop loop_at(Duration step, const uav::MultirotorParameters& airframe = uav::hummingbird()) {
  return hover_loop(airframe, kGravity_m_s2, step);
}

/// Hover with these steps after a push, in a plane; the tilts of the last second [rad].
std::vector<double> tilts_after_a_push(Duration step) {
  const uav::Multirotor multirotor(uav::hummingbird(), kGravity_m_s2, step);
  const uav::MultirotorParameters& frame = multirotor.parameters();
  uav::MultirotorState state = uav::hover_state(frame, kGravity_m_s2, 0.0);
  uav::BodyState body;
  body.w_WB_B.y = 0.1;
  const double dt_s = to_seconds(step);
  double tilt_rad = 0.0;
  std::vector<double> tilts;
  for (double t_s = 0.0; t_s < 10.0; t_s += dt_s) {
    body.q_WB = uav::from_rpy(0.0, tilt_rad, 0.0);
    const uav::Wrench wrench = multirotor.step(body, {}, state);
    const uav::Vec3 force_W = rotate(body.q_WB, wrench.force_B);
    body.v_WB.x += dt_s * force_W.x / frame.mass_kg;
    body.v_WB.z += dt_s * (force_W.z / frame.mass_kg - kGravity_m_s2);
    body.w_WB_B.y += dt_s * wrench.torque_B.y / frame.inertia_kg_m2.y;
    tilt_rad += dt_s * body.w_WB_B.y;
    if (t_s >= 9.0) tilts.push_back(std::abs(tilt_rad));
  }
  return tilts;
}

TEST(HoverLoop, IsWellDampedAtShortStepsAndStableUpToSome70Milliseconds) {
  for (const Duration step : {Duration(1), Duration(microseconds(10)), Duration(milliseconds(1)),
                              Duration(milliseconds(10)), Duration(milliseconds(50))}) {
    EXPECT_LT(loop_at(step).growth, 1.0) << to_ns(step);
    EXPECT_GT(loop_at(step).damping, 0.45) << to_ns(step);
  }
  EXPECT_LT(loop_at(milliseconds(70)).growth, 1.0);
  EXPECT_GT(loop_at(milliseconds(75)).growth, 1.0);
  EXPECT_LT(loop_at(milliseconds(75)).damping, 0.0);
}

TEST(HoverLoop, IsStableAtTheStepsAtWhichAFlightComesToRest) {
  EXPECT_LT(std::ranges::max(tilts_after_a_push(milliseconds(60))), 1e-3);
  EXPECT_LT(loop_at(milliseconds(60)).growth, 1.0);
  EXPECT_GT(std::ranges::max(tilts_after_a_push(milliseconds(80))), 0.1);
  EXPECT_GT(loop_at(milliseconds(80)).growth, 1.0);
}

TEST(HoverLoop, DependsOnTheRotors) {
  uav::MultirotorParameters slow = uav::hummingbird();
  slow.time_constant_up_s = slow.time_constant_down_s = 0.05;
  EXPECT_LT(loop_at(milliseconds(1), slow).damping, 0.3);
  uav::MultirotorParameters heavy = uav::hummingbird();  // the gains are those of accelerations
  heavy.mass_kg *= 0.5;
  heavy.inertia_kg_m2 = 2.0 * heavy.inertia_kg_m2;
  EXPECT_NEAR(loop_at(milliseconds(50), heavy).damping, loop_at(milliseconds(50)).damping, 0.02);
}

class CheckStep : public ::testing::Test {
 protected:
  CheckStep() {
    world_.file = "/w.sdf";
    world_.step_at = {"/s.toml", 3};
    world_.uavs.resize(1);
    world_.uavs[0].name = "uav1";
    world_.uavs[0].airframe = uav::hummingbird();
  }
  void check(Controller controller = Controller::kOurs) {
    check_step(world_, controller, [&](const Warning& warning) { warnings_.push_back(warning); });
  }
  World world_;
  std::vector<Warning> warnings_;
};

TEST_F(CheckStep, DoubtsThrustThatNoRotorsHave) {
  world_.uavs[0].airframe.thrust_coefficient *= 1000.0;
  check();
  ASSERT_FALSE(warnings_.empty());
  EXPECT_EQ(warnings_[0].consequence, Consequence::kDoubtful);
  EXPECT_THAT(warnings_[0].message, HasSubstr("times its weight"));
}

TEST_F(CheckStep, SaysNothingOfAGoodStep) {
  check();
  world_.step = milliseconds(50);
  check();
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(CheckStep, WarnsOfAStepThatDampsPoorly) {
  world_.step = milliseconds(65);
  check();
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_EQ(warnings_[0].where, world_.step_at);
  EXPECT_EQ(warnings_[0].subject, "UAV 'uav1'");
  EXPECT_THAT(warnings_[0].message, HasSubstr("a step of 65 ms"));
  EXPECT_THAT(warnings_[0].message, HasSubstr("at most 56"));
  EXPECT_TRUE(warnings_[0].can_change_verdict);
}

TEST_F(CheckStep, RefusesAStepThatIsNotStable) {
  world_.step = milliseconds(80);
  Error error = bad_file_error([&] { check(); });
  EXPECT_EQ(error.where(), world_.step_at);
  EXPECT_THAT(error.what(), HasSubstr("use a step of at most 56"));
  world_.step_at = {};
  error = bad_file_error([&] { check(); });
  EXPECT_EQ(error.where().file, "/w.sdf");
}

TEST_F(CheckStep, OnlyWarnsIfTheControllerMayBeAnother) {
  world_.step = milliseconds(80);
  check(Controller::kUnknown);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_THAT(warnings_[0].message, HasSubstr("not stabilised by Tether's controller"));
}

TEST_F(CheckStep, NamesTheRotorsIfNoStepHelps) {
  world_.uavs[0].airframe.time_constant_up_s = 0.2;
  world_.uavs[0].airframe.time_constant_down_s = 0.3;
  EXPECT_THAT(bad_file_error([&] { check(); }).what(), HasSubstr("its rotors are too slow"));
}

}  // namespace
}  // namespace tether::sim
