// Contacts against the ground truth around them.

#include "checks.h"
#include "tracks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

namespace tether::audit {
namespace {

using record::Contact;
using record::GroundTruth;
using Touch = record::Logged<Contact>;

// A UAV that is farther away before, and touches at the next message, hits something: soon, because
// the engine finds contacts with a tolerance.
constexpr double kAway_m = 1e-3;
constexpr Wide kSoon = 100'000'000;  // ns
constexpr double kTolerance_m_s = 0.1;

// The greatest speed of a point of the UAV around that instant; none if it is not known.
std::optional<double> most_m_s(const Track& track, SimTime at) {
  const GroundTruth* after = track.at_or_after(at);
  const GroundTruth* before = track.before(at);
  if (before == nullptr) before = after;
  if (after == nullptr || !(track.info->extent_m > 0.0)) return std::nullopt;
  const double time_s = seconds_between(before->at, after->at);
  const double linear_m_s = std::max(length(before->v_WB_m_s), length(after->v_WB_m_s)) +
                            track.acceleration_m_s2(before->at, after->at) * time_s;
  const double turning_rad_s = std::max(length(before->w_WB_B_rad_s), length(after->w_WB_B_rad_s)) +
                               track.info->max_angular_acceleration_rad_s2 * time_s;
  return kMargin * (linear_m_s + track.info->extent_m * turning_rad_s) + kTolerance_m_s;
}

class ContactCheck {
 public:
  ContactCheck(const record::Record& record, Report& report)
      : record_(record), report_(report), tracks_(tracks_of(record)) {}

  void run() {
    for (const Touch& entry : record_.contacts) {
      const auto track = tracks_.find(entry.message.uav);
      if (track == tracks_.end()) continue;  // check_consistency reports it
      check_log_time(entry, track->second);
      check_speed(entry, track->second);
    }
    if (!record_.header.reports_contacts) return;
    for (const auto& [uav, track] : tracks_) check_touches(uav, track);
  }

 private:
  // A contact is written with the next ground truth, or at the end of the run.
  void check_log_time(const Touch& entry, const Track& track) {
    const GroundTruth* before = track.before(entry.at);
    if (before != nullptr && entry.message.at < before->at)
      report_.add(0, entry, "contact at {} is not recorded with the ground truth at {}",
                  ns(entry.message.at), ns(before->at));
  }

  void check_speed(const Touch& entry, const Track& track) {
    if (!record_.header.moves_by_forces) return;
    const auto most = most_m_s(track, entry.message.at);
    const auto other = tracks_.find(entry.message.with);
    if (other == tracks_.end() && !record_.header.only_uavs_move) return;
    const auto others = other == tracks_.end() ? 0.0 : most_m_s(other->second, entry.message.at);
    if (most && others && entry.message.speed_m_s > *most + *others)
      report_.add(0, entry, "contact at {:.6g} m/s, but both together have at most {:.6g} m/s",
                  entry.message.speed_m_s, *most + *others);
  }

  void check_touches(const std::string& uav, const Track& track) {
    for (std::size_t i = 1; i < track.truths.size(); ++i) {
      const GroundTruth &last = track.truths[i - 1]->message, &next = track.truths[i]->message;
      if (!(last.clearance_m > kAway_m) || !(next.clearance_m <= 0.0)) continue;
      if (!record_.footer || wide(next.at) + kSoon > wide(record_.footer->st_at_end)) continue;
      const bool is_known = std::ranges::any_of(record_.contacts, [&](const Touch& entry) {
        return (entry.message.uav == uav || entry.message.with == uav) &&
               wide(entry.message.at) <= wide(next.at) + kSoon;
      });
      if (!is_known)
        return report_.add(0, *track.truths[i], "the UAV touches something, without a contact");
    }
  }

  const record::Record& record_;
  Report& report_;
  std::map<std::string, Track> tracks_;
};

}  // namespace

void check_contacts(const record::Record& record, Report& report) {
  ContactCheck(record, report).run();
}

}  // namespace tether::audit
