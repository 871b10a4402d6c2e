#pragma once

#include "exact.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <tether/record/reader.h>

/// The ground truth of each UAV, and how far physics lets it be from there.
namespace tether::audit {

/// Of a UAV's largest acceleration: drag and what rounds the motion of a step.
inline constexpr double kMargin = 1.5;

struct Track {
  const record::SutInfo* info = nullptr;
  std::vector<const record::Logged<record::GroundTruth>*> truths;  ///< in file order

  double acceleration_m_s2() const {
    constexpr double kMost = 500.0;  // if it is unknown: no multirotor reaches it
    return info->max_acceleration_m_s2 > 0.0 ? info->max_acceleration_m_s2 : kMost;
  }
  /// The first one at `at` or later; null: there is none.
  const record::GroundTruth* at_or_after(SimTime at) const { return message(place(at)); }
  /// The last one before that.
  const record::GroundTruth* before(SimTime at) const {
    const std::size_t next = place(at);
    return next == 0 ? nullptr : message(next - 1);
  }

 private:
  std::size_t place(SimTime at) const {
    const auto found = std::ranges::lower_bound(
        truths, at, {}, [](const auto* truth) { return truth->message.at; });
    return static_cast<std::size_t>(found - truths.begin());
  }
  const record::GroundTruth* message(std::size_t i) const {
    return i < truths.size() ? &truths[i]->message : nullptr;
  }
};

/// By UAV. Messages of other UAVs are left out.
inline std::map<std::string, Track> tracks_of(const record::Record& record) {
  std::map<std::string, Track> tracks;
  for (const record::SutInfo& sut : record.header.suts) tracks[sut.uav].info = &sut;
  for (const auto& entry : record.ground_truth)
    if (const auto track = tracks.find(entry.message.uav); track != tracks.end())
      track->second.truths.push_back(&entry);
  return tracks;
}

inline double length(const double (&v)[3]) {
  return std::hypot(v[0], v[1], v[2]);
}
inline double distance(const double (&a)[3], const double (&b)[3]) {
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}
/// Whatever the record contains, not negative.
inline double seconds_between(SimTime from, SimTime to) {
  return to_seconds(Duration(static_cast<std::int64_t>(
      std::clamp<Wide>(wide(to) - wide(from), 0, wide(Duration::max())))));
}

}  // namespace tether::audit
