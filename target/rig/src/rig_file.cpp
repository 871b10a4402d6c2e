#include "rig_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>
#include <vector>

#include <tether/base/units.h>
#include <tether/toml/table.h>

// Reads rig files: first the sensors with their mounting and, by kind, lens or limits, then the
// anchors. toml::Table checks types and ranges; the checks here concern several keys at once.
namespace tether::rig {
namespace {

using toml::Range;
using toml::Table;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kAny_m{.min = -1e3, .max = 1e3};
constexpr Range kPositive_m{.min = 1e-6, .max = 1e6};

uav::Vec3 vector(const Table& table, std::string_view key, const Range& range) {
  const std::vector<double> all = table.numbers(key, 3, range);
  return {all[0], all[1], all[2]};
}

template <class Choice, std::size_t N>
Choice choose(const Table& table, std::string_view key, const std::array<Choice, N>& choices) {
  std::array<std::string_view, N> names;
  std::transform(choices.begin(), choices.end(), names.begin(),
                 [](Choice choice) { return uav::name(choice); });
  return choices[table.choice(key, names)];
}

// Sensors -----------------------------------------------------------------------------------------

void read_distortion(const Table& table, uav::CameraModel& model) {
  const Table distortion = table.table("distortion", {"k1", "k2", "k3", "p1", "p2"});
  constexpr Range kRange{.min = -100.0, .max = 100.0};
  model.k1 = distortion.number_or("k1", kRange, 0.0);
  model.k2 = distortion.number_or("k2", kRange, 0.0);
  model.k3 = distortion.number_or("k3", kRange, 0.0);
  model.p1 = distortion.number_or("p1", kRange, 0.0);
  model.p2 = distortion.number_or("p2", kRange, 0.0);
}

void read_intrinsics(const Table& table, uav::CameraModel& model) {
  if (!table.has("size_px")) table.fail("intrinsics", "needs size_px as well");
  const Table intrinsics = table.table("intrinsics", {"fx_px", "fy_px", "cx_px", "cy_px"});
  constexpr Range kFocal_px{.min = 1e-3, .max = 1e6};
  constexpr Range kPlace_px{.min = -1e5, .max = 1e5};
  model.fx_px = intrinsics.number("fx_px", kFocal_px);
  model.fy_px = intrinsics.number("fy_px", kFocal_px);
  model.cx_px = intrinsics.number_or("cx_px", kPlace_px, 0.5 * (model.width_px - 1));
  model.cy_px = intrinsics.number_or("cy_px", kPlace_px, 0.5 * (model.height_px - 1));
}

void read_size(const Table& table, uav::CameraModel& model) {
  const std::vector<double> size = table.numbers("size_px", 2, {.min = 1, .max = 1 << 14});
  if (size[0] != std::floor(size[0]) || size[1] != std::floor(size[1])) {
    table.fail("size_px", "must be whole numbers");
  }
  model.width_px = static_cast<int>(size[0]);
  model.height_px = static_cast<int>(size[1]);
}

void read_fov(const Table& table, uav::CameraModel& model, double& horizontal_fov_rad) {
  horizontal_fov_rad = rad_from_deg(table.number("horizontal_fov_deg", {.min = 1.0, .max = 179.0}));
  if (table.has("size_px")) {
    model =
        uav::CameraModel::from_horizontal_fov(model.width_px, model.height_px, horizontal_fov_rad);
  }
}

/// Focal lengths only mean something together with the size of the image that the lens makes; a
/// field of view does with any size.
void read_lens(const Table& table, uav::CameraModel& model, double& horizontal_fov_rad) {
  const bool has_fov = table.has("horizontal_fov_deg");
  if (has_fov && table.has("intrinsics")) {
    table.fail("intrinsics", "and horizontal_fov_deg exclude each other; give only one of them");
  }
  if (!has_fov && !table.has("intrinsics")) {
    if (table.has("distortion")) {
      table.fail("distortion", "needs horizontal_fov_deg or intrinsics as well");
    }
    return;
  }
  if (has_fov) {
    read_fov(table, model, horizontal_fov_rad);
  } else {
    read_intrinsics(table, model);
  }
  if (table.has("distortion")) read_distortion(table, model);
}

void read_camera(const Table& table, devices::RigSensor& camera) {
  uav::CameraModel model;
  if (table.has("size_px")) read_size(table, model);
  read_lens(table, model, camera.horizontal_fov_rad);
  camera.description.properties = uav::CameraProperties{model};
}

uav::RangeProperties read_range(const Table& table) {
  const double min_m = table.number_or("min_m", {.min = 0.0, .max = 1e6}, 0.0);
  const double max_m = table.number_or("max_m", kPositive_m, kInfinity);
  if (max_m <= min_m) table.fail("max_m", "must be greater than min_m");
  return {min_m, max_m};
}

uav::Pose read_mounting(const Table& table) {
  uav::Pose X_BS;
  if (table.has("position_m")) X_BS.p = vector(table, "position_m", kAny_m);
  if (table.has("rpy_deg")) {
    const uav::Vec3 rpy_deg = vector(table, "rpy_deg", {.min = -360.0, .max = 360.0});
    X_BS.q =
        uav::from_rpy(rad_from_deg(rpy_deg.x), rad_from_deg(rpy_deg.y), rad_from_deg(rpy_deg.z));
  }
  return X_BS;
}

std::string read_device(const Table& table, const std::string& path) {
  const std::string device = table.text("device");
  if (!devices::is_device(device)) {
    table.fail("device", "is not a device (\"" + device + "\"). Allowed: a path with a '/' (./" +
                             device +
                             " for a file in the folder of this file), a number N for "
                             "/dev/videoN, the URL of a stream, iio:NAME");
  }
  const bool is_path = device.find('/') != std::string::npos;
  if (!is_path || device.find("://") != std::string::npos) return device;
  return (std::filesystem::path(path).parent_path() / device).lexically_normal().string();
}

std::vector<std::string_view> keys_of(uav::SensorKind kind) {
  std::vector<std::string_view> keys = {"kind", "device", "position_m", "rpy_deg"};
  if (kind == uav::SensorKind::kCamera) {
    keys.insert(keys.end(), {"size_px", "horizontal_fov_deg", "intrinsics", "distortion"});
  } else if (kind == uav::SensorKind::kRange) {
    keys.insert(keys.end(), {"min_m", "max_m"});
  }
  return keys;
}

uav::SensorKind read_kind(const Table& sensor) {
  static constexpr std::array kKinds = {uav::SensorKind::kCamera, uav::SensorKind::kImu,
                                        uav::SensorKind::kRange};
  return choose(sensor, "kind", kKinds);
}

devices::RigSensor read_sensor(const Table& sensors, const std::string& name,
                               const std::string& path) {
  const uav::SensorKind kind = read_kind(sensors.table(name));
  const Table table = sensors.table(name, keys_of(kind));
  devices::RigSensor sensor = plain_sensor(kind, name);
  sensor.description.X_BS = read_mounting(table);
  if (kind == uav::SensorKind::kCamera) {
    read_camera(table, sensor);
  } else if (kind == uav::SensorKind::kRange) {
    sensor.description.properties = read_range(table);
  }
  if (table.has("device")) sensor.device = read_device(table, path);
  return sensor;
}

std::vector<devices::RigSensor> read_sensors(const Table& file, const std::string& path) {
  if (!file.has("sensors")) {
    throw Error(ErrorCode::kBadFile, {path, 1},
                "the rig has no sensor; add at least one [sensors.NAME]");
  }
  const Table table = file.table("sensors");
  std::vector<devices::RigSensor> sensors;
  for (const std::string& name : table.keys()) sensors.push_back(read_sensor(table, name, path));
  if (sensors.empty()) table.fail("has no sensor; add at least one [sensors.NAME]");
  return sensors;
}

// Anchors -----------------------------------------------------------------------------------------

/// As the catalogue has it: a cylinder is as wide as it is deep, a sphere as high besides.
void check_proportions(const Table& table, const uav::Anchor& anchor) {
  const uav::Vec3& size = anchor.size_m;
  const bool is_round = anchor.shape != uav::AnchorShape::kBox;
  if ((is_round && size.x != size.y) ||
      (anchor.shape == uav::AnchorShape::kSphere && size.x != size.z)) {
    table.fail(
        "size_m",
        "must be [diameter, diameter, length] for a cylinder, and three times the diameter for "
        "a sphere");
  }
}

uav::Anchor read_anchor(const Table& table) {
  static constexpr std::array kShapes = {uav::AnchorShape::kBox, uav::AnchorShape::kCylinder,
                                         uav::AnchorShape::kSphere};
  uav::Anchor anchor;
  anchor.name = table.text("name");
  anchor.shape = choose(table, "shape", kShapes);
  anchor.size_m = vector(table, "size_m", kPositive_m);
  anchor.color_rgb = vector(table, "color_rgb", {.min = 0.0, .max = 1.0});
  check_proportions(table, anchor);
  return anchor;
}

std::vector<uav::Anchor> read_anchors(const Table& file) {
  std::vector<uav::Anchor> anchors;
  for (const Table& table :
       file.tables_or_none("anchor", {"name", "shape", "size_m", "color_rgb"})) {
    anchors.push_back(read_anchor(table));
    const auto same = [&](const uav::Anchor& other) { return other.name == anchors.back().name; };
    if (std::count_if(anchors.begin(), anchors.end(), same) > 1) {
      table.fail("has the same name as another anchor (\"" + anchors.back().name + "\")");
    }
  }
  return anchors;
}

devices::Rig read_rig(const toml::Document& document, const std::string& path) {
  const Table file = document.root({"uav", "sensors", "anchor"});
  return {file.text_or("uav", "rig"), read_sensors(file, path), read_anchors(file)};
}

}  // namespace

devices::RigSensor plain_sensor(uav::SensorKind kind, const std::string& name) {
  devices::RigSensor sensor;
  sensor.description.name = name;
  if (kind == uav::SensorKind::kCamera) {
    sensor.description.properties = uav::CameraProperties{};
  } else if (kind == uav::SensorKind::kImu) {
    sensor.description.properties = uav::ImuProperties{};
  } else {
    sensor.description.properties = uav::RangeProperties{0.0, kInfinity};
  }
  return sensor;
}

Result<devices::Rig> parse_rig(const std::string& text, const std::string& path) {
  return toml::result_of([&] { return read_rig(toml::Document::parse(text, path), path); });
}

Result<devices::Rig> load_rig(const std::string& path) {
  return toml::result_of([&] { return read_rig(toml::Document::load(path), path); });
}

}  // namespace tether::rig
