#include "json_text.h"

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include <tether/base/json_depth.h>
#include <tether/link/codec.h>
#include <tether/link/field_checker.h>

/// The values that each message may have, one `check` per message and part of a message. Both ends
/// call `validate`: before they send, and after they decoded.
namespace tether::link {
namespace {

using Checker = FieldChecker;

/// The text from a position on, shortened and printable.
std::string excerpt(const std::string& text, std::size_t at) {
  constexpr std::size_t kLength = 24;
  std::string found = text.substr(at, kLength);
  for (char& c : found)
    if (c < ' ' || c > '~') c = '?';
  return found.empty() ? "its end" : "\"" + found + "\"";
}

void json_object(Checker& c, const std::string& value, std::string_view field) {
  c.text(value, kMaxJsonBytes, field);
  if (value.size() > kMaxJsonBytes) return;
  c.require(json_depth(value) <= kMaxSutJsonDepth, field,
            "is nested deeper than " + std::to_string(kMaxSutJsonDepth) + " levels");
  if (const auto fault = fault_of_json_object(value))
    c.require(false, field,
              "is not a JSON object: fault at byte " + std::to_string(*fault) + ", " +
                  excerpt(value, *fault));
}

// --- catalogue ----------------------------------------------------------------------------------

void check_limits(Checker& c, double min_m, double max_m) {
  c.finite(max_m, "max_m");
  c.require(min_m >= 0.0 && min_m <= max_m, "min_m", "is not within 0..max_m");
}

void check(Checker& c, const uav::CameraProperties& camera) {
  const uav::CameraModel& m = camera.model;
  c.require(m.width_px > 0 && m.height_px > 0 && m.width_px <= 1 << 16 && m.height_px <= 1 << 16,
            "image size", "is not within 1..65536 pixels");
  c.require(m.fx_px > 0.0 && m.fy_px > 0.0, "focal length", "is not positive");
  for (double value : {m.fx_px, m.fy_px, m.cx_px, m.cy_px, m.k1, m.k2, m.k3, m.p1, m.p2}) {
    c.finite(value, "camera intrinsic");
  }
  c.require(camera.kind >= uav::CameraKind::kColor && camera.kind <= uav::CameraKind::kSegmentation,
            "kind", "is unknown");
  check_limits(c, camera.min_m, camera.max_m);
  c.require(camera.models.size() <= kMaxModels, "models", "has too many entries");
  for (const std::string& model : camera.models) c.text(model, kMaxNameBytes, "model");
}

void check(Checker&, const uav::ImuProperties&) {}

void check(Checker& c, const uav::RangeProperties& range) {
  check_limits(c, range.min_m, range.max_m);
}

void check(Checker& c, const uav::SensorDescription& sensor) {
  c.in("sensor '" + sensor.name.substr(0, kMaxNameBytes) + "': ");
  c.text(sensor.name, kMaxNameBytes, "name");
  c.require(!sensor.name.empty(), "name", "is empty");
  c.finite(sensor.X_BS.p, "position");
  c.unit(sensor.X_BS.q, "orientation");
  c.finite(sensor.rate_hz, "rate_hz");
  c.require(sensor.rate_hz >= 0.0, "rate_hz", "is negative");
  std::visit([&c](const auto& properties) { check(c, properties); }, sensor.properties);
}

void check(Checker& c, const uav::Anchor& anchor) {
  c.in("anchor '" + anchor.name.substr(0, kMaxNameBytes) + "': ");
  c.text(anchor.name, kMaxNameBytes, "name");
  c.require(!anchor.name.empty(), "name", "is empty");
  c.require(anchor.shape >= uav::AnchorShape::kBox && anchor.shape <= uav::AnchorShape::kSphere,
            "shape", "is unknown");
  c.finite(anchor.size_m, "size_m");
  c.require(anchor.size_m.x >= 0.0 && anchor.size_m.y >= 0.0 && anchor.size_m.z >= 0.0, "size_m",
            "is negative");
  for (double channel : {anchor.color_rgb.x, anchor.color_rgb.y, anchor.color_rgb.z}) {
    c.require(channel >= 0.0 && channel <= 1.0, "color_rgb", "is not within 0..1");
  }
}

template <class Entry>
void check_entries(Checker& c, const std::vector<Entry>& entries, std::string_view field) {
  c.require(entries.size() <= kMaxCatalogueEntries, field, "has too many entries");
  std::set<std::string_view> names;
  for (const Entry& entry : entries) {
    check(c, entry);
    c.require(names.insert(entry.name).second, "name", "is a duplicate");
  }
}

// --- messages -----------------------------------------------------------------------------------

void check(Checker& c, const Hello& hello) {
  c.in("Hello: ");
  c.text(hello.sut, kMaxNameBytes, "sut");
  c.text(hello.uav, kMaxNameBytes, "uav");
  c.text(hello.token, kMaxNameBytes, "token");
  c.require(static_cast<std::size_t>(hello.clock.kind) < computer::kClockKinds, "clock",
            "is unknown");
  c.require(
      hello.clock.factor >= computer::kLeastRate && hello.clock.factor <= computer::kLargestRate,
      "cpu_factor", "is not within 1e-6..1e6");
  c.require(hello.clock.computing >= Duration(0), "computing", "is negative");
  c.text(hello.build_id, kMaxBuildIdBytes, "build_id");
  c.require(hello.build_id.find_first_not_of("0123456789abcdef") == std::string::npos, "build_id",
            "is not a number in lower-case hexadecimal digits");
  c.require(hello.build.size() <= kMaxBuildParts, "build", "has too many parts");
  for (const BuildPart& part : hello.build) {
    c.text(part.name, kMaxNameBytes, "build");
    c.text(part.value, kMaxNameBytes, "build");
  }
}

void check(Checker& c, const std::vector<StageTime>& times, std::string_view field) {
  c.require(times.size() <= kMaxStages, field, "has too many stages");
  std::set<std::string_view> names;
  for (const StageTime& time : times) {
    c.text(time.stage, kMaxNameBytes, field);
    c.require(!time.stage.empty(), field, "has a stage without a name");
    c.require(names.insert(time.stage).second, field, "has a stage twice");
    c.timestamp(to_ns(time.computing), field);
  }
}

void check(Checker& c, const Welcome& welcome) {
  c.in("Welcome: ");
  c.timestamp(welcome.start, "start");
  c.text(welcome.catalogue.uav, kMaxNameBytes, "uav");
  check_entries(c, welcome.catalogue.sensors, "sensors");
  c.in("Welcome: ");
  check_entries(c, welcome.catalogue.anchors, "anchors");
  c.in("Welcome: ");
  c.finite(welcome.catalogue.battery_capacity_C, "battery_capacity_c");
  c.require(welcome.catalogue.battery_capacity_C >= 0.0, "battery_capacity_c", "is negative");
  check(c, welcome.computing, "computing");
  c.require(welcome.peers.size() <= kMaxCatalogueEntries, "peers", "has too many entries");
  for (const std::string& peer : welcome.peers) c.text(peer, kMaxNameBytes, "peers");
  c.require(welcome.real_time_factor > 0.0 && welcome.real_time_factor <= kMaxRealTimeFactor,
            "real_time_factor", "is out of range");
}

void check(Checker& c, const Refusal& refusal) {
  c.in("Refusal: ");
  c.require(refusal.reason <= Refusal::Reason::kRunEnded, "reason", "is unknown");
  c.text(refusal.message, kMaxTextBytes, "message");
}

void check(Checker& c, const ReadSensor& read) {
  c.require(read.sensor < kMaxCatalogueEntries, "sensor", "is larger than any catalogue");
}
void check(Checker& c, const SetVelocity& set) {
  c.require(uav::is_valid(set.command), "velocity command",
            "is not finite, or above 100 m/s or 100 rad/s");
}
void check(Checker& c, const Sleep& sleep) {
  c.timestamp(sleep.until, "until");
}
void check(Checker& c, const Finish& finish) {
  c.text(finish.outcome, kMaxTextBytes, "outcome");
  if (!finish.details.empty()) json_object(c, finish.details, "details");
}

void check_radio(Checker& c, const std::vector<std::uint8_t>& bytes) {
  c.require(bytes.size() <= kMaxRadioBytes, "bytes",
            "has " + std::to_string(bytes.size()) + " bytes; at most " +
                std::to_string(kMaxRadioBytes) + " are allowed");
}
void check(Checker& c, const SendMessage& send) {
  c.text(send.to, kMaxNameBytes, "to");
  check_radio(c, send.bytes);
}
void check(Checker& c, const ReceiveMessage& receive) {
  c.timestamp(to_ns(receive.timeout), "timeout");
}
void check(Checker&, const ReadBattery&) {}

void check(Checker& c, const Request& request) {
  c.in("Request: ");
  c.require(request.sequence > 0, "sequence", "is 0");
  c.timestamp(request.issued_at, "issued_at");
  c.timestamp(to_ns(request.previous_round_trip), "previous_round_trip");
  std::visit([&c](const auto& body) { check(c, body); }, request.body);
  check(c, request.stages, "stages");
}

void check(Checker& c, const uav::CameraSample& sample) {
  c.require(sample.width_px > 0 && sample.height_px > 0, "image size", "is not positive");
  const std::int64_t pixels = std::int64_t{sample.width_px} * sample.height_px;
  const auto is_whole = [pixels](std::size_t size, std::size_t per_pixel) {
    return size % per_pixel == 0 && static_cast<std::int64_t>(size / per_pixel) == pixels;
  };
  const auto [rgb, depth, labels] =
      std::array{sample.rgb.size(), sample.depth_m.size(), sample.labels.size()};
  c.require(rgb + depth + labels > 0, "image", "is empty");
  c.require(rgb == 0 || is_whole(rgb, 3), "image", "is not width x height x 3 bytes");
  c.require(depth == 0 || is_whole(depth, 1), "depth_m", "is not width x height numbers");
  c.require(labels == 0 || is_whole(labels, 1), "labels", "is not width x height numbers");
  c.require(rgb + 4 * depth + 2 * labels <= kMaxReplyBytes - 4096, "image",
            "is larger than a frame may be");
}
void check(Checker& c, const uav::ImuSample& sample) {
  c.finite(sample.angular_velocity_rad_s, "angular_velocity_rad_s");
  c.finite(sample.specific_force_m_s2, "specific_force_m_s2");
  c.unit(sample.q_WS, "q_WS");
}
void check(Checker& c, const uav::RangeSample& sample) {
  c.require(!std::isnan(sample.range_m), "range_m", "is not a number");
}

void check(Checker& c, const Reply& reply) {
  c.in("Reply: ");
  c.require(reply.sequence > 0, "sequence", "is 0");
  c.timestamp(reply.resume_at, "resume_at");
  check(c, reply.computing, "computing");
  if (reply.message) {
    c.text(reply.message->from, kMaxNameBytes, "from");
    c.timestamp(reply.message->sent_at, "sent_at");
    c.timestamp(reply.message->arrived_at, "arrived_at");
    c.require(reply.message->sent_at <= reply.message->arrived_at, "arrived_at",
              "is before sent_at");
    check_radio(c, reply.message->bytes);
  }
  if (reply.battery) {
    c.timestamp(reply.battery->sampled_at, "sampled_at");
    c.finite(reply.battery->voltage_V, "voltage_v");
    c.finite(reply.battery->current_A, "current_a");
    c.require(reply.battery->charge >= 0.0 && reply.battery->charge <= 1.0, "charge",
              "is not within 0..1");
  }
  if (!reply.sample) return;
  const auto check_sample = [&c](const auto& sample) {
    c.timestamp(sample.sampled_at, "sampled_at");
    check(c, sample);
  };
  std::visit(check_sample, *reply.sample);
}

void check(Checker& c, const Progress& progress) {
  c.in("Progress: ");
  c.timestamp(progress.reached, "reached");
}

void check(Checker& c, const Due& due) {
  c.in("Due: ");
  c.require(due.sequence > 0, "sequence", "is 0");
  c.timestamp(due.reply_at, "reply_at");
}

void check(Checker& c, const Annotation& annotation) {
  c.in("Annotation: ");
  c.timestamp(annotation.at, "at");
  c.text(annotation.topic, kMaxNameBytes, "topic");
  c.require(!annotation.topic.empty(), "topic", "is empty");
  json_object(c, annotation.json, "json");
}

}  // namespace

Status validate(const Message& message) {
  Checker checker;
  std::visit([&checker](const auto& content) { check(checker, content); }, message);
  return checker.status();
}

}  // namespace tether::link
