#include "json_metadata.h"

#include "damage.h"
#include "json_fields.h"
#include "json_text.h"

#include <charconv>

#include <tether/base/json_depth.h>

namespace tether::record {
namespace {

struct CameraNumber {
  const char* name;
  double CameraInfo::*member;
};
constexpr CameraNumber kCameraNumbers[] = {
    {"fx_px", &CameraInfo::fx_px}, {"fy_px", &CameraInfo::fy_px}, {"cx_px", &CameraInfo::cx_px},
    {"cy_px", &CameraInfo::cy_px}, {"k1", &CameraInfo::k1},       {"k2", &CameraInfo::k2},
    {"k3", &CameraInfo::k3},       {"p1", &CameraInfo::p1},       {"p2", &CameraInfo::p2}};

const std::string& value(const StringMap& values, const std::string& name) {
  const auto found = values.find(name);
  if (found == values.end()) {
    throw Damage("value \"" + name + "\" is missing");
  }
  return found->second;
}

template <class Number>
Number number(const StringMap& values, const std::string& name) {
  const std::string& text = value(values, name);
  Number parsed{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw Damage("value \"" + name + "\" is no number that fits");
  }
  return parsed;
}

template <class Time>
Time time(const StringMap& values, const std::string& name) {
  return Time(Duration(number<std::int64_t>(values, name)));
}

std::string number_text(double number) {
  std::string text;
  append_json_number(text, number);
  return text;
}

// A JSON array of what `append` writes for each item.
template <class Item, class Append>
std::string list_text(const std::vector<Item>& items, Append append) {
  std::string text = "[";
  for (const Item& item : items) {
    text += text.size() > 1 ? "," : "";
    append(text, item);
  }
  return text + "]";
}

template <class Item>
std::vector<Item> list(const StringMap& values, const std::string& name,
                       Item (*read)(const Json&)) {
  const std::string& text = value(values, name);
  const Json json = json_depth(text) > kMaxJsonDepth ? Json() : Json::parse(text, nullptr, false);
  if (!json.is_array()) {
    throw Damage("value \"" + name + "\" is no JSON array");
  }
  std::vector<Item> items;
  for (const Json& element : json) {
    items.push_back(read(element));
  }
  return items;
}

void append_sut(std::string& out, const SutInfo& sut) {
  JsonObject object(out);
  object.text("uav", sut.uav);
  object.text("sut", sut.sut);
  object.text("clock", sut.clock);
  object.number("cpu_factor", sut.cpu_factor);
  object.integer("command_latency_ns", to_ns(sut.command_latency));
  if (sut.concurrent) {
    object.boolean("concurrent", true);
  }
  if (sut.cores > 0) {
    object.integer("cores", sut.cores);
  }
  object.close();
}

int cores_member(const Json& json) {
  constexpr std::int64_t kMost = 1024;
  const std::int64_t cores = integer_member(json, "cores");
  if (cores < 1 || cores > kMost) {
    throw Damage("\"cores\" is " + std::to_string(cores) + ", not from 1 to 1024");
  }
  return static_cast<int>(cores);
}

SutInfo read_sut(const Json& json) {
  return {.uav = text_member(json, "uav"),
          .sut = text_member(json, "sut"),
          .clock = text_member(json, "clock"),
          .cpu_factor = number_member(json, "cpu_factor"),
          .command_latency = time_member<Duration>(json, "command_latency_ns"),
          .concurrent = json.contains("concurrent") && boolean_member(json, "concurrent"),
          .cores = json.contains("cores") ? cores_member(json) : 0};
}

void append_camera(JsonObject& sensor, const CameraInfo& camera) {
  JsonObject object = sensor.object("camera");
  object.numbers("p_BS_m", camera.p_BS_m);
  object.numbers("q_BS", camera.q_BS);
  object.integer("width_px", camera.width_px);
  object.integer("height_px", camera.height_px);
  for (const auto& [name, member] : kCameraNumbers) object.number(name, camera.*member);
  object.close();
}

int image_side(const Json& json, const char* name) {
  constexpr std::int64_t kLargest = 100'000;
  const std::int64_t side_px = integer_member(json, name);
  if (side_px < 1 || side_px > kLargest) {
    throw Damage("member \"" + std::string(name) + "\" is no size of an image");
  }
  return static_cast<int>(side_px);
}

CameraInfo read_camera(const Json& json) {
  CameraInfo camera;
  numbers_member(json, "p_BS_m", camera.p_BS_m);
  numbers_member(json, "q_BS", camera.q_BS);
  camera.width_px = image_side(json, "width_px");
  camera.height_px = image_side(json, "height_px");
  for (const auto& [name, member] : kCameraNumbers) camera.*member = number_member(json, name);
  if (!(camera.fx_px > 0.0) || !(camera.fy_px > 0.0)) {
    throw Damage("a camera's focal length is not positive");
  }
  return camera;
}

void append_sensor(std::string& out, const SensorInfo& sensor) {
  JsonObject object(out);
  object.text("uav", sensor.uav);
  object.text("name", sensor.name);
  object.text("kind", sensor.kind);
  object.boolean("periodic", sensor.periodic);
  object.integer("period_ns", to_ns(sensor.period));
  object.integer("phase_ns", to_ns(sensor.phase));
  object.integer("delay_min_ns", to_ns(sensor.delay_min));
  object.integer("delay_max_ns", to_ns(sensor.delay_max));
  if (sensor.camera) {
    append_camera(object, *sensor.camera);
  }
  object.close();
}

// A record need not bound the delay, nor describe its cameras.
SensorInfo read_sensor(const Json& json) {
  SensorInfo sensor;
  sensor.uav = text_member(json, "uav");
  sensor.name = text_member(json, "name");
  sensor.kind = text_member(json, "kind");
  sensor.periodic = boolean_member(json, "periodic");
  sensor.period = time_member<Duration>(json, "period_ns");
  sensor.phase = time_member<Duration>(json, "phase_ns");
  sensor.delay_min =
      optional_time_member<Duration>(json, "delay_min_ns").value_or(sensor.delay_min);
  sensor.delay_max =
      optional_time_member<Duration>(json, "delay_max_ns").value_or(sensor.delay_max);
  if (json.contains("camera")) {
    sensor.camera = read_camera(member(json, "camera"));
  }
  return sensor;
}

void append_anchor(std::string& out, const Anchor& anchor) {
  JsonObject object(out);
  object.text("name", anchor.name);
  object.text("shape", anchor.shape);
  object.numbers("size_m", anchor.size_m);
  object.numbers("p_WA_m", anchor.p_WA_m);
  object.numbers("q_WA", anchor.q_WA);
  object.close();
}

Anchor read_anchor(const Json& json) {
  Anchor anchor;
  anchor.name = text_member(json, "name");
  anchor.shape = text_member(json, "shape");
  numbers_member(json, "size_m", anchor.size_m);
  numbers_member(json, "p_WA_m", anchor.p_WA_m);
  numbers_member(json, "q_WA", anchor.q_WA);
  return anchor;
}

ExecTime read_exec_time(const Json& json) {
  if (!json.is_number_integer()) {
    throw Damage("a time in \"et_at_end_ns\" is no integer");
  }
  return from_ns<ExecTime>(json.get<std::int64_t>());
}

constexpr std::string_view kReading = "target/";

void add_readings(StringMap& values, const Readings& readings) {
  for (const auto& [name, reading] : readings)
    values[std::string(kReading) + to_utf8(name)] = to_utf8(reading);
}

Readings readings(const StringMap& values) {
  Readings readings;
  for (const auto& [name, reading] : values) {
    if (name.starts_with(kReading)) readings[name.substr(kReading.size())] = reading;
  }
  return readings;
}

}  // namespace

StringMap to_metadata(const Header& header) {
  StringMap values = {
      {"schema_version", std::to_string(header.schema_version)},
      {"tether_version", to_utf8(header.tether_version)},
      {"scenario", to_utf8(header.scenario)},
      {"condition", to_utf8(header.condition)},
      {"policy", to_utf8(header.policy)},
      {"simulator", to_utf8(header.simulator)},
      {"machine", to_utf8(header.machine)},
      {"seed", std::to_string(header.seed)},
      {"step_ns", std::to_string(to_ns(header.step))},
      {"ground_truth_period_ns", std::to_string(to_ns(header.ground_truth_period))},
      {"real_time_factor", number_text(header.real_time_factor)},
      {"suts", list_text(header.suts, append_sut)},
      {"sensors", list_text(header.sensors, append_sensor)},
      {"anchors", list_text(header.anchors, append_anchor)},
  };
  if (header.wall_at_start != WallTime{})
    values["wall_at_start_ns"] = std::to_string(to_ns(header.wall_at_start));
  if (header.target) {
    values["target_name"] = to_utf8(header.target->name);
    values["target_address"] = to_utf8(header.target->address);
    add_readings(values, header.target->before);
  }
  return values;
}

int schema_version(const StringMap& values) {
  return number<int>(values, "schema_version");
}

Header header_from_metadata(const StringMap& values) {
  Header header;
  header.schema_version = schema_version(values);
  header.tether_version = value(values, "tether_version");
  header.scenario = value(values, "scenario");
  header.condition = value(values, "condition");
  header.policy = value(values, "policy");
  header.simulator = value(values, "simulator");
  header.machine = value(values, "machine");
  header.seed = number<std::uint64_t>(values, "seed");
  header.step = time<Duration>(values, "step_ns");
  header.ground_truth_period = time<Duration>(values, "ground_truth_period_ns");
  header.real_time_factor = number<double>(values, "real_time_factor");
  header.suts = list(values, "suts", read_sut);
  header.sensors = list(values, "sensors", read_sensor);
  header.anchors = list(values, "anchors", read_anchor);
  if (values.contains("wall_at_start_ns"))
    header.wall_at_start = time<WallTime>(values, "wall_at_start_ns");
  if (values.contains("target_name")) {
    header.target = {value(values, "target_name"), value(values, "target_address"),
                     readings(values)};
  }
  return header;
}

StringMap to_metadata(const Footer& footer) {
  StringMap values{
      {"end", to_utf8(footer.end)},
      {"reason", to_utf8(footer.reason)},
      {"st_at_end_ns", std::to_string(to_ns(footer.st_at_end))},
      {"et_at_end_ns",
       list_text(footer.et_at_end,
                 [](std::string& out, ExecTime et) { append_json_integer(out, to_ns(et)); })},
      {"wall_ns", std::to_string(to_ns(footer.wall))},
      {"interactions", std::to_string(footer.interactions)},
      {"causality_violations", std::to_string(footer.causality_violations)},
      {"largest_lag_ns", std::to_string(to_ns(footer.largest_lag))},
      {"largest_grid_error_ns", std::to_string(to_ns(footer.largest_grid_error))},
  };
  if (footer.stops > 0) {
    values["stops"] = std::to_string(footer.stops);
    values["largest_overshoot_ns"] = std::to_string(to_ns(footer.largest_overshoot));
  }
  add_readings(values, footer.target_after);
  return values;
}

Footer footer_from_metadata(const StringMap& values) {
  Footer footer;
  footer.end = value(values, "end");
  footer.reason = value(values, "reason");
  footer.st_at_end = time<SimTime>(values, "st_at_end_ns");
  footer.et_at_end = list(values, "et_at_end_ns", read_exec_time);
  footer.wall = time<Duration>(values, "wall_ns");
  footer.interactions = number<std::uint64_t>(values, "interactions");
  footer.causality_violations = number<std::uint64_t>(values, "causality_violations");
  footer.largest_lag = time<Duration>(values, "largest_lag_ns");
  footer.largest_grid_error = time<Duration>(values, "largest_grid_error_ns");
  if (values.contains("stops")) {
    footer.stops = number<std::uint64_t>(values, "stops");
    footer.largest_overshoot = time<Duration>(values, "largest_overshoot_ns");
  }
  footer.target_after = readings(values);
  return footer;
}

}  // namespace tether::record
