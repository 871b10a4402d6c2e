#include "json_messages.h"

#include "damage.h"
#include "json_fields.h"
#include "json_text.h"

#include <tether/base/json_depth.h>

namespace tether::record {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

template <class Time>
void optional_time(JsonObject& object, std::string_view name, const std::optional<Time>& time) {
  if (time) {
    object.integer(name, to_ns(*time));
  }
}

// foxglove.Time, for log times from 0 on.
void timestamp(JsonObject& object, SimTime at) {
  JsonObject time = object.object("timestamp");
  time.integer("sec", to_ns(at) / kNsPerSecond);
  time.integer("nsec", to_ns(at) % kNsPerSecond);
  time.close();
}

SimTime timestamp_member(const Json& object) {
  const Json& time = member(object, "timestamp");
  const std::uint64_t seconds = unsigned_member(time, "sec");
  const std::uint64_t nanoseconds = unsigned_member(time, "nsec");
  if (seconds >= 9'000'000'000U || nanoseconds >= kNsPerSecond) {
    throw Damage("member \"timestamp\" is out of range");
  }
  return from_ns<SimTime>(static_cast<std::int64_t>(seconds) * kNsPerSecond +
                          static_cast<std::int64_t>(nanoseconds));
}

bool found_nothing(const Interaction& read) {
  return read.only_if_available && !read.sampled_at;
}

void append_sensor_fields(JsonObject& object, const Interaction& message) {
  if (message.kind == kSensor) {
    object.text("sensor", message.sensor);
    if (!found_nothing(message)) {
      object.integer("sample_index", message.sample_index);
    }
    object.boolean("latest", message.latest);
    if (message.only_if_available) {
      object.boolean("only_if_available", true);
    }
  }
  optional_time(object, "sampled_at_ns", message.sampled_at);
  optional_time(object, "sample_state_at_ns", message.sample_state_at);
  optional_time(object, "available_at_ns", message.available_at);
}

void append_wall(JsonObject& object, const Interaction& message) {
  JsonObject wall = object.object("wall");
  wall.integer("arrival_ns", to_ns(message.wall_at_arrival));
  wall.integer("release_ns", to_ns(message.wall_at_release));
  optional_time(wall, "previous_link_ns", message.previous_link_time);
  wall.close();
}

void read_sensor_fields(const Json& json, Interaction& message) {
  message.sampled_at = optional_time_member<SimTime>(json, "sampled_at_ns");
  if (message.kind == kSensor) {
    message.sensor = text_member(json, "sensor");
    message.latest = boolean_member(json, "latest");
    message.only_if_available =
        json.contains("only_if_available") && boolean_member(json, "only_if_available");
    if (!found_nothing(message)) {
      message.sample_index = unsigned_member(json, "sample_index");
    }
  }
  message.sample_state_at = optional_time_member<SimTime>(json, "sample_state_at_ns");
  message.available_at = optional_time_member<SimTime>(json, "available_at_ns");
}

void read_wall(const Json& json, Interaction& message) {
  message.wall_at_arrival = time_member<WallTime>(json, "arrival_ns");
  message.wall_at_release = time_member<WallTime>(json, "release_ns");
  message.previous_link_time = optional_time_member<Duration>(json, "previous_link_ns");
}

bool is_json_object(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text[first] == '{' && json_depth(text) < kMaxJsonDepth &&
         Json::accept(text);
}

}  // namespace

void append_json(std::string& out, const Interaction& message, JsonParts parts) {
  JsonObject object(out);
  object.text("uav", message.uav);
  object.integer("sequence", message.sequence);
  object.text("kind", message.kind);
  object.integer("request_at_ns", to_ns(message.request_at));
  object.integer("reply_at_ns", to_ns(message.reply_at));
  append_sensor_fields(object, message);
  optional_time(object, "effect_at_ns", message.effect_at);
  optional_time(object, "sleep_until_ns", message.sleep_until);
  if (parts.arrivals) {
    object.integer("st_at_arrival_ns", to_ns(message.st_at_arrival));
    object.integer("lag_ns", to_ns(message.lag));
  }
  object.integer("st_at_release_ns", to_ns(message.st_at_release));
  object.integer("grid_error_ns", to_ns(message.grid_error));
  object.boolean("stamped", message.stamped);
  if (message.violation) {
    object.text("violation", *message.violation);
  }
  if (parts.wall) {
    append_wall(object, message);
  }
  object.close();
}

Interaction interaction_from_json(std::string_view text) {
  const Json json = parse_object(text);
  Interaction message;
  message.uav = text_member(json, "uav");
  message.sequence = unsigned_member(json, "sequence");
  message.kind = text_member(json, "kind");
  message.request_at = time_member<ExecTime>(json, "request_at_ns");
  message.reply_at = time_member<ExecTime>(json, "reply_at_ns");
  read_sensor_fields(json, message);
  message.effect_at = optional_time_member<SimTime>(json, "effect_at_ns");
  message.sleep_until = optional_time_member<ExecTime>(json, "sleep_until_ns");
  message.st_at_arrival = time_member<SimTime>(json, "st_at_arrival_ns");
  message.lag = time_member<Duration>(json, "lag_ns");
  message.st_at_release = time_member<SimTime>(json, "st_at_release_ns");
  message.grid_error = time_member<Duration>(json, "grid_error_ns");
  message.stamped = boolean_member(json, "stamped");
  if (json.contains("violation")) {
    message.violation = text_member(json, "violation");
  }
  read_wall(member(json, "wall"), message);
  return message;
}

