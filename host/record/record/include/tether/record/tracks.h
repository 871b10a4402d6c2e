#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/record/reader.h>
#include <tether/uav/math.h>
#include <tether/uav/path.h>

/// Where UAVs and anchors are during a run. Pure; the record must outlive what is made of it.
namespace tether::record {

/// The true poses of a UAV.
class UavTrack {
 public:
  UavTrack(const Record& record, const std::string& uav);

  /// X_WB at an instant, interpolated between the two nearest ground truths: the position linearly,
  /// the attitude along the shortest arc. Up to one ground-truth period before the first or after
  /// the last, that one's pose; beyond that, and for an unknown UAV, none.
  std::optional<uav::Pose> at(SimTime instant) const;
  /// The angles of its joints, interpolated linearly in the same way.
  std::vector<double> joints_rad(SimTime instant) const;

 private:
  std::vector<const GroundTruth*> truths_;  // by time
  Duration period_;
};

/// Of one instant: UavTrack::at.
std::optional<uav::Pose> pose_at(const Record& record, const std::string& uav, SimTime instant);

/// A camera as it was mounted at that instant: turned by the joints of its UAV.
SensorInfo mounted_at(const SensorInfo& camera, const Record& record, SimTime instant);

/// Where an anchor is: it stands still, follows a path, or is a UAV.
class AnchorTrack {
 public:
  AnchorTrack(const Anchor& anchor, const Record& record);

  /// It at that instant, as an anchor that stands still. Where the record does not have the pose of
  /// its UAV, it is at its start.
  Anchor at(SimTime instant) const;
  bool moves() const { return !path_.waypoints.empty() || uav_.has_value(); }

 private:
  Anchor start_;  // without its path
  uav::Pose X_WA_;
  uav::Path path_;
  uav::Pose X_WO_;
  std::optional<UavTrack> uav_;
  uav::Vec3 p_BA_;
};

}  // namespace tether::record
