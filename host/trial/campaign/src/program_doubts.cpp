#include "program_doubts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace tether::campaign {
namespace {

/// What a flight controller said, and when.
struct Text {
  SimTime at;
  std::string text;
};

/// What the flight controller of a UAV refused or warned of. Long texts are sent in pieces.
std::vector<Text> complaints_of(const record::Record& record, const std::string& uav) {
  constexpr int kWarning = 4;  // MAV_SEVERITY_WARNING; less is worse (mavlink.io, "common")
  std::vector<Text> complaints;
  for (const auto& logged : record.autopilot) {
    const record::AutopilotMessage& m = logged.message;
    if (m.uav != uav || !m.of_controller() || m.name != "STATUSTEXT") continue;
    const auto fields = nlohmann::json::parse(m.fields, nullptr, false);
    if (!fields.is_object() || fields.value("severity", kWarning + 1) > kWarning) continue;
    if (fields.value("chunk_seq", 0) == 0 || complaints.empty())
      complaints.push_back({m.sent_at, ""});
    complaints.back().text += fields.value("text", "");
  }
  return complaints;
}

/// The last one that goes with what it did at that time, with a colon before it; empty: none.
std::string why_at(const std::vector<Text>& complaints, SimTime at) {
  constexpr Duration kTogether = std::chrono::milliseconds(500);
  std::string why;
  for (const Text& complaint : complaints)
    if (std::chrono::abs(complaint.at - at) <= kTogether) why = ": " + complaint.text;
  return why;
}

/// Whether that is OFFBOARD of PX4, or GUIDED (also without GPS) of ArduPilot's copters.
bool follows_setpoints(int autopilot, int custom_mode) {
  constexpr int kArduPilot = 3, kGuided = 4, kGuidedNoGps = 20;  // MAV_AUTOPILOT, COPTER_MODE
  constexpr int kMainMode = 16, kOffboard = 6;                   // bits of PX4's custom_mode
  if (autopilot == kArduPilot) return custom_mode == kGuided || custom_mode == kGuidedNoGps;
  return (custom_mode >> kMainMode & 0xFF) == kOffboard;
}

/// What its flight controller says of a UAV, as far as it can make a good end doubtful.
struct Said {
  struct Answer {
    int result = 0;
    SimTime at;
  };
  std::map<int, Answer> answers;  ///< the last one to each command (MAV_RESULT)
  Answer mission;                 ///< the last one to a mission (MAV_MISSION_RESULT)
  bool follows = false;           ///< it was in a mode in which it flies set-points
  std::optional<SimTime> failsafe_at{};
  bool is_armed = true;  ///< as far as it says
};
Said said_of(const record::Record& record, const std::string& uav) {
  constexpr int kCritical = 5, kArmed = 128, kNoAutopilot = 8;  // MAV_STATE, _MODE_FLAG, _AUTOPILOT
  Said said;
  for (const auto& logged : record.autopilot) {
    const record::AutopilotMessage& m = logged.message;
    if (m.uav != uav || !m.tells_state()) continue;
    const auto fields = nlohmann::json::parse(m.fields, nullptr, false);
    if (!fields.is_object()) continue;
    if (m.name == "COMMAND_ACK")
      said.answers[fields.value("command", 0)] = {fields.value("result", 0), m.sent_at};
    if (m.name == "MISSION_ACK") said.mission = {fields.value("type", 0), m.sent_at};
    if (m.name != "HEARTBEAT" || fields.value("autopilot", 0) == kNoAutopilot) continue;
    said.follows |= follows_setpoints(fields.value("autopilot", 0), fields.value("custom_mode", 0));
    said.is_armed = (fields.value("base_mode", 0) & kArmed) != 0;
    if (fields.value("system_status", 0) >= kCritical && !said.failsafe_at)
      said.failsafe_at = m.sent_at;
  }
  return said;
}

/// The command whose last answer was no; none: there is none. Requests for messages change nothing
/// of the flight.
std::optional<int> denied_command(const Said& said) {
  constexpr int kAccepted = 0, kInProgress = 5;                     // MAV_RESULT
  constexpr int kRequests[] = {410, 510, 511, 512, 519, 520, 521};  // MAV_CMD
  for (const auto& [command, answer] : said.answers)
    if (answer.result != kAccepted && answer.result != kInProgress &&
        std::ranges::find(kRequests, command) == std::end(kRequests))
      return command;
  return std::nullopt;
}

std::string name_of_command(int command) {
  switch (command) {
    case 22:
      return "a take-off";
    case 176:
      return "a mode";
    case 300:
      return "the start of a mission";
    case 400:
      return "arming or disarming";
    default:
      return fmt::format("command {} (MAV_CMD)", command);
  }
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

/// Each report of the client library, with the UAV of its program.
void for_each_report(const record::Record& record,
                     const std::function<void(const std::string&, const nlohmann::json&)>& take) {
  for (const auto& logged : record.annotations) {
    if (logged.message.topic != uav::kClientReport) continue;
    const auto told = nlohmann::json::parse(logged.message.json, nullptr, false);
    if (told.is_object()) take(logged.message.uav, told);
  }
}

/// Of a program that says that it reached its goal: what became of the commands of its own.
void check_commands(const record::Record& record, const Motion& motion, const std::string& uav,
                    std::vector<Warning>& warnings) {
  for_each_report(record, [&](const std::string& of, const nlohmann::json& told) {
    if (of != uav) return;
    if (const std::size_t refused = told.value("refused_commands", 0U); refused > 0)
      warnings.push_back(doubt_about(
          uav, fmt::format("was not given {} of its program, which Tether's library refused",
                           counted(refused, "command"))));
    if (const double uncharged_ms = told.value("uncharged_ms", 0.0); uncharged_ms > 0.0)
      warnings.push_back(doubt_about(
          uav,
          fmt::format("has a program whose other threads computed {:.3g} s during calls, which the "
                      "clock \"cpu\" does not charge",
                      uncharged_ms * 1e-3)));
  });
  const auto is_own = [&](const auto& logged) { return logged.message.uav == uav; };
  const auto moves = [&](const auto& logged) {
    const record::CommandEffect& m = logged.message;
    return is_own(logged) && (m.setpoint || m.vx_H_m_s != 0.0 || m.vy_H_m_s != 0.0 ||
                              m.vz_H_m_s != 0.0 || m.yaw_rate_rad_s != 0.0);
  };
  if (motion.first != nullptr && !motion.has_moved && !motion.has_turned &&
      std::ranges::any_of(record.commands, is_own) && std::ranges::none_of(record.commands, moves))
    warnings.push_back(doubt_about(
        uav,
        "never left its start, and was commanded nothing but to stay: a slow computer can do "
        "that, too"));
}

/// As check_program, of a program with a flight controller.
void check_companion(const record::Record& record, const Motion& motion, bool nothing,
                     SutResult& sut, std::vector<Warning>& warnings) {
  const auto is_sent = [&](const auto& logged) {
    const record::AutopilotMessage& m = logged.message;
    return m.uav == sut.uav && m.to_controller && m.outcome == record::kDelivered &&
           !m.name.empty();
  };
  const auto doubt = [&](const std::string& what) {
    warnings.push_back(doubt_about(sut.uav, what));
  };
  std::size_t unsigned_ones = 0, ignored = 0, setpoints = 0, sent = 0, lost = 0;
  for (const auto& logged : record.autopilot) {
    const record::AutopilotMessage& m = logged.message;
    if (m.uav != sut.uav) continue;
    unsigned_ones += m.part == 0 && m.is_unsigned() ? 1U : 0U;
    ignored += m.part == 0 && m.outcome == record::kIgnored ? 1U : 0U;
    sent += m.part == 0 && !m.of_station ? 1U : 0U;
    lost += m.part == 0 && m.outcome == record::kQueueFull ? 1U : 0U;
    setpoints += m.is_setpoint() && m.outcome == record::kDelivered ? 1U : 0U;
  }
  if (unsigned_ones > 0)
    doubt(
        fmt::format("has a flight controller that refused {} of its program: not signed with the "
                    "key of 'signing_key_file', or sent again",
                    counted(unsigned_ones, "message")));
  if (ignored > 0)
    doubt(
        fmt::format("has a flight controller that ignored {} of its program: of a frame, a type "
                    "mask or values that it does not fly, or for another system",
                    counted(ignored, "set-point")));
  if (lost > 0)
    doubt(
        fmt::format("has a line to its flight controller that was full: {} of {} were lost. Give "
                    "it a faster 'link_baud', or ask for fewer messages",
                    lost, counted(sent, "message")));
  const bool has_sent = std::ranges::any_of(record.autopilot, is_sent);
  if (nothing) return doubt(kDidNothing);
  const std::vector<Text> complaints = complaints_of(record, sut.uav);
  if (!sut.reached_goal && !complaints.empty())
    sut.outcome += fmt::format("{}the flight controller said at ST {:.3f} s: {}",
                               sut.outcome.empty() ? "" : "; ", to_seconds(complaints.back().at),
                               complaints.back().text);
  const Said said = said_of(record, sut.uav);
  constexpr const char* kButLast = "has a program that says it reached its goal, but its last ";
  if (const auto command = denied_command(said); sut.reached_goal && command)
    doubt(fmt::format("{}request for {} was denied{}", kButLast, name_of_command(*command),
                      why_at(complaints, said.answers.at(*command).at)));
  if (sut.reached_goal && said.mission.result != 0)
    doubt(fmt::format("{}mission was refused{}", kButLast, why_at(complaints, said.mission.at)));
  if (sut.reached_goal && said.failsafe_at)
    doubt(fmt::format("has a flight controller that was in a failsafe at ST {:.3f} s{}",
                      to_seconds(*said.failsafe_at), why_at(complaints, *said.failsafe_at)));
  const auto& [first, last, has_moved, has_turned] = motion;
  if (constexpr std::size_t kFew = 5; setpoints > kFew && !said.follows)
    doubt(
        fmt::format("has a flight controller that flew none of the {} of its program: it was never "
                    "in OFFBOARD (PX4, built-in) or GUIDED (ArduPilot)",
                    counted(setpoints, "set-point")));
  if (!has_sent) return doubt("has a flight controller to which its program sent no message");
  const bool began_in_air = first != nullptr && first->clearance_m && *first->clearance_m > kAway_m;
  if (!has_moved && !(began_in_air && has_turned))
    doubt(sut.reached_goal
              ? "never left its start, although its program says that it reached its goal"
              : "never left its start");
  if (sut.reached_goal && (!began_in_air || !said.is_armed) && last != nullptr &&
      last->clearance_m && *last->clearance_m > kAway_m)
    doubt(
        fmt::format("is in the air ({:.3g} m from anything) when its program ends: what follows "
                    "was not flown",
                    *last->clearance_m));
}

/// What the library inside a program as it is has found.
void take_doubts(const record::Record& record, const SutResult& sut,
                 std::vector<Warning>& warnings) {
  for (const auto& logged : record.annotations) {
    if (logged.message.uav != sut.uav || logged.message.topic != "as_is") continue;
    const auto found = nlohmann::json::parse(logged.message.json, nullptr, false);
    if (found.is_object() && found.contains("doubt") && found["doubt"].is_string())
      warnings.push_back(
          {Consequence::kDoubtful, {}, "UAV '" + sut.uav + "'", found["doubt"].get<std::string>()});
  }
}

}  // namespace

Warning doubt_about(const std::string& uav, const std::string& what) {
  return {Consequence::kDoubtful, {}, "UAV '" + uav + "'", what};
}

std::string check_program(const record::Record& record, const record::SutInfo& info, SutResult& sut,
                          std::vector<Warning>& warnings) {
  take_doubts(record, sut, warnings);
  const Motion motion = motion_of(record, info.uav);
  if (constexpr double kFalls_m_s = 2.0;
      sut.reached_goal && motion.last != nullptr && motion.last->clearance_m &&
      *motion.last->clearance_m > kAway_m && motion.last->v_WB_m_s[2] < -kFalls_m_s)
    warnings.push_back(doubt_about(
        info.uav, fmt::format("sinks at {:.3g} m/s, {:.3g} m from anything, when its program ends",
                              -motion.last->v_WB_m_s[2], *motion.last->clearance_m)));
  if (sut.reached_goal) check_commands(record, motion, info.uav, warnings);
  constexpr std::ptrdiff_t kHardlyAny = 5;
  const std::ptrdiff_t calls = calls_of(record, info);
  const bool nothing = calls == 0;
  if (info.controller)
    check_companion(record, motion, nothing, sut, warnings);
  else if (!nothing && calls < kHardlyAny && sut.finished && sut.reached_goal)
    if (motion.first != nullptr && !motion.has_moved && !motion.has_turned)
      warnings.push_back(doubt_about(
          info.uav,
          fmt::format("never left its start, and has a program that did hardly anything with it: "
                      "{} call{}",
                      calls, calls > 1 ? "s" : "")));
  if (!nothing) return "";
  const bool is_alone = record.header.suts.size() == 1;
  // One with Tether's library says itself that it has flown; and a program beside others can be
  // there as a load.
  if (!info.controller && (!info.as_is || !is_alone)) {
    if (sut.finished && sut.reached_goal) warnings.push_back(doubt_about(info.uav, kDidNothing));
    return "";
  }
  if (!sut.finished) return "";
  return fmt::format("the program of UAV '{}' ended before it sent anything or read a sensor{}{}",
                     sut.uav, sut.outcome.empty() ? "" : ": ", sut.outcome);
}

std::string unclear_times(const record::Record& record) {
  std::string why;
  for_each_report(record, [&](const std::string& uav, const nlohmann::json& told) {
    if (const double hz = told.value("clock_read_hz", 0.0); hz > 0.0)
      why = fmt::format(
          "the program of UAV '{}' reads its clock every {:.2g} µs: it probably waits in a loop, "
          "which counts as computing, and which a faster computer does not shorten",
          uav, 1e6 / hz);
    else if (const double others_ms = told.value("others_ms", 0.0); others_ms > 0.0)
      why = fmt::format(
          "of what the program of UAV '{}' is charged, {:.3g} s are of threads other than the one "
          "that calls Tether: if that one only waits meanwhile, a faster computer does not shorten "
          "it",
          uav, others_ms * 1e-3);
  });
  return why;
}

std::string where_to_find(const record::Record& record) {
  const auto& suts = record.header.suts;
  const auto lost = std::ranges::find_if(
      suts, [&](const record::SutInfo& sut) { return sut.as_is && calls_of(record, sut) == 0; });
  if (lost == suts.end()) return "";
  const auto cameras =
      std::ranges::count_if(record.header.sensors, [&](const record::SensorInfo& sensor) {
        return sensor.uav == lost->uav && sensor.kind == "camera";
      });
  std::vector<std::string> places;
  if (lost->controller)
    places.emplace_back("MAVLink at UDP port 14540 or 14550, TCP port 5760 or /dev/ttyACM0");
  if (cameras > 0)
    places.push_back(cameras == 1 ? "its camera at /dev/video0"
                                  : fmt::format("its cameras at /dev/video0 to {}", cameras - 1));
  return places.empty() ? ""
                        : fmt::format(". A program finds {} (docs/guide/as-is.md)",
                                      fmt::join(places, ", and "));
}

}  // namespace tether::campaign
