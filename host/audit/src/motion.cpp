#include "checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace tether::audit {
namespace {

using record::GroundTruth;
using record::Logged;

// A SUT's command of more than this is rejected.
constexpr double kMostCommand = 100.0;  // m/s and rad/s

// If the record does not have the UAV's: no multirotor reaches it.
constexpr double kMostAcceleration_m_s2 = 500.0;
// By how much something that hits the UAV can raise its speed between two messages.
constexpr double kMostHit_m_s = 20.0;
constexpr double kMargin = 1.5;
constexpr double kTolerance_m = 0.01;  // contacts push bodies apart
// And at the start, where a UAV can have been placed inside something.
constexpr Duration kPush = std::chrono::milliseconds(100);
constexpr double kMostPush_m = 0.5;

double length(const double (&v)[3]) {
  return std::hypot(v[0], v[1], v[2]);
}

double distance_m(const GroundTruth& a, const GroundTruth& b) {
  return std::hypot(b.p_WB_m[0] - a.p_WB_m[0], b.p_WB_m[1] - a.p_WB_m[1],
                    b.p_WB_m[2] - a.p_WB_m[2]);
}

// How far the UAV can be from its last position: at the greater of both speeds, of which the later
// one is believed only as far as a hit explains it, and with all of its acceleration.
double reach_m(const GroundTruth& last, const GroundTruth& next, double acceleration_m_s2) {
  const double time_s = to_seconds(Duration(static_cast<std::int64_t>(
      std::clamp<Wide>(wide(next.at) - wide(last.at), 0, wide(Duration::max())))));
  const double before_m_s = length(last.v_WB_m_s);
  const double speed_m_s =
      std::max(before_m_s, std::min(length(next.v_WB_m_s), before_m_s + kMostHit_m_s)) +
      acceleration_m_s2 * time_s;
  return kMargin * speed_m_s * time_s + kTolerance_m;
}

void check_flight(const record::Record& record, Report& report) {
  std::map<std::string, double> acceleration_m_s2;
  for (const record::SutInfo& sut : record.header.suts)
    acceleration_m_s2[sut.uav] =
        sut.max_acceleration_m_s2 > 0.0 ? sut.max_acceleration_m_s2 : kMostAcceleration_m_s2;
  const auto starts =
      record.ground_truth.empty() ? SimTime{} : record.ground_truth.front().message.at;
  std::set<std::string> pushed;  // UAVs that start inside something: the simulator pushes them out
  for (const Logged<record::Contact>& entry : record.contacts)
    if (entry.message.at <= starts) pushed.insert(entry.message.uav);
  std::map<std::string, const GroundTruth*> last;
  for (const Logged<GroundTruth>& entry : record.ground_truth) {
    const GroundTruth& next = entry.message;
    const GroundTruth*& before = last[next.uav];
    if (before != nullptr && acceleration_m_s2.contains(next.uav)) {
      const double moved_m = distance_m(*before, next);
      const bool is_pushed = pushed.contains(next.uav) && next.at - starts <= kPush;
      const double most_m =
          reach_m(*before, next, acceleration_m_s2[next.uav]) + (is_pushed ? kMostPush_m : 0.0);
      if (moved_m > most_m)
        report.add(0, entry, "the UAV jumps {:.3f} m within {}, but can fly at most {:.3f} m",
                   moved_m, ns(wide(next.at) - wide(before->at)), most_m);
    }
    before = &next;
  }
}

}  // namespace

void check_motion(const record::Record& record, Report& report) {
  check_flight(record, report);
  for (const Logged<record::CommandEffect>& entry : record.commands) {
    const record::CommandEffect& m = entry.message;
    const double most = std::max({std::abs(m.vx_H_m_s), std::abs(m.vy_H_m_s), std::abs(m.vz_H_m_s),
                                  std::abs(m.yaw_rate_rad_s)});
    if (most > kMostCommand && std::isfinite(most))
      report.add(0, entry, "command of {:.6g} m/s or rad/s, but at most {:.6g} can be given", most,
                 kMostCommand);
  }
}

}  // namespace tether::audit
