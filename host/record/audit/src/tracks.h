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

  /// The most between these instants. What it carries all the time slows it.
  double acceleration_m_s2(SimTime from, SimTime to) const {
    constexpr double kMost = 500.0;  // if it is unknown: no multirotor reaches it
    const double alone = info->max_acceleration_m_s2;
    if (!(alone > 0.0)) return kMost;
    if (!info->load || alone <= info->load->gravity_m_s2) return alone;
    double mass_kg = info->load->own_mass_kg;
    for (const record::PayloadInfo& payload : info->load->payloads)
      if (payload.from <= from && to <= payload.until) mass_kg += payload.mass_kg;
    const double gravity_m_s2 = info->load->gravity_m_s2;
    return (alone - gravity_m_s2) * info->load->own_mass_kg / mass_kg + gravity_m_s2;
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
