#include <tether/record/messages.h>
#include <tether/uav/path.h>

namespace tether::record {

Anchor anchor_at(const Anchor& anchor, SimTime at) {
  if (anchor.path.empty()) return anchor;
  const auto vec3 = [](const double(&v)[3]) { return uav::Vec3{v[0], v[1], v[2]}; };
  uav::Path path{{}, anchor.path_repeats, anchor.path_delay};
  for (const Waypoint& waypoint : anchor.path)
    path.waypoints.push_back({waypoint.at, vec3(waypoint.p_m), waypoint.yaw_rad});
  const uav::Pose X_WO{vec3(anchor.p_WO_m), {}};
  const double(&q)[4] = anchor.q_WA;
  const uav::Pose X_WA{vec3(anchor.p_WA_m), {q[0], q[1], q[2], q[3]}};
  const uav::Pose now = moved(X_WO, state_at(path, at - SimTime{})) * (inverse(X_WO) * X_WA);
  return {.name = anchor.name,
          .shape = anchor.shape,
          .size_m = {anchor.size_m[0], anchor.size_m[1], anchor.size_m[2]},
          .p_WA_m = {now.p.x, now.p.y, now.p.z},
          .q_WA = {now.q.w, now.q.x, now.q.y, now.q.z}};
}

}  // namespace tether::record
