#include "program_doubts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tether::campaign {
namespace {

/// The last thing that the flight controller of a UAV refused or warned of; empty: nothing. Long
/// texts are sent in pieces.
std::string refusal_of(const record::Record& record, const std::string& uav) {
  constexpr int kWarning = 4;  // MAV_SEVERITY_WARNING; less is worse (mavlink.io, "common")
  std::string refusal;
  for (const auto& logged : record.autopilot) {
    const record::AutopilotMessage& m = logged.message;
    if (m.uav != uav || !m.of_controller() || m.name != "STATUSTEXT") continue;
    const auto fields = nlohmann::json::parse(m.fields, nullptr, false);
    if (!fields.is_object() || fields.value("severity", kWarning + 1) > kWarning) continue;
    if (fields.value("chunk_seq", 0) == 0) refusal.clear();
    refusal += fields.value("text", "");
  }
  return refusal;
}

/// Whether the last answer to a request for a mode or a take-off was no.
bool is_denied(const record::Record& record, const std::string& uav) {
  constexpr int kAccepted = 0, kInProgress = 5;  // MAV_RESULT
  constexpr int kTakeOff = 22, kSetMode = 176;   // MAV_CMD
  std::map<int, int> answers;
  for (const auto& logged : record.autopilot) {
    const record::AutopilotMessage& m = logged.message;
    if (m.uav != uav || !m.of_controller() || m.name != "COMMAND_ACK") continue;
    const auto fields = nlohmann::json::parse(m.fields, nullptr, false);
    if (fields.is_object()) answers[fields.value("command", 0)] = fields.value("result", kAccepted);
  }
  return std::ranges::any_of(answers, [&](const auto& answer) {
    return (answer.first == kTakeOff || answer.first == kSetMode) && answer.second != kAccepted &&
           answer.second != kInProgress;
  });
}

constexpr const char* kDidNothing =
    "has a program that did nothing with it: no sensor was read, and nothing sent";

/// How many times a program read or sent something. One with a flight controller also receives
/// whenever it waits, whether it listens or not.
std::ptrdiff_t calls_of(const record::Record& record, const record::SutInfo& sut) {
  const auto is_sent = [&](const auto& logged) {
    return logged.message.uav == sut.uav && logged.message.to_controller;
  };
  const auto is_call = [&](const auto& logged) {
    const std::string& kind = logged.message.kind;
    return logged.message.uav == sut.uav && kind != record::kFinish && kind != record::kSleep &&
           !(kind == record::kReceive && sut.controller);
  };
  return std::ranges::count_if(record.autopilot, is_sent) +
         std::ranges::count_if(record.interactions, is_call);
}

constexpr double kAway_m = 0.2;
struct Motion {
  const record::GroundTruth *first = nullptr, *last = nullptr;
  bool has_moved = false, has_turned = false;
};
Motion motion_of(const record::Record& record, const std::string& uav) {
  constexpr double kHardlyTurned = 0.99966;  // cosine of 1.5 degrees, half the angle
  Motion motion;
  for (const auto& logged : record.ground_truth) {
    if (logged.message.uav != uav) continue;
    motion.last = &logged.message;
    if (motion.first == nullptr) motion.first = motion.last;
    const record::GroundTruth &first = *motion.first, &last = *motion.last;
    double square_m2 = 0.0;
    for (std::size_t i = 0; i < 3; ++i) square_m2 += std::pow(last.p_WB_m[i] - first.p_WB_m[i], 2);
    motion.has_moved |= square_m2 > kAway_m * kAway_m;
    const double cosine = std::inner_product(std::begin(last.q_WB), std::end(last.q_WB),
                                             std::begin(first.q_WB), 0.0);  // of half the angle
    motion.has_turned |= std::abs(cosine) < kHardlyTurned;
  }
  return motion;
}

/// As check_program, of a program with a flight controller.
void check_companion(const record::Record& record, bool nothing, SutResult& sut,
                     std::vector<Warning>& warnings) {
  const auto is_sent = [&](const auto& logged) {
    const record::AutopilotMessage& m = logged.message;
    return m.uav == sut.uav && m.to_controller && m.outcome == record::kDelivered &&
           !m.name.empty();
  };
  const auto doubt = [&](const std::string& what) {
    warnings.push_back({Consequence::kDoubtful, {}, "UAV '" + sut.uav + "'", what});
  };
  if (const auto refused = std::ranges::count_if(record.autopilot, [&](const auto& logged) {
        return logged.message.uav == sut.uav && logged.message.part == 0 &&
               logged.message.is_refused();
      }))
    doubt(
        fmt::format("has a flight controller that refused {} message{} of its program: "
                    "not signed with the key of 'signing_key_file', or sent again",
                    refused, refused > 1 ? "s" : ""));
  const bool has_sent = std::ranges::any_of(record.autopilot, is_sent);
  if (nothing) return doubt(kDidNothing);
  const std::string said = sut.reached_goal ? "" : refusal_of(record, sut.uav);
  if (!said.empty())
    sut.outcome +=
        fmt::format("{}the flight controller said: {}", sut.outcome.empty() ? "" : "; ", said);
  if (sut.reached_goal && is_denied(record, sut.uav))
    doubt(
        "has a program that says it reached its goal, but its last request for a mode or a "
        "take-off was denied: " +
        refusal_of(record, sut.uav));
  const auto [first, last, has_moved, has_turned] = motion_of(record, sut.uav);
  if (!has_sent) return doubt("has a flight controller to which its program sent no message");
  const bool began_in_air = first != nullptr && first->clearance_m && *first->clearance_m > kAway_m;
  if (!has_moved && !(began_in_air && has_turned))
    doubt(sut.reached_goal
              ? "never left its start, although its program says that it reached its goal"
              : "never left its start");
  if (sut.reached_goal && !began_in_air && last != nullptr && last->clearance_m &&
      *last->clearance_m > kAway_m)
    doubt(
        fmt::format("is in the air ({:.3g} m from anything) when its program ends: what follows "
                    "was not flown",
                    *last->clearance_m));
}

}  // namespace

std::string check_program(const record::Record& record, const record::SutInfo& info, SutResult& sut,
                          std::vector<Warning>& warnings) {
  constexpr std::ptrdiff_t kHardlyAny = 5;
  const std::ptrdiff_t calls = calls_of(record, info);
  const bool nothing = calls == 0;
  if (info.controller)
    check_companion(record, nothing, sut, warnings);
  else if (!nothing && calls < kHardlyAny && sut.finished && sut.reached_goal)
    if (const Motion motion = motion_of(record, info.uav);
        motion.first != nullptr && !motion.has_moved && !motion.has_turned)
      warnings.push_back(
          {Consequence::kDoubtful,
           {},
           "UAV '" + info.uav + "'",
           fmt::format("never left its start, and has a program that did hardly anything with it: "
                       "{} call{}",
                       calls, calls > 1 ? "s" : "")});
  if (!nothing) return "";
  const bool is_alone = record.header.suts.size() == 1;
  // One with Tether's library says itself that it has flown; and a program beside others can be
  // there as a load.
  if (!info.controller && (!info.as_is || !is_alone)) {
    if (sut.finished && sut.reached_goal)
      warnings.push_back({Consequence::kDoubtful, {}, "UAV '" + info.uav + "'", kDidNothing});
    return "";
  }
  if (!sut.finished) return "";
  return fmt::format("the program of UAV '{}' ended before it did anything with it{}{}", sut.uav,
                     sut.outcome.empty() ? "" : ": ", sut.outcome);
}

}  // namespace tether::campaign
