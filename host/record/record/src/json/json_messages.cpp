#include "json/json_messages.h"

#include "damage.h"
#include "json/json_fields.h"
#include "json/json_text.h"
#include "json/members.h"

#include <bit>
#include <cstring>

#include <tether/base/text.h>

// Messages as JSON. The members of most messages are listed once, in members.h, for writing and
// reading. By hand are only Foxglove's schemas (images, transforms) and the JSON of the SUT's in an
// annotation.
namespace tether::record {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

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
  if (seconds >= 9'000'000'000U || nanoseconds >= kNsPerSecond)
    throw Damage("member", "timestamp", "is out of range");
  return from_ns<SimTime>(static_cast<std::int64_t>(seconds) * kNsPerSecond +
                          static_cast<std::int64_t>(nanoseconds));
}

bool is_json_object(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text[first] == '{' && json_depth(text) < kMaxJsonDepth &&
         Json::accept(text);
}

// Foxglove's names; little-endian, as all machines that Tether runs on are.
static_assert(std::endian::native == std::endian::little);
std::string_view encoding_of(const std::vector<float>&) {
  return "32FC1";
}
std::string_view encoding_of(const std::vector<std::uint16_t>&) {
  return "16UC1";
}

void append_data(JsonObject& object, std::span<const std::uint8_t> bytes) {
  std::string& data = object.begin("data");
  data += '"';
  append_base64(data, bytes);
  data += '"';
}

std::vector<std::uint8_t> data_member(const Json& object) {
  std::vector<std::uint8_t> bytes;
  const Json& data = member(object, "data");
  if (!data.is_string() || !decode_base64(data.get_ref<const std::string&>(), bytes))
    throw Damage("member", "data", "is not base64");
  return bytes;
}

// An Image or a RawImage without its pixels.
template <class Message>
Message picture_of_sensor(const Json& json) {
  Message message;
  message.at = timestamp_member(json);
  message.uav = text_member(json, "uav");
  message.sensor = text_member(json, "sensor");
  message.index = unsigned_member(json, "index");
  return message;
}

template <class T>
void decode_pixels(const std::vector<std::uint8_t>& bytes, const RawImage& image,
                   std::vector<T>& pixels) {
  const std::size_t count =
      static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
  if (bytes.size() != count * sizeof(T))
    throw Damage("member", "data", "has another size than the image");
  pixels.resize(count);
  std::memcpy(pixels.data(), bytes.data(), bytes.size());
}

}  // namespace

// The JSON of the SUT's is written as it is if it is an object, and as a string if it is not.
void append_json(std::string& out, const Annotation& message) {
  MemberWriter writer(out);
  members(writer, message);
  if (is_json_object(message.json)) {
    writer.json().raw("data", message.json);
  } else {
    writer.object("data", [&](MemberWriter& data) { data("text", message.json); });
  }
  writer.close();
}

void append_json(std::string& out, const AutopilotMessage& message) {
  MemberWriter writer(out);
  members(writer, message);
  writer.json().raw("fields", message.fields.empty() ? "{}" : message.fields);
  writer.close();
}

void append_json(std::string& out, const Image& message) {
  JsonObject object(out);
  timestamp(object, message.at);
  object.text("frame_id", message.uav + "/" + message.sensor);
  object.text("format", "png");
  object.text("uav", message.uav);
  object.text("sensor", message.sensor);
  object.integer("index", message.index);
  append_data(object, message.png);
  object.close();
}

void append_json(std::string& out, const RawImage& message) {
  JsonObject object(out);
  timestamp(object, message.at);
  object.text("frame_id", message.uav + "/" + message.sensor);
  object.integer("width", message.width_px);
  object.integer("height", message.height_px);
  object.text("uav", message.uav);
  object.text("sensor", message.sensor);
  object.integer("index", message.index);
  std::visit(
      [&](const auto& pixels) {
        object.text("encoding", encoding_of(pixels));
        object.integer("step", sizeof pixels[0] * static_cast<std::size_t>(message.width_px));
        append_data(object, {reinterpret_cast<const std::uint8_t*>(pixels.data()),
                             pixels.size() * sizeof pixels[0]});
      },
      message.pixels);
  object.close();
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

template <>
Annotation from_json<Annotation>(std::string_view text) {
  const Json json = parse_object(text);
  Annotation message = read_members<Annotation>(json);
  message.json = member(json, "data").dump();
  return message;
}

template <>
AutopilotMessage from_json<AutopilotMessage>(std::string_view text) {
  const Json json = parse_object(text);
  AutopilotMessage message = read_members<AutopilotMessage>(json);
  message.fields = member(json, "fields").dump();
  return message;
}

template <>
Image from_json<Image>(std::string_view text) {
  const Json json = parse_object(text);
  Image message = picture_of_sensor<Image>(json);
  message.png = data_member(json);
  return message;
}

template <>
RawImage from_json<RawImage>(std::string_view text) {
  const Json json = parse_object(text);
  RawImage message = picture_of_sensor<RawImage>(json);
  message.width_px = static_cast<int>(integer_member(json, "width", 1, kLargestSide_px));
  message.height_px = static_cast<int>(integer_member(json, "height", 1, kLargestSide_px));
  const std::string encoding = text_member(json, "encoding");
  if (encoding == "16UC1") {
    message.pixels.emplace<std::vector<std::uint16_t>>();
  } else if (encoding != "32FC1") {
    throw Damage("member", "encoding", "is neither 32FC1 nor 16UC1");
  }
  std::visit([&](auto& pixels) { decode_pixels(data_member(json), message, pixels); },
             message.pixels);
  return message;
}

}  // namespace tether::record
