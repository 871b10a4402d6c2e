#pragma once

#include <cmath>

/// Plain vectors and rotations, free of any library, for public interfaces. Notation: `p_WB` is the
/// position of B's origin in W [m]; `q_WB` rotates a vector's coordinates from B to W; `X_WB` is
/// the pose of B in W. Frames: W world (ENU), B body (FLU), H heading (W turned by the UAV's yaw
/// about z), C camera optical (x right, y down, z forward), S any sensor.
///
/// Pure functions of values; safe from any thread.
namespace tether::uav {

struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// Unit quaternion, Hamilton convention.
struct Quat {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
  friend bool operator==(const Quat&, const Quat&) = default;
};

struct Pose {
  Vec3 p;  ///< position of the frame's origin [m]
  Quat q;  ///< rotation from the frame to the parent
  friend bool operator==(const Pose&, const Pose&) = default;
};

// Inline, because the step loop of the multirotor consists of these.
constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator*(double s, const Vec3& v) {
  return {s * v.x, s * v.y, s * v.z};
}
constexpr double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec3& v) {
  return std::sqrt(dot(v, v));
}

constexpr Quat operator*(const Quat& a, const Quat& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
constexpr Quat inverse(const Quat& q) {
  return {q.w, -q.x, -q.y, -q.z};
}
/// `rotate(q_AB, v_B)` → `v_A`.
constexpr Vec3 rotate(const Quat& q, const Vec3& v) {
  const Vec3 u{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}
/// Rotation about a unit axis, right-handed [rad].
Quat from_axis_angle(const Vec3& axis, double angle_rad);
/// Fixed-axis roll, pitch, yaw (SDF's convention: R = Rz(yaw) Ry(pitch) Rx(roll)) [rad].
Quat from_rpy(double roll_rad, double pitch_rad, double yaw_rad);
/// Yaw of B in W, counter-clockwise from east [rad], in (−π, π].
double yaw_rad(const Quat& q_WB);
/// The same rotation with unit length. A zero or non-finite quaternion gives a non-finite one.
Quat normalized(const Quat& q);

/// `X_AB * X_BC` → `X_AC`.
constexpr Pose operator*(const Pose& X_AB, const Pose& X_BC) {
  return {X_AB.p + rotate(X_AB.q, X_BC.p), X_AB.q * X_BC.q};
}
constexpr Pose inverse(const Pose& X_AB) {
  const Quat q_BA = inverse(X_AB.q);
  return {-1.0 * rotate(q_BA, X_AB.p), q_BA};
}
/// A pose between two that are near each other, `share` of the way from `a` to `b`.
Pose between(const Pose& a, const Pose& b, double share);
/// `transform(X_AB, p_BQ)` → `p_AQ`.
constexpr Vec3 transform(const Pose& X_AB, const Vec3& p_B) {
  return X_AB.p + rotate(X_AB.q, p_B);
}

/// Rotation from the camera's optical frame C (x right, y down, z forward) to a body-style frame
/// (x forward, y left, z up) mounted at the same place, as SDF mounts a camera (REP-103).
constexpr Quat q_body_from_optical() {
  return {0.5, -0.5, 0.5, -0.5};
}

}  // namespace tether::uav
