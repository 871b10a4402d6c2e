#include <numbers>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/uav/math.h>

namespace tether::uav {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 1e-12;

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT(norm(a - b), kTolerance);
}

Vec3 any_vector(KeyedRandom& random) {
  return {random.normal(), random.normal(), random.normal()};
}
Quat any_rotation(KeyedRandom& random) {
  return normalized({random.normal(), random.normal(), random.normal(), random.normal()});
}
Pose any_pose(KeyedRandom& random) {
  return {any_vector(random), any_rotation(random)};
}

TEST(Math, CrossProductIsRightHanded) {
  EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0}), (Vec3{0, 0, 1}));
}

TEST(Math, RollPitchYawAreAboutFixedAxes) {
  expect_near(rotate(from_rpy(kPi / 2, 0, 0), {0, 1, 0}), {0, 0, 1});
  expect_near(rotate(from_rpy(0, kPi / 2, 0), {1, 0, 0}), {0, 0, -1});
  expect_near(rotate(from_rpy(0, 0, kPi / 2), {1, 0, 0}), {0, 1, 0});
  // Roll first, yaw last: z → −y → x.
  expect_near(rotate(from_rpy(kPi / 2, 0, kPi / 2), {0, 0, 1}), {1, 0, 0});
}

TEST(Math, YawIsInTheHalfOpenCircle) {
  for (const double yaw : {-3.0, -1.0, 0.0, 0.5, 3.1, kPi})
    EXPECT_NEAR(yaw_rad(from_rpy(0.2, -0.3, yaw)), yaw, 1e-9);
  EXPECT_GT(yaw_rad(Quat{0, 0, 0, 1}), 0.0);
}

TEST(Math, OpticalFrameLooksAheadWithXToTheRight) {
  expect_near(rotate(q_body_from_optical(), {0, 0, 1}), {1, 0, 0});
  expect_near(rotate(q_body_from_optical(), {1, 0, 0}), {0, -1, 0});
  expect_near(rotate(q_body_from_optical(), {0, 1, 0}), {0, 0, -1});
}

TEST(Math, RotationsFormAGroupThatKeepsLengthAndOrientation) {
  KeyedRandom random({1, 2, 3});
  for (int i = 0; i < 1000; ++i) {
    const Quat a = any_rotation(random), b = any_rotation(random);
    const Vec3 u = any_vector(random), v = any_vector(random);
    expect_near(rotate(a * b, v), rotate(a, rotate(b, v)));
    expect_near(rotate(inverse(a), rotate(a, v)), v);
    expect_near(rotate(a, cross(u, v)), cross(rotate(a, u), rotate(a, v)));
    EXPECT_NEAR(dot(rotate(a, u), rotate(a, v)), dot(u, v), kTolerance);
  }
}

TEST(Math, PosesComposeAndInvert) {
  KeyedRandom random({4, 5, 6});
  for (int i = 0; i < 1000; ++i) {
    const Pose X_AB = any_pose(random), X_BC = any_pose(random);
    const Vec3 p_C = any_vector(random);
    expect_near(transform(X_AB * X_BC, p_C), transform(X_AB, transform(X_BC, p_C)));
    expect_near(transform(inverse(X_AB), transform(X_AB, p_C)), p_C);
  }
}

TEST(Math, BetweenTwoPosesBothPositionAndRotationAre) {
  const Quat turn = from_axis_angle({0, 0, 1}, 0.1);
  for (const double sign : {1.0, -1.0}) {  // the opposite quaternion is the same rotation
    const Quat q{sign * turn.w, sign * turn.x, sign * turn.y, sign * turn.z};
    const Pose quarter = between({{2, 0, 0}, {}}, {{1, 0, 4}, q}, 0.25);
    EXPECT_EQ(quarter.p, (Vec3{1.75, 0, 1}));
    EXPECT_NEAR(yaw_rad(quarter.q), 0.025, 1e-5);
  }
}

TEST(Math, NormalizedHasUnitLengthAndTheSameRotation) {
  const Quat q = normalized({2, 0, 0, 2});
  EXPECT_NEAR(q.w * q.w + q.z * q.z, 1.0, kTolerance);
  EXPECT_NEAR(yaw_rad(q), kPi / 2, kTolerance);
}

}  // namespace
}  // namespace tether::uav
