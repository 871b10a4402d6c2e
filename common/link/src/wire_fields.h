#pragma once

#include "json_text.h"

#include <string>
#include <vector>

#include <tether/link/codec.h>
#include <tether/link/messages.h>
#include <tether/uav/fields.h>
#include <tether/wire/fields.h>

/// The fields of each message: tether/wire/fields.h. The schema `schema/link.fbs` has the same.
namespace tether::link {

using wire::AtMost;
using wire::Default;
using wire::Is;
using wire::OmitEmpty;
using wire::Rule;

/// A JSON object of a SUT.
inline constexpr Rule kJsonObject{
    [](const std::string& text) { return complaint_about_json(text).empty(); },
    complaint_about_json};

void fields(auto& io, Is<BuildPart> auto& m) {
  io.here("Hello.build: ");
  io("name", m.name, AtMost{kMaxNameBytes});
  io("value", m.value, AtMost{kMaxNameBytes});
}

void fields(auto& io, Is<Hello> auto& m) {
  const Rule rate{[](double factor) {
                    return factor >= computer::kLeastRate && factor <= computer::kLargestRate;
                  },
                  "is not within 1e-6..1e6"};
  const Rule digits{[](const std::string& id) {
                      return id.find_first_not_of("0123456789abcdef") == std::string::npos;
                    },
                    "is not a number in lower-case hexadecimal digits"};
  constexpr auto kLast = static_cast<computer::ClockKind>(computer::kClockKinds - 1);
  io.here("Hello: ");
  io("protocol_version", m.protocol_version);
  io("sut", m.sut, AtMost{kMaxNameBytes});
  io("uav", m.uav, AtMost{kMaxNameBytes});
  io("clock", m.clock.kind, wire::known_up_to(kLast));
  io("cpu_factor", m.clock.factor, Default{1.0}, rate);
  io("token", m.token, AtMost{kMaxNameBytes});
  io("concurrent", m.concurrent);
  io("computing_ns", m.clock.computing);
  io("build_id", m.build_id, OmitEmpty{}, AtMost{kMaxBuildIdBytes}, digits);
  io("process", m.process);
  io("build", m.build, OmitEmpty{}, AtMost{kMaxBuildParts, "has too many parts"});
}

void fields(auto& io, Is<StageTime> auto& m) {
  io("stage", m.stage, AtMost{kMaxNameBytes});
  io("computing_ns", m.computing);
}
/// Of the field `name`, which is a list of stages.
void stage_fields(auto& io, const char* name, auto& stages) {
  const Rule named{[](const std::vector<StageTime>& times) {
                     for (const StageTime& time : times)
                       if (time.stage.empty()) return false;
                     return true;
                   },
                   "has a stage without a name"};
  io(name, stages, OmitEmpty{}, AtMost{kMaxStages, "has too many stages"}, named,
     wire::unique_by(&StageTime::stage, "has a stage twice"));
}

void fields(auto& io, Is<Welcome> auto& m) {
  io.here("Welcome: ");
  io("catalogue", m.catalogue);
  io("free_running", m.free_running);
  io("start_et_ns", m.start);
  stage_fields(io, "computing", m.computing);
  io("peers", m.peers, OmitEmpty{}, AtMost{kMaxCatalogueEntries}, wire::EachAtMost{kMaxNameBytes});
  io("real_time_factor", m.real_time_factor, Default{1.0},
     Rule{[](double factor) { return factor > 0.0 && factor <= kMaxRealTimeFactor; },
          "is out of range"});
}

void fields(auto& io, Is<Refusal> auto& m) {
  io.here("Refusal: ");
  io("reason", m.reason, wire::known_up_to(Refusal::Reason::kRunEnded));
  io("message", m.message, AtMost{kMaxTextBytes});
}

// --- requests -----------------------------------------------------------------------------------

inline constexpr Rule kRadioBytes{
    [](const std::vector<std::uint8_t>& bytes) { return bytes.size() <= kMaxRadioBytes; },
    [](const std::vector<std::uint8_t>& bytes) {
      return "has " + std::to_string(bytes.size()) + " bytes; at most " +
             std::to_string(kMaxRadioBytes) + " are allowed";
    }};

void fields(auto& io, Is<ReadSensor> auto& m) {
  io("sensor", m.sensor,
     Rule{[](std::uint32_t index) { return index < kMaxCatalogueEntries; },
          "is larger than any catalogue"});
  io("latest", m.latest);
  io("only_if_available", m.only_if_available);
  io("queue", m.queue, Default{1u},
     Rule{[](std::uint32_t queue) { return queue >= 1 && queue <= kMaxQueue; },
          "is not within 1..4096"});
  io("skips", m.skips);
}
void fields(auto& io, Is<SetVelocity> auto& m) {
  io.require([&m] { return complaint_about(to_setpoint(m.command)).empty(); }, "velocity command",
             "is not finite, or above 100 m/s or 100 rad/s");
  io("velocity_h_m_s", m.command.velocity_H_m_s);
  io("yaw_rate_rad_s", m.command.yaw_rate_rad_s);
}
void fields(auto& io, Is<SetTrajectory> auto& m) {
  io("setpoints", m.setpoints, AtMost{uav::kMaxTrajectorySetpoints});
  io.require([&m] { return complaint_about(m.setpoints).empty(); }, "trajectory",
             [&m] { return "is invalid: " + complaint_about(m.setpoints); });
}
void fields(auto& io, Is<Sleep> auto& m) {
  io("until_et_ns", m.until);
  io("is_relative", m.is_relative);
}
void fields(auto& io, Is<Finish> auto& m) {
  io("reached_goal", m.reached_goal);
  io("outcome", m.outcome, AtMost{kMaxTextBytes});
  io("details", m.details, AtMost{kMaxJsonBytes},
     Rule{[](const std::string& text) { return text.empty() || kJsonObject.holds(text); },
          complaint_about_json});
}
void fields(auto& io, Is<SendMessage> auto& m) {
  io("to", m.to, OmitEmpty{}, AtMost{kMaxNameBytes});
  io("bytes", m.bytes, OmitEmpty{}, kRadioBytes);
}
void fields(auto& io, Is<ReceiveMessage> auto& m) {
  io("timeout_ns", m.timeout);
  io("sensors", m.sensors, OmitEmpty{}, AtMost{kMaxCatalogueEntries, "has too many sensors"});
  io("most", m.most, Default{1u},
     Rule{[](std::uint32_t most) { return most >= 1 && most <= kMaxReceived; },
          "is not within 1..64"});
}
void fields(auto&, Is<ReadBattery> auto&) {}

void fields(auto& io, Is<Request> auto& m) {
  io.here("Request: ");
  io("sequence", m.sequence, wire::kNotZero);
  io("issued_at_et_ns", m.issued_at);
  io("previous_round_trip_ns", m.previous_round_trip);
  io("body", m.body);
  stage_fields(io, "stages", m.stages);
}

// --- the others ---------------------------------------------------------------------------------

void fields(auto& io, Is<RadioMessage> auto& m) {
  io("from", m.from, AtMost{kMaxNameBytes});
  io("sent_at_st_ns", m.sent_at);
  io("arrived_at_st_ns", m.arrived_at);
  io("bytes", m.bytes, OmitEmpty{}, kRadioBytes);
  io.require([&m] { return m.sent_at <= m.arrived_at; }, "arrived_at_st_ns", "is before sent_at");
}

void fields(auto& io, Is<Reply> auto& m) {
  io.here("Reply: ");
  io("sequence", m.sequence, wire::kNotZero);
  io("resume_at_et_ns", m.resume_at);
  io("sample", m.sample);
  stage_fields(io, "computing", m.computing);
  io("message", m.message);
  io("battery", m.battery);
  io("more", m.more, OmitEmpty{}, AtMost{kMaxReceived - 1, "has too many messages"});
}

void fields(auto& io, Is<Progress> auto& m) {
  io.here("Progress: ");
  io("reached_et_ns", m.reached);
  io("stopped", m.stopped);
  io("received_bytes", m.received_bytes);
  io("dues_heard", m.dues_heard);
}

void fields(auto& io, Is<Due> auto& m) {
  io.here("Due: ");
  io("sequence", m.sequence, wire::kNotZero);
  io("reply_at_et_ns", m.reply_at);
}

void fields(auto& io, Is<Annotation> auto& m) {
  io.here("Annotation: ");
  io("at_et_ns", m.at);
  io("topic", m.topic, AtMost{kMaxNameBytes}, wire::kNotEmpty);
  io("json", m.json, AtMost{kMaxJsonBytes}, kJsonObject);
}

/// The root of a frame. The order of Message is that of the schema's union.
struct Envelope {
  Message content;
};
void fields(auto& io, Is<Envelope> auto& m) {
  io("content", m.content);
}

}  // namespace tether::link
