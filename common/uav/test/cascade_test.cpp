#include "cascade.h"

#include "rigid_body.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/base/units.h>

namespace tether::uav {
namespace {

/// How a quantity answered a step from 0 to 1.
struct Response {
  double settled_s = 0.0;  ///< last time outside ±5 %
  double peak = 0.0;
  double last = 0.0;
};

template <class Measure>
Response respond(FlyingBody& uav, const VelocityCommand& command, double seconds, Measure measure) {
  Response r;
  uav.fly(to_setpoint(command), seconds, [&](double t) {
    r.last = measure();
    r.peak = std::max(r.peak, r.last);
    if (std::abs(r.last - 1.0) > 0.05) r.settled_s = t;
  });
  return r;
}

TEST(VelocityLevel, StepOfOneMetrePerSecondSettlesWithLittleOvershoot) {
  for (const Vec3& axis :
       {Vec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
    SCOPED_TRACE(testing::Message() << axis.x << ' ' << axis.y << ' ' << axis.z);
    FlyingBody uav;
    const Response r = respond(uav, {axis, 0}, 4.0, [&] { return dot(axis, uav.body.v_WB); });
    EXPECT_LT(r.settled_s, 1.5);
    EXPECT_LT(r.peak, 1.10);
    EXPECT_NEAR(r.last, 1.0, 0.01);
    EXPECT_NEAR(uav.yaw(), 0.0, 1e-3);
  }
}

TEST(VelocityLevel, YawRateStepSettlesQuickly) {
  for (const double sign : {1.0, -1.0}) {
    FlyingBody uav;
    const Response r = respond(uav, {{}, sign}, 3.0, [&] { return sign * uav.body.w_WB_B.z; });
    EXPECT_LT(r.settled_s, 0.4);
    EXPECT_LT(r.peak, 1.12);
    EXPECT_NEAR(r.last, 1.0, 0.005);
    EXPECT_LT(norm(uav.body.p_WB), 0.03);
  }
}

TEST(VelocityLevel, YawStopsShortlyAndDoesNotSwingBack) {
  for (const double rate : {0.2, 0.5, 1.0}) {
    SCOPED_TRACE(rate);
    FlyingBody uav;
    uav.fly(to_setpoint({{}, rate}), 2.0);
    const double at_command = uav.yaw();
    double furthest = at_command;
    uav.fly({}, 3.0, [&](double) { furthest = std::max(furthest, uav.yaw()); });
    const double coasted = rate * rate / (2 * uav.parameters().max_yaw_acceleration_rad_s2);
    EXPECT_LT(furthest - at_command, coasted + 0.03 * rate + 1e-3);
    EXPECT_LT(deg_from_rad(furthest - uav.yaw()), 1.0);
    EXPECT_NEAR(uav.body.w_WB_B.z, 0.0, 1e-3);
  }
}

TEST(VelocityLevel, StopsFromFlight) {
  FlyingBody uav;
  uav.fly(to_setpoint({{2, 0, 0}, 0}), 4.0);
  double slowest = 1.0;
  uav.fly({}, 3.0, [&](double) { slowest = std::min(slowest, uav.body.v_WB.x); });
  EXPECT_GT(slowest, -0.2);
  EXPECT_LT(norm(uav.body.v_WB), 0.03);
}

TEST(VelocityLevel, KeepsItsSpeedAheadWhileTurning) {
  for (const double yaw_rate : {0.5, -0.5}) {
    FlyingBody uav;
    uav.fly(to_setpoint({{1, 0, 0}, yaw_rate}), 10.0, [&](double t) {
      if (t < 3.0) return;
      const Vec3 v_H = rotate(from_rpy(0, 0, -uav.yaw()), uav.body.v_WB);
      ASSERT_NEAR(v_H.x, 1.0, 0.05);
      ASSERT_NEAR(v_H.y, 0.0, 0.05);
    });
  }
}

TEST(VelocityLevel, HoldsAgainstWindAndAnOffCentreLoad) {
  FlyingBody uav;
  uav.disturbance_force_W = {0.4, -0.3, -0.2};
  uav.disturbance_torque_B = {0.01, -0.01, 0.002};
  uav.fly({}, 15.0);
  EXPECT_LT(norm(uav.body.v_WB), 0.01);
  EXPECT_NEAR(uav.yaw(), 0.0, 0.01);
}

TEST(VelocityLevel, RecoversFromAnUpset) {
  FlyingBody uav;
  uav.body.q_WB = from_rpy(1.2, -0.6, 0.3);
  uav.body.w_WB_B = {3, -4, 2};
  uav.fly({}, 6.0);
  EXPECT_LT(norm(uav.body.v_WB), 0.1);
  EXPECT_LT(uav.tilt(), 0.01);
}

TEST(VelocityLevel, RespectsTheParametersLimits) {
  KeyedRandom random({5, 0, 0});
  FlyingBody uav;
  const MultirotorParameters& p = uav.parameters();
  for (int i = 0; i < 60; ++i) {
    const VelocityCommand wild{{50 * random.normal(), 50 * random.normal(), 20 * random.normal()},
                               20 * random.normal()};
    uav.fly(to_setpoint(wild), 0.5, [&](double) {
      ASSERT_LT(uav.tilt(), p.max_tilt_rad + 0.12);
      ASSERT_LT(std::hypot(uav.body.v_WB.x, uav.body.v_WB.y), 1.2 * p.max_horizontal_speed_m_s);
      ASSERT_LT(std::abs(uav.body.v_WB.z), 1.4 * p.max_vertical_speed_m_s);
      ASSERT_LT(std::abs(uav.body.w_WB_B.z), 1.4 * p.max_yaw_rate_rad_s);
    });
  }
}

TEST(VelocityLevel, DoesNotUnwindAfterBeingHeld) {
  FlyingBody uav;
  const BodyState held = uav.body;
  for (int i = 0; i < 5000; ++i)
    uav.multirotor().step(held, to_setpoint({{1, 0, 0}, 1.0}), uav.state);
  uav.fly({}, 6.0);
  EXPECT_LT(std::abs(uav.yaw()), 0.7);
  EXPECT_LT(norm(uav.body.v_WB), 0.05);
}

// --- other levels -------------------------------------------------------------------------------

/// Second-order lag: 1/(τs² + s + k) with poles that are real, for a step of 1 (k: gain, τ: lag).
double position_step(double gain_1_s, double lag_s, double t) {
  const double root = std::sqrt(1.0 - 4.0 * gain_1_s * lag_s);
  const double s1 = (-1.0 + root) / (2.0 * lag_s), s2 = (-1.0 - root) / (2.0 * lag_s);
  return 1.0 + (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s1 - s2);
}

// Velocities follow with the lag of the acceleration: 0.2 s ahead and aside, 0.02 s upwards. Rotors
// that spin down as fast as up, because a loop with others is not linear.
TEST(PositionLevel, SmallStepFollowsTheLinearisedLoop) {
  const double step_m = 0.02;
  for (const auto& [axis, lag_s] :
       {std::pair{Vec3{1, 0, 0}, 0.2}, {{0, -1, 0}, 0.2}, {{0, 0, 1}, 0.02}, {{0, 0, -1}, 0.02}}) {
    SCOPED_TRACE(testing::Message() << axis.x << ' ' << axis.y << ' ' << axis.z);
    MultirotorParameters p = hummingbird();
    p.time_constant_down_s = p.time_constant_up_s;
    FlyingBody uav(p);
    const Vec3 direction = axis;
    const double lag = lag_s;
    uav.fly({.mask = kPosition, .in_heading = false, .p_WB_m = step_m * axis}, 8.0, [&](double t) {
      ASSERT_NEAR(dot(direction, uav.body.p_WB) / step_m, position_step(kPositionGain_1_s, lag, t),
                  0.05);
    });
    EXPECT_NEAR(norm(uav.body.p_WB - step_m * axis), 0.0, 1e-4);
  }
}

TEST(PositionLevel, ArrivesFromAfarWithoutOvershootWithinTheLimits) {
  FlyingBody uav;
  const MultirotorParameters& p = uav.parameters();
  const Vec3 goal{30, -40, 6};
  uav.fly({.mask = kPosition | kYaw, .in_heading = false, .p_WB_m = goal, .yaw_rad = 2.0}, 25.0,
          [&](double) {
            ASSERT_LT(std::hypot(uav.body.v_WB.x, uav.body.v_WB.y),
                      1.05 * p.max_horizontal_speed_m_s);
            ASSERT_LT(dot(uav.body.p_WB, {0.6, -0.8, 0}), 50.05);
            ASSERT_LT(uav.body.p_WB.z, 6.02);
          });
  EXPECT_LT(norm(uav.body.p_WB - goal), 0.01);
  EXPECT_NEAR(uav.yaw(), 2.0, 1e-3);
}

TEST(PositionLevel, FollowsACircleThatIsFedForward) {
  FlyingBody uav;
  const double r_m = 2.0, w = 0.5;
  for (int k = 0; k < 1000; ++k) {
    const double phase = w * 0.02 * k;
    const Vec3 out{std::cos(phase), std::sin(phase), 0}, along{-out.y, out.x, 0};
    uav.fly({.mask = kPosition | kVelocity | kAcceleration | kYaw,
             .in_heading = false,
             .p_WB_m = r_m * (out - Vec3{1, 0, 0}),
             .velocity_m_s = (r_m * w) * along,
             .acceleration_m_s2 = (-r_m * w * w) * out,
             .yaw_rad = wrap_angle_rad(phase)},
            0.02);
    if (k > 300) {
      ASSERT_LT(norm(uav.body.p_WB - r_m * (out - Vec3{1, 0, 0})), 0.15) << k;
    }
  }
}

TEST(Yaw, SmallStepFollowsTheFirstOrderLag) {
  for (const double start : {0.0, 3.1}) {
    FlyingBody uav(hummingbird(), start);
    const double step = 0.1;
    uav.fly({.mask = kVelocity | kYaw, .yaw_rad = start + step}, 4.0, [&](double t) {
      const double turned = wrap_angle_rad(uav.yaw() - start) / step;
      ASSERT_NEAR(turned, 1.0 - std::exp(-kYawGain_1_s * t), 0.06);
    });
  }
}

TEST(VelocityLevel, KeepsItsDirectionInTheWorldWhileTurning) {
  FlyingBody uav;
  uav.fly({.mask = kVelocity | kYawRate,
           .in_heading = false,
           .velocity_m_s = {1, 0.5, 0.2},
           .yaw_rate_rad_s = 2.0},
          6.0, [&](double t) {
            if (t < 3.0) return;
            ASSERT_LT(norm(uav.body.v_WB - Vec3{1, 0.5, 0.2}), 0.06);
          });
}

TEST(VelocityLevel, ChangeOfFrameIsNotSeen) {
  FlyingBody a(hummingbird(), 0.8), b(hummingbird(), 0.8);
  const Vec3 v_H{1, 0, 0}, v_W = rotate(from_rpy(0, 0, 0.8), v_H);
  for (int i = 0; i < 10; ++i) {
    a.fly(to_setpoint({v_H, 0}), 0.2);
    b.fly(i % 2 == 0 ? to_setpoint({v_H, 0})
                     : Setpoint{.mask = kVelocity, .in_heading = false, .velocity_m_s = v_W},
          0.2);
  }
  EXPECT_LT(norm(a.body.v_WB - b.body.v_WB), 1e-3);
}

// The velocity is a·(t − T), T the lag of the attitude or, upwards, of the rotors. The drag grows
// by 0.2 m/s² in a second; the attitude follows that with the same lag, 0.04 m/s² behind.
TEST(AccelerationLevel, IsReachedAfterTheLagOfTheLoopsWithin) {
  for (const auto& [a_W, lag_s] : {std::pair{Vec3{0.8, -0.6, 0}, 0.2}, {{0, 0, 1}, 0.0125}}) {
    FlyingBody uav;
    const Setpoint setpoint{.mask = kAcceleration, .in_heading = false, .acceleration_m_s2 = a_W};
    uav.fly(setpoint, 1.0);
    const Vec3 v_at_1s = uav.body.v_WB;
    uav.fly(setpoint, 1.0);
    EXPECT_LT(norm(uav.body.v_WB - v_at_1s - a_W), 0.045);
    EXPECT_NEAR(1.0 - norm(v_at_1s), lag_s, 0.25 * lag_s);
  }
}

/// Rate loop (PI with the lag of the rotors) and, if `attitude_gain` is not 0, attitude loop around
/// it, linearised: the answer to a step of 1. The rotors of a pair spin up and down: their lag is
/// between both.
struct LinearLoop {
  double attitude_gain = 0.0;
  double angle = 0.0, rate = 0.0, integral = 0.0, acceleration = 0.0;

  void advance(double dt_s, double lag_s) {
    const double wanted = attitude_gain == 0.0 ? 1.0 : attitude_gain * (1.0 - angle);
    const double asked = 24.0 * (wanted - rate) + integral;
    integral += 25.0 * (wanted - rate) * dt_s;
    acceleration += (asked - acceleration) * dt_s / lag_s;
    rate += acceleration * dt_s;
    angle += rate * dt_s;
  }
};

TEST(AttitudeLevel, SmallStepFollowsTheLinearisedLoop) {
  FlyingBody uav;
  const double step_rad = 0.02;
  const double lag_s =
      0.5 * (uav.parameters().time_constant_up_s + uav.parameters().time_constant_down_s);
  LinearLoop loop{.attitude_gain = 7.0};
  uav.fly({.mask = kAttitude | kThrust,
           .q_WB = from_rpy(step_rad, 0, 0),
           .thrust_N = uav.parameters().mass_kg * FlyingBody::kGravity},
          1.0, [&](double) {
            loop.advance(FlyingBody::kDt_s, lag_s);
            const double roll = std::asin(rotate(uav.body.q_WB, {0, 1, 0}).z);
            ASSERT_NEAR(roll / step_rad, loop.angle, 0.06);
          });
}

TEST(BodyRatesLevel, SmallStepFollowsTheLinearisedLoop) {
  FlyingBody uav;
  const double step_rad_s = 0.1;
  const double lag_s =
      0.5 * (uav.parameters().time_constant_up_s + uav.parameters().time_constant_down_s);
  LinearLoop loop;
  uav.fly({.mask = kBodyRates | kThrust,
           .w_WB_B_rad_s = {0, step_rad_s, 0},
           .thrust_N = uav.parameters().mass_kg * FlyingBody::kGravity},
          0.6, [&](double) {
            loop.advance(FlyingBody::kDt_s, lag_s);
            ASSERT_NEAR(uav.body.w_WB_B.y / step_rad_s, loop.rate, 0.08);
          });
}

TEST(RotorLevel, SpeedsFollowTheirTimeConstants) {
  FlyingBody uav;
  const double hover = uav.state.rotor_speed_rad_s[0];
  const Setpoint setpoint{.mask = kRotorSpeeds,
                          .rotor_speeds_rad_s = {hover + 50, hover - 50, hover, hover}};
  for (int i = 0; i < 10; ++i) uav.multirotor().step(uav.body, setpoint, uav.state);
  EXPECT_NEAR(uav.state.rotor_speed_rad_s[0], hover + 50 * (1 - std::exp(-0.010 / 0.0125)), 1e-9);
  EXPECT_NEAR(uav.state.rotor_speed_rad_s[1], hover - 50 * (1 - std::exp(-0.010 / 0.025)), 1e-9);
  EXPECT_NEAR(uav.state.rotor_speed_rad_s[2], hover, 1e-9);
}

Setpoint any_setpoint(KeyedRandom& random, const FlyingBody& uav) {
  const auto vec = [&](double scale) {
    return scale * Vec3{random.normal(), random.normal(), random.normal()};
  };
  const double weight_N = uav.parameters().mass_kg * FlyingBody::kGravity;
  const double hover = hover_state(uav.parameters(), FlyingBody::kGravity, 0).rotor_speed_rad_s[0];
  constexpr std::uint16_t kMasks[] = {
      kPosition | kYaw,         kPosition | kVelocity | kAcceleration | kYawRate,
      kVelocity | kYaw,         kVelocity | kAcceleration,
      kAcceleration | kYawRate, kAttitude | kThrust,
      kBodyRates | kThrust,     kRotorSpeeds};
  Setpoint s{.mask = kMasks[static_cast<std::size_t>(8 * random.uniform())],
             .p_WB_m = vec(3),
             .velocity_m_s = vec(2),
             .acceleration_m_s2 = vec(2),
             .yaw_rad = 3 * random.normal(),
             .yaw_rate_rad_s = 2 * random.normal(),
             .q_WB = from_rpy(0.3 * random.normal(), 0.3 * random.normal(), random.normal()),
             .w_WB_B_rad_s = vec(1),
             .thrust_N = weight_N * (0.7 + 0.6 * random.uniform()),
             .rotor_speeds_rad_s = {}};
  s.in_heading = !s.has(kPosition) && random.uniform() < 0.5;
  for (int i = 0; i < 4; ++i)
    s.rotor_speeds_rad_s.push_back(hover * (0.99 + 0.02 * random.uniform()));
  return s;
}

TEST(Cascade, AnyOrderOfSetpointsIsFollowedByAStop) {
  for (std::uint64_t flight = 0; flight < 100; ++flight) {
    KeyedRandom random({7, flight, 0});
    FlyingBody uav;
    for (int i = 0; i < 12; ++i) {
      const Setpoint setpoint = any_setpoint(random, uav);
      ASSERT_EQ(complaint_about(setpoint, flight_limits(uav.parameters())), "");
      uav.fly(setpoint, 0.3 * random.uniform());
    }
    uav.fly({}, 10.0);
    ASSERT_LT(norm(uav.body.v_WB), 0.05) << flight;
    ASSERT_LT(uav.tilt(), 0.02) << flight;
  }
}

}  // namespace
}  // namespace tether::uav
