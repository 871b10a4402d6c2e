// The ground truth against itself. Poses, velocities and clearances are three accounts of one
// flight: what one of them says of the time between two messages bounds the others.

#include "checks.h"
#include "tracks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tether::audit {
namespace {

using record::GroundTruth;
using record::Logged;
using Truth = Logged<GroundTruth>;

// A SUT's command of more than this is rejected.
constexpr double kMostCommand = 100.0;  // m/s and rad/s

// By how much something that hits the UAV can raise its speed between two messages.
constexpr double kMostHit_m_s = 20.0;
constexpr double kTolerance_m = 0.01;  // contacts push bodies apart
// And at the start, where a UAV can have been placed inside something.
constexpr Duration kPush = std::chrono::milliseconds(100);
constexpr double kMostPush_m = 0.5;
// Larger than what the distance of two shapes is rounded by.
constexpr double kRounding_m = 1e-5;
constexpr double kDistanceError = 2e-6;  // of the engine's distances: 0.7 mm were seen at 817 m

// The angle from one attitude to the other, and its axis in the body, as one vector [rad].
std::array<double, 3> turn_rad(const GroundTruth& from, const GroundTruth& to) {
  const auto& [aw, ax, ay, az] = from.q_WB;
  const auto& [bw, bx, by, bz] = to.q_WB;
  const double w = aw * bw + ax * bx + ay * by + az * bz;
  const std::array axis = {aw * bx - ax * bw - ay * bz + az * by,
                           aw * by - ay * bw - az * bx + ax * bz,
                           aw * bz - az * bw - ax * by + ay * bx};
  const double sine = std::hypot(axis[0], axis[1], axis[2]);
  if (sine < 1e-12) return {};
  const double angle = 2.0 * std::atan2(sine, std::abs(w)) * (w < 0.0 ? -1.0 : 1.0) / sine;
  return {angle * axis[0], angle * axis[1], angle * axis[2]};
}

// How far a point of the UAV can have moved from one pose to the other.
double moved_m(const record::SutInfo& sut, const GroundTruth& from, const GroundTruth& to) {
  const auto turn = turn_rad(from, to);
  return distance(from.p_WB_m, to.p_WB_m) + sut.extent_m * std::hypot(turn[0], turn[1], turn[2]);
}

class MotionCheck {
 public:
  MotionCheck(const record::Record& record, Report& report)
      : record_(record),
        report_(report),
        step_s_(to_seconds(record.header.step)),
        tracks_(tracks_of(record)) {
    if (!record.ground_truth.empty()) starts_ = record.ground_truth.front().message.at;
    for (const Logged<record::Contact>& entry : record.contacts) {
      if (entry.message.at <= starts_) pushed_.insert(entry.message.uav);
      touched_.try_emplace(entry.message.uav, entry.message.at);
    }
    for (const auto& [uav, track] : tracks_) {
      knows_shapes_ &= track.info->extent_m > 0.0;
      if (fleet_.size() < track.truths.size()) fleet_.resize(track.truths.size());
      for (std::size_t i = 1; i < track.truths.size(); ++i) {
        const GroundTruth &last = track.truths[i - 1]->message, &next = track.truths[i]->message;
        Interval& all = fleet_[i];
        ++all.uavs;
        all.moved_m = std::max(all.moved_m, moved_m(*track.info, last, next));
        all.speed_m_s = std::max(all.speed_m_s, length(last.v_WB_m_s));
      }
    }
  }

  void run() {
    for (const auto& [uav, track] : tracks_) {
      for (std::size_t i = 1; i < track.truths.size(); ++i) {
        const Truth &last = *track.truths[i - 1], &next = *track.truths[i];
        check_jump(track, last.message, next);
        if (is_free(track, last.message, next.message, fleet_[i]))
          check_rates(track, last.message, next);
        check_clearance(track, i, next);
      }
    }
  }

 private:
  // Of all UAVs, the most between two messages.
  struct Interval {
    std::size_t uavs = 0;
    double moved_m = 0.0;
    double speed_m_s = 0.0;
  };

  // No UAV moves faster than it can fly: at the greater of both speeds, of which the later one is
  // believed only as far as a hit explains it, and with all of its acceleration.
  void check_jump(const Track& track, const GroundTruth& last, const Truth& next) {
    const bool is_pushed = pushed_.contains(last.uav) && next.message.at - starts_ <= kPush;
    const double moved = distance(last.p_WB_m, next.message.p_WB_m);
    const double most = reach_m(track, last, next.message) + (is_pushed ? kMostPush_m : 0.0);
    if (moved > most)
      report_.add(0, next, "the UAV jumps {:.3f} m within {}, but can fly at most {:.3f} m", moved,
                  ns(wide(next.message.at) - wide(last.at)), most);
  }

