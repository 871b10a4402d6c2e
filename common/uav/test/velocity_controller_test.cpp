#include "velocity_controller.h"

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
  uav.fly(command, seconds, [&](double t) {
    r.last = measure();
    r.peak = std::max(r.peak, r.last);
    if (std::abs(r.last - 1.0) > 0.05) r.settled_s = t;
  });
  return r;
}

TEST(VelocityController, StepOfOneMetrePerSecondSettlesWithLittleOvershoot) {
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

TEST(VelocityController, YawRateStepSettlesQuickly) {
  for (const double sign : {1.0, -1.0}) {
    FlyingBody uav;
    const Response r = respond(uav, {{}, sign}, 3.0, [&] { return sign * uav.body.w_WB_B.z; });
    EXPECT_LT(r.settled_s, 0.4);
    EXPECT_LT(r.peak, 1.12);
    EXPECT_NEAR(r.last, 1.0, 0.005);
    EXPECT_LT(norm(uav.body.p_WB), 0.03);
  }
}

TEST(VelocityController, YawStopsShortlyAndDoesNotSwingBack) {
  for (const double rate : {0.2, 0.5, 1.0}) {
    SCOPED_TRACE(rate);
    FlyingBody uav;
    uav.fly({{}, rate}, 2.0);
    const double at_command = uav.yaw();
    double furthest = at_command;
    uav.fly({}, 3.0, [&](double) { furthest = std::max(furthest, uav.yaw()); });
    const double coasted = rate * rate / (2 * uav.parameters().max_yaw_acceleration_rad_s2);
    EXPECT_LT(furthest - at_command, coasted + 0.03 * rate + 1e-3);
    EXPECT_LT(deg_from_rad(furthest - uav.yaw()), 1.0);
    EXPECT_NEAR(uav.body.w_WB_B.z, 0.0, 1e-3);
  }
}

TEST(VelocityController, StopsFromFlight) {
  FlyingBody uav;
  uav.fly({{2, 0, 0}, 0}, 4.0);
  double slowest = 1.0;
  uav.fly({}, 3.0, [&](double) { slowest = std::min(slowest, uav.body.v_WB.x); });
  EXPECT_GT(slowest, -0.2);
  EXPECT_LT(norm(uav.body.v_WB), 0.03);
}

TEST(VelocityController, KeepsItsSpeedAheadWhileTurning) {
  for (const double yaw_rate : {0.5, -0.5}) {
    FlyingBody uav;
    uav.fly({{1, 0, 0}, yaw_rate}, 10.0, [&](double t) {
      if (t < 3.0) return;
      const Vec3 v_H = rotate(from_rpy(0, 0, -uav.yaw()), uav.body.v_WB);
      ASSERT_NEAR(v_H.x, 1.0, 0.05);
      ASSERT_NEAR(v_H.y, 0.0, 0.05);
    });
  }
}

TEST(VelocityController, HoldsAgainstWindAndAnOffCentreLoad) {
  FlyingBody uav;
  uav.disturbance_force_W = {0.4, -0.3, -0.2};
  uav.disturbance_torque_B = {0.01, -0.01, 0.002};
  uav.fly({}, 15.0);
  EXPECT_LT(norm(uav.body.v_WB), 0.01);
  EXPECT_NEAR(uav.yaw(), 0.0, 0.01);
}

TEST(VelocityController, RecoversFromAnUpset) {
  FlyingBody uav;
  uav.body.q_WB = from_rpy(1.2, -0.6, 0.3);
  uav.body.w_WB_B = {3, -4, 2};
  uav.fly({}, 6.0);
  EXPECT_LT(norm(uav.body.v_WB), 0.1);
  EXPECT_LT(uav.tilt(), 0.01);
}

TEST(VelocityController, RespectsTheParametersLimits) {
  KeyedRandom random({5, 0, 0});
  FlyingBody uav;
  const MultirotorParameters& p = uav.parameters();
  for (int i = 0; i < 60; ++i) {
    const VelocityCommand wild{{50 * random.normal(), 50 * random.normal(), 20 * random.normal()},
                               20 * random.normal()};
    uav.fly(wild, 0.5, [&](double) {
      ASSERT_LT(uav.tilt(), p.max_tilt_rad + 0.12);
      ASSERT_LT(std::hypot(uav.body.v_WB.x, uav.body.v_WB.y), 1.2 * p.max_horizontal_speed_m_s);
      ASSERT_LT(std::abs(uav.body.v_WB.z), 1.4 * p.max_vertical_speed_m_s);
      ASSERT_LT(std::abs(uav.body.w_WB_B.z), 1.4 * p.max_yaw_rate_rad_s);
    });
  }
}

TEST(VelocityController, DoesNotUnwindAfterBeingHeld) {
  FlyingBody uav;
  const BodyState held = uav.body;
  for (int i = 0; i < 5000; ++i) uav.multirotor().step(held, {{1, 0, 0}, 1.0}, uav.state);
  uav.fly({}, 6.0);
  EXPECT_LT(std::abs(uav.yaw()), 0.7);
  EXPECT_LT(norm(uav.body.v_WB), 0.05);
}

}  // namespace
}  // namespace tether::uav
