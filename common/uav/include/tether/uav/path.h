#pragma once

#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/math.h>

/// A motion that is given in advance, such as that of a platform to land on. Pure functions of
/// values; safe from any thread.
namespace tether::uav {

/// Where something is at an instant, seen from where it was placed.
struct Waypoint {
  Duration at{0};        ///< since the beginning
  Vec3 p_m;              ///< offset, along W's axes
  double yaw_rad = 0.0;  ///< about W's z, in addition to how it was placed; not wrapped
  friend bool operator==(const Waypoint&, const Waypoint&) = default;
};

/// Goes through its waypoints at their times, by monotone cubic splines (three-point differences,
/// limited as by Fritsch and Carlson): velocities do not jump, and along each axis it stays between
/// two neighbours, so that it rests between equal ones. It rests before the first waypoint and
/// after the last one, or repeats.
struct Path {
  std::vector<Waypoint> waypoints;  ///< in the order of their times, which differ
  bool repeats = false;             ///< then it begins at 0, and ends where it begins
  Duration delay{0};                ///< by which all of it is later
  friend bool operator==(const Path&, const Path&) = default;
};

/// Faster, it would jump past what it should meet. Of the chords: a spline goes up to three times
/// as fast on its way.
inline constexpr double kFastest_m_s = 100.0;

/// What is wrong with a path, for a person: "needs two waypoints or more". Empty: nothing.
std::string complaint_about(const Path& path);

struct PathState {
  Vec3 p_m;  ///< as those of a Waypoint
  double yaw_rad = 0.0;
  Vec3 v_m_s;
  double yaw_rate_rad_s = 0.0;
  Vec3 a_m_s2;
  double yaw_acceleration_rad_s2 = 0.0;
};

/// @pre the path has no complaint
PathState state_at(const Path& path, Duration since_beginning);
/// The pose of something that was placed at `X_WM`.
Pose moved(const Pose& X_WM, const PathState& state);

}  // namespace tether::uav
