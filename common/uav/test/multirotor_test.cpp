#include "rigid_body.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/uav/multirotor.h>

namespace tether::uav {
namespace {

constexpr double kGravity = FlyingBody::kGravity;
constexpr Duration kDt = FlyingBody::kDt;

VelocityCommand any_command(KeyedRandom& random) {
  return {{3 * random.normal(), 3 * random.normal(), random.normal()}, random.normal()};
}

TEST(HoverState, IsAnEquilibriumOfTheHummingbirdWellBelowFullThrust) {
  const MultirotorParameters p = hummingbird();
  MultirotorState state = hover_state(p, kGravity, 0.7);
  BodyState body;
  body.q_WB = from_rpy(0, 0, 0.7);
  const Wrench wrench = Multirotor(p, kGravity, kDt).step(body, {}, state);
  EXPECT_NEAR(wrench.force_B.z, p.mass_kg * kGravity, 1e-9);
  EXPECT_NEAR(std::hypot(wrench.force_B.x, wrench.force_B.y), 0, 1e-12);
  EXPECT_LT(norm(wrench.torque_B), 1e-9);
  const double full = 4 * p.thrust_coefficient * std::pow(p.max_rotor_speed_rad_s, 2);
  EXPECT_GT(full, 3 * p.mass_kg * kGravity);
}

TEST(HoverState, DoesNotDriftInAMinute) {
  FlyingBody uav(hummingbird(), 1.0);
  uav.fly({}, 60.0);
  EXPECT_LT(norm(uav.body.p_WB), 1e-6);
  EXPECT_NEAR(uav.yaw(), 1.0, 1e-9);
}

TEST(Step, IsDeterministicAndResumesFromASnapshot) {
  KeyedRandom random({3, 0, 0});
  FlyingBody a, b, resumed;
  for (int i = 0; i < 40; ++i) {
    const VelocityCommand command = any_command(random);
    if (i == 20) {
      resumed.body = a.body;
      resumed.state = a.state;
    }
    a.fly(to_setpoint(command), 0.1);
    b.fly(to_setpoint(command), 0.1);
    if (i >= 20) resumed.fly(to_setpoint(command), 0.1);
  }
  for (const FlyingBody* other : {&b, &resumed}) {
    EXPECT_EQ(a.state, other->state);
    EXPECT_EQ(a.body.p_WB, other->body.p_WB);
  }
}

TEST(Step, RotorsSpinUpFasterThanDown) {
  const MultirotorParameters p = hummingbird();
  const auto change_after_10ms = [&p](double climb_m_s) {
    FlyingBody uav(p);
    const double before = uav.state.rotor_speed_rad_s[0];
    for (int i = 0; i < 10; ++i)
      uav.multirotor().step(uav.body, to_setpoint({{0, 0, climb_m_s}, 0}), uav.state);
    return uav.state.rotor_speed_rad_s[0] - before;
  };
  EXPECT_GT(change_after_10ms(0.5), 0.0);
  EXPECT_GT(change_after_10ms(0.5), -change_after_10ms(-0.5));
}

TEST(Step, DragOpposesTheMotionAcrossTheRotors) {
  MultirotorParameters p = hummingbird();
  BodyState body;
  body.v_WB = {2, 0, 0};
  MultirotorState state = hover_state(p, kGravity, 0);
  const double rotors =
      -Multirotor(p, kGravity, kDt).step(body, to_setpoint({{2, 0, 0}, 0}), state).force_B.x;
  double speeds = 0;
  for (const double speed : state.rotor_speed_rad_s) speeds += speed;
  EXPECT_NEAR(rotors, 2 * p.drag_coefficient * speeds, 1e-9);

  p.linear_drag_N_s_m = 0.1;
  state = hover_state(p, kGravity, 0);
  const double both =
      -Multirotor(p, kGravity, kDt).step(body, to_setpoint({{2, 0, 0}, 0}), state).force_B.x;
  EXPECT_NEAR(both - rotors, 0.2, 0.001);
}

TEST(Step, NonFiniteInputGivesANonFiniteWrench) {
  const MultirotorParameters p = hummingbird();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<BodyState, VelocityCommand>> inputs = {
      {{.p_WB = {}, .q_WB = {}, .v_WB = {0, nan, 0}, .w_WB_B = {}}, {}},
      {{.p_WB = {}, .q_WB = {}, .v_WB = {}, .w_WB_B = {0, 0, nan}}, {}},
      {{}, {{nan, 0, 0}, 0}},
      {{}, {{0, 0, nan}, 0}},
      {{}, {{}, nan}}};
  for (const auto& [body, command] : inputs) {
    MultirotorState state = hover_state(p, kGravity, 0);
    const Wrench wrench = Multirotor(p, kGravity, kDt).step(body, to_setpoint(command), state);
    EXPECT_FALSE(std::isfinite(wrench.force_B.z) && std::isfinite(wrench.torque_B.z));
  }
}

}  // namespace
}  // namespace tether::uav
