#pragma once

#include "simulator_generated.h"

#include <tether/uav/math.h>
#include <tether/uav/multirotor.h>

/// The small types that both directions are made of, between the schema's and our own.
namespace tether::sim::protocol {

inline wire::Vec3 to_wire(const uav::Vec3& v) {
  return {v.x, v.y, v.z};
}
inline wire::Quat to_wire(const uav::Quat& q) {
  return {q.w, q.x, q.y, q.z};
}
inline wire::Pose to_wire(const uav::Pose& X) {
  return {to_wire(X.p), to_wire(X.q)};
}
inline uav::Vec3 from_wire(const wire::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline uav::Quat from_wire(const wire::Quat& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
inline uav::Pose from_wire(const wire::Pose& X) {
  return {from_wire(X.p()), from_wire(X.q())};
}

}  // namespace tether::sim::protocol
