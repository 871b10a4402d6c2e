#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tether/record/messages.h>
#include <tether/uav/math.h>
#include <tether/uav/path.h>

namespace tether::record {

template <class Message>
struct Logged {
  SimTime at;               ///< log time
  std::uint64_t order = 0;  ///< position among all of Tether's messages in the file: 0, 1, 2, …
  Message message;
};

/// The messages of a channel are numbered 0, 1, 2, …, and this number is not the next one: messages
/// were removed, repeated or moved after the record was written.
struct Miscount {
  std::string topic;
  SimTime at;  ///< log time
  std::uint64_t expected = 0;
  std::uint64_t found = 0;
};

inline constexpr std::size_t kMaxMiscounts = 1'000;

/// A whole record in memory, each topic in file order.
struct Record {
  Header header;
  std::vector<Logged<Interaction>> interactions;
  std::vector<Logged<CommandEffect>> commands;
  std::vector<Logged<GroundTruth>> ground_truth;
  std::vector<Logged<Annotation>> annotations;
  std::vector<Logged<Stop>> stops;
  std::vector<Logged<Contact>> contacts;
  std::vector<Logged<Battery>> batteries;
  std::vector<Logged<RadioMessage>> radio;
  std::vector<Logged<AutopilotMessage>> autopilot;
  std::vector<Logged<Image>> images;
  std::vector<Logged<RawImage>> raw_images;
  std::optional<Footer> footer;
  /// Messages that the file has and this does not: images if they were not asked for, poses for 3D
  /// views, and what others added. By topic.
  std::map<std::string, std::uint64_t> unloaded;
  std::vector<Miscount> miscounts;  ///< in file order, also of images; at most kMaxMiscounts
  /// Where and why reading stopped early (truncated or damaged file), in one printable line:
  /// "damaged at byte N: …". N is the start of the first damaged record of the container (for
  /// messages: of their chunk). Empty: the file was read to its end.
  std::string damage;
};

/// Log time of the last message; 0 if there is none.
SimTime last_time(const Record& record);

/// How far a record without its end goes, and its damage, in one printable line: "truncated at
/// ST 1.500000 s, after 420 interactions; damaged at byte N: …". Empty if it has its end and no
/// damage.
std::string describe_damage(const Record& record);

struct ReadOptions {
  bool images = false;  ///< also load images
};

/// Reads from front to back, checks every length and every CRC, and stops at the first damage.
/// The result has every message of every complete chunk before it (see `make_mcap_recorder` for the
/// size of chunks). A truncated chunk gives no messages: its CRC covers the whole chunk, and zstd
/// unpacks blocks of 128 KiB, which is more than most chunks have. Damage between chunks may show
/// only in the CRC at the end of the data section. `damage` then names that CRC, and messages may
/// be missing anywhere before it. Memory is bounded by the size of the file.
/// @throws Error(kBadFile) with the file if it does not exist, is not an MCAP file, is not a record
/// of Tether, has a newer schema, or is truncated before the end of its header.
Record read_record(const std::filesystem::path& file, const ReadOptions& options = {});

// Where UAVs and anchors are during a run. Pure; the record must outlive what is made of it.

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