  static double reach_m(const Track& track, const GroundTruth& last, const GroundTruth& next) {
    const double time_s = seconds_between(last.at, next.at);
    const double before_m_s = length(last.v_WB_m_s);
    const double speed_m_s =
        std::max(before_m_s, std::min(length(next.v_WB_m_s), before_m_s + kMostHit_m_s)) +
        track.acceleration_m_s2(last.at, next.at) * time_s;
    return kMargin * speed_m_s * time_s + kTolerance_m;
  }

  // Whether nothing can have touched the UAV: then only its rotors, gravity and drag accelerate it.
  bool is_free(const Track& track, const GroundTruth& last, const GroundTruth& next,
               const Interval& all) const {
    if (!record_.header.moves_by_forces) return false;
    if (!last.clearance_m || !next.clearance_m) {
      const auto touched = touched_.find(last.uav);
      return record_.header.reports_contacts &&
             (touched == touched_.end() || touched->second > next.at);
    }
    double reach = reach_m(track, last, next) + moved_m(*track.info, last, next);
    const bool is_alone = tracks_.size() == 1 && record_.header.only_uavs_move;
    if (!is_alone) reach += (kMostHit_m_s + all.speed_m_s) * seconds_between(last.at, next.at);
    return std::min(*last.clearance_m, *next.clearance_m) > reach;
  }

  // Velocities change no faster than by the greatest acceleration, and are what moves the UAV: the
  // way between two messages is that of the mean velocity, up to what acceleration can do.
  void check_rates(const Track& track, const GroundTruth& last, const Truth& next) {
    const double dt_s = seconds_between(last.at, next.message.at);
    const auto check = [&](const char* what, const double(&before)[3], const double(&after)[3],
                           const std::array<double, 3>& way, double most_per_s, double tolerance) {
      std::array<double, 3> off{};
      for (std::size_t i = 0; i < 3; ++i) off[i] = way[i] - (before[i] + after[i]) / 2.0 * dt_s;
      const double error = std::hypot(off[0], off[1], off[2]);
      const double gained = distance(before, after);
      if (error > kMargin * most_per_s * dt_s * (dt_s / 4.0 + step_s_ / 2.0) + tolerance ||
          gained > kMargin * most_per_s * dt_s + tolerance)
        report_.add(0, next,
                    "{} changes by {:.6g} within {}, and the pose is {:.6g} away from where it "
                    "leads: beyond what the rotors can do",
                    what, gained, ns(wide(next.message.at) - wide(last.at)), error);
    };
    std::array<double, 3> way{};
    for (std::size_t i = 0; i < 3; ++i) way[i] = next.message.p_WB_m[i] - last.p_WB_m[i];
    check("the velocity", last.v_WB_m_s, next.message.v_WB_m_s, way,
          track.acceleration_m_s2(last.at, next.message.at), 1e-4);
    const double most_rad_s2 = track.info->max_angular_acceleration_rad_s2;
    const double turned_rad =
        std::max(length(last.w_WB_B_rad_s), length(next.message.w_WB_B_rad_s)) * dt_s;
    // Turns about several axes do not add up exactly. The engine's gyroscopic terms grow so, too.
    if (most_rad_s2 > 0.0)
      check("the rate of rotation", last.w_WB_B_rad_s, next.message.w_WB_B_rad_s,
            turn_rad(last, next.message), most_rad_s2, 1e-4 + turned_rad * turned_rad);
  }

  // No distance between two shapes changes by more than both have moved.
  void check_clearance(const Track& track, std::size_t i, const Truth& next) {
    const GroundTruth& last = track.truths[i - 1]->message;
    if (last.clearance_m.has_value() != next.message.clearance_m.has_value())
      return report_.add(0, next, "the clearance is in some messages only");
    if (!last.clearance_m || !knows_shapes_ || !record_.header.only_uavs_move) return;
    if (fleet_[i].uavs != tracks_.size()) return;
    const double most = moved_m(*track.info, last, next.message) +
                        (tracks_.size() > 1 ? fleet_[i].moved_m : 0.0) + kRounding_m +
                        kDistanceError * std::abs(*last.clearance_m);
    const double changed = std::abs(*next.message.clearance_m - *last.clearance_m);
    if (!(changed <= most))
      report_.add(0, next, "the clearance changes by {:.6g} m, but only {:.6g} m were flown",
                  changed, most);
  }

  const record::Record& record_;
  Report& report_;
  std::vector<Interval> fleet_;  // before each message of the ground truth
  double step_s_;
  std::map<std::string, Track> tracks_;
  bool knows_shapes_ = true;
  SimTime starts_{};
  std::set<std::string> pushed_;  // UAVs that start inside something: the simulator pushes them out
  std::map<std::string, SimTime> touched_;  // when each UAV began to touch something
};

}  // namespace

void check_motion(const record::Record& record, Report& report) {
  MotionCheck(record, report).run();
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