void append_json(std::string& out, const CommandEffect& message) {
  JsonObject object(out);
  object.text("uav", message.uav);
  object.integer("sequence", message.sequence);
  object.integer("applied_at_ns", to_ns(message.applied_at));
  object.number("vx_H_m_s", message.vx_H_m_s);
  object.number("vy_H_m_s", message.vy_H_m_s);
  object.number("vz_H_m_s", message.vz_H_m_s);
  object.number("yaw_rate_rad_s", message.yaw_rate_rad_s);
  object.close();
}

CommandEffect command_effect_from_json(std::string_view text) {
  const Json json = parse_object(text);
  CommandEffect message;
  message.uav = text_member(json, "uav");
  message.sequence = unsigned_member(json, "sequence");
  message.applied_at = time_member<SimTime>(json, "applied_at_ns");
  message.vx_H_m_s = number_member(json, "vx_H_m_s");
  message.vy_H_m_s = number_member(json, "vy_H_m_s");
  message.vz_H_m_s = number_member(json, "vz_H_m_s");
  message.yaw_rate_rad_s = number_member(json, "yaw_rate_rad_s");
  return message;
}

void append_json(std::string& out, const GroundTruth& message) {
  JsonObject object(out);
  object.text("uav", message.uav);
  object.integer("at_ns", to_ns(message.at));
  object.numbers("p_WB_m", message.p_WB_m);
  object.numbers("q_WB", message.q_WB);
  object.numbers("v_WB_m_s", message.v_WB_m_s);
  object.numbers("w_WB_B_rad_s", message.w_WB_B_rad_s);
  object.close();
}

GroundTruth ground_truth_from_json(std::string_view text) {
  const Json json = parse_object(text);
  GroundTruth message;
  message.uav = text_member(json, "uav");
  message.at = time_member<SimTime>(json, "at_ns");
  numbers_member(json, "p_WB_m", message.p_WB_m);
  numbers_member(json, "q_WB", message.q_WB);
  numbers_member(json, "v_WB_m_s", message.v_WB_m_s);
  numbers_member(json, "w_WB_B_rad_s", message.w_WB_B_rad_s);
  return message;
}

void append_frame_transform(std::string& out, const GroundTruth& message) {
  JsonObject object(out);
  timestamp(object, message.at);
  object.text("parent_frame_id", "world");
  object.text("child_frame_id", message.uav);
  JsonObject translation = object.object("translation");
  translation.number("x", message.p_WB_m[0]);
  translation.number("y", message.p_WB_m[1]);
  translation.number("z", message.p_WB_m[2]);
  translation.close();
  JsonObject rotation = object.object("rotation");
  rotation.number("x", message.q_WB[1]);
  rotation.number("y", message.q_WB[2]);
  rotation.number("z", message.q_WB[3]);
  rotation.number("w", message.q_WB[0]);
  rotation.close();
  object.close();
}

// The JSON comes from the SUT: it goes in as it is when it is an object, and as a text when it is
// not.
void append_json(std::string& out, const Annotation& message) {
  JsonObject object(out);
  object.text("uav", message.uav);
  object.integer("at_ns", to_ns(message.at));
  object.text("topic", message.topic);
  if (is_json_object(message.json)) {
    object.raw("data", message.json);
  } else {
    JsonObject data = object.object("data");
    data.text("text", message.json);
    data.close();
  }
  object.close();
}

Annotation annotation_from_json(std::string_view text) {
  const Json json = parse_object(text);
  Annotation message;
  message.uav = text_member(json, "uav");
  message.at = time_member<ExecTime>(json, "at_ns");
  message.topic = text_member(json, "topic");
  message.json = member(json, "data").dump();
  return message;
}

void append_json(std::string& out, const Stop& message, JsonParts parts) {
  JsonObject object(out);
  object.text("uav", message.uav);
  object.integer("at_ns", to_ns(message.at));
  optional_time(object, "reply_at_ns", message.reply_at);
  if (parts.wall) {
    JsonObject wall = object.object("wall");
    wall.integer("arrival_ns", to_ns(message.wall));
    wall.close();
  }
  object.close();
}

Stop stop_from_json(std::string_view text) {
  const Json json = parse_object(text);
  Stop message;
  message.uav = text_member(json, "uav");
  message.at = time_member<ExecTime>(json, "at_ns");
  message.reply_at = optional_time_member<ExecTime>(json, "reply_at_ns");
  message.wall = time_member<WallTime>(member(json, "wall"), "arrival_ns");
  return message;
}

void append_json(std::string& out, const Image& message) {
  JsonObject object(out);
  timestamp(object, message.at);
  std::string& frame = object.begin("frame_id");
  append_json_string(frame, message.uav + "/" + message.sensor);
  object.text("format", "png");
  object.text("uav", message.uav);
  object.text("sensor", message.sensor);
  object.integer("index", message.index);
  std::string& data = object.begin("data");
  data += '"';
  append_base64(data, message.png);
  data += '"';
  object.close();
}

Image image_from_json(std::string_view text) {
  const Json json = parse_object(text);
  Image message;
  message.at = timestamp_member(json);
  message.uav = text_member(json, "uav");
  message.sensor = text_member(json, "sensor");
  message.index = unsigned_member(json, "index");
  const Json& data = member(json, "data");
  if (!data.is_string() || !decode_base64(data.get_ref<const std::string&>(), message.png)) {
    throw Damage("member \"data\" is not base64");
  }
  return message;
}

}  // namespace tether::record
