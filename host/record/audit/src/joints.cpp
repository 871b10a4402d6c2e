#include "checks.h"
#include "tracks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace tether::audit {
namespace {

using record::CommandEffect;
using record::Logged;

constexpr std::uint64_t kJoints = 512;
constexpr double kRounding_rad = 1e-6;

// One joint of a UAV between two messages of its ground truth.
class Turn {
 public:
  Turn(const Track& track, std::size_t joint) : info_(track.info->joints[joint]), joint_(joint) {}

  void start(SimTime at) {
    angle_rad_ = target_rad_ =
        std::clamp(0.0, info_.min_rad, std::max(info_.min_rad, info_.max_rad));
    at_ = at;
  }
  void turn(SimTime to) {
    const double most_rad = info_.max_rate_rad_s * seconds_between(at_, to);
    angle_rad_ += std::clamp(target_rad_ - angle_rad_, -most_rad, most_rad);
    at_ = to;
  }
  void take(const CommandEffect& effect) {
    turn(effect.applied_at);
    if (joint_ < effect.setpoint->joints_rad.size())
      target_rad_ = effect.setpoint->joints_rad[joint_];
  }
  // By a flight controller, whose commands are not in the record: within its limits and its rate.
  void check_rate(const Logged<record::GroundTruth>& truth, Report& report) {
    const double is_rad = truth.message.joints_rad[joint_];
    const double most_rad = info_.max_rate_rad_s * seconds_between(at_, truth.message.at);
    if (!(std::abs(is_rad - angle_rad_) <= most_rad + kRounding_rad) ||
        is_rad < info_.min_rad - kRounding_rad ||
        is_rad > std::max(info_.min_rad, info_.max_rad) + kRounding_rad)
      report.add(0, truth,
                 "joint \"{}\" goes from {:.9g} rad to {:.9g} rad: beyond its rate or limits",
                 info_.name, angle_rad_, is_rad);
    if (std::isfinite(is_rad)) angle_rad_ = is_rad;
    at_ = truth.message.at;
  }
  // Goes on from what the message has, so that one finding is not the next one, too.
  void check(const Logged<record::GroundTruth>& truth, Report& report) {
    const double is_rad = truth.message.joints_rad[joint_];
    if (!(std::abs(is_rad - angle_rad_) <= kRounding_rad))
      report.add(0, truth, "joint \"{}\" is at {:.9g} rad, but it was commanded to {:.9g} rad",
                 info_.name, is_rad, angle_rad_);
    if (std::isfinite(is_rad)) angle_rad_ = is_rad;
  }

 private:
  const record::JointInfo& info_;
  std::size_t joint_;
  double angle_rad_ = 0.0, target_rad_ = 0.0;
  SimTime at_{};
};

void check_track(const Track& track, const std::vector<const CommandEffect*>& effects,
                 Report& report) {
  std::vector<Turn> turns;
  for (std::size_t i = 0; i < track.info->joints.size(); ++i) turns.emplace_back(track, i);
  for (Turn& turn : turns) turn.start(SimTime{});
  auto next = effects.begin();
  for (const auto* truth : track.truths) {
    if (truth->message.joints_rad.size() != turns.size()) {
      report.add(0, *truth, "{} angles of {} joints", truth->message.joints_rad.size(),
                 turns.size());
      return;
    }
    // At the instant of the message, a command has not turned anything yet.
    for (; next != effects.end() && (*next)->applied_at < truth->message.at; ++next)
      for (Turn& turn : turns) turn.take(**next);
    for (Turn& turn : turns) {
      if (track.info->controller) {
        turn.check_rate(*truth, report);
        continue;
      }
      turn.turn(truth->message.at);
      turn.check(*truth, report);
    }
  }
}

}  // namespace

void check_joints(const record::Record& record, Report& report) {
  std::map<std::string, std::vector<const CommandEffect*>> effects;
  for (const Logged<CommandEffect>& entry : record.commands)
    if (entry.message.setpoint && (entry.message.setpoint->mask & kJoints) != 0)
      effects[entry.message.uav].push_back(&entry.message);
  for (const auto& [uav, track] : tracks_of(record)) check_track(track, effects[uav], report);
}

}  // namespace tether::audit
