#include "rig_file.h"

#include "toml_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/units.h>

namespace tether::sut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Bounds {
  double least = -kInfinity;
  double most = kInfinity;
};
constexpr Bounds kAny_m{-1e3, 1e3};
constexpr Bounds kPositive_m{1e-6, 1e6};

/// One table of the file.
class Section {
 public:
  /// Throws at the first key that is not one of `allowed`.
  Section(const toml::table& table, std::string title, std::vector<std::string_view> allowed)
      : table_(table), title_(std::move(title)) {
    for (const auto& [key, node] : table) {
      if (std::find(allowed.begin(), allowed.end(), key.str()) == allowed.end()) {
        throw BadInput{line_of(key), title_ + " has no key '" + std::string(key.str()) + "'"};
      }
    }
  }

  bool has(std::string_view key) const { return table_.contains(key); }
  const std::string& title() const { return title_; }

  [[noreturn]] void fail(std::string_view key, const std::string& problem) const {
    const toml::node* node = table_.get(key);
    throw BadInput{line_of(node != nullptr ? *node : table_),
                   title_ + ": " + std::string(key) + " " + problem};
  }

  std::string text(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr || !node->is_string() || node->as_string()->get().empty()) {
      fail(key, "must be a text");
    }
    return node->as_string()->get();
  }

  double number(std::string_view key, const Bounds& bounds) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) {
      fail(key, "is missing");
    }
    return checked(key, *node, bounds);
  }
  double number_or(std::string_view key, const Bounds& bounds, double fallback) const {
    return has(key) ? number(key, bounds) : fallback;
  }

  uav::Vec3 vector(std::string_view key, const Bounds& bounds) const {
    const std::vector<double> all = numbers(key, 3, bounds);
    return {all[0], all[1], all[2]};
  }
  std::vector<double> numbers(std::string_view key, std::size_t count, const Bounds& bounds) const {
    const toml::array* array = table_.get_as<toml::array>(key);
    if (array == nullptr || array->size() != count) {
      fail(key, "must be an array of " + std::to_string(count) + " numbers");
    }
    std::vector<double> all;
    for (const toml::node& node : *array) {
      all.push_back(checked(key, node, bounds));
    }
    return all;
  }

  Section section(std::string_view key, std::vector<std::string_view> allowed) const {
    const toml::table* table = table_.get_as<toml::table>(key);
    if (table == nullptr) {
      fail(key, "must be a table");
    }
    return {*table, title_ + ": " + std::string(key), std::move(allowed)};
  }

 private:
  double checked(std::string_view key, const toml::node& node, const Bounds& bounds) const {
    const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) {
      fail(key, "must be a number");
    }
    if (*value < bounds.least || *value > bounds.most) {
      fail(key, "is out of bounds: " + shown(bounds.least) + " to " + shown(bounds.most));
    }
    return *value;
  }
  static std::string shown(double value) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), "%g", value);
    return digits.data();
  }

  const toml::table& table_;
  std::string title_;
};

template <class Choice, std::size_t N>
Choice choose(const Section& section, std::string_view key, const std::array<Choice, N>& choices) {
  const std::string word = section.text(key);
  std::string names;
  for (const Choice choice : choices) {
    if (uav::name(choice) == word) {
      return choice;
    }
    names += (names.empty() ? "" : ", ") + std::string(uav::name(choice));
  }
  section.fail(key, "\"" + word + "\" is none of " + names);
}

// Sensors -----------------------------------------------------------------------------------------

void read_distortion(const Section& section, uav::CameraModel& model) {
  const Section distortion = section.section("distortion", {"k1", "k2", "k3", "p1", "p2"});
  const Bounds bounds{-100.0, 100.0};
  model.k1 = distortion.number_or("k1", bounds, 0.0);
  model.k2 = distortion.number_or("k2", bounds, 0.0);
  model.k3 = distortion.number_or("k3", bounds, 0.0);
  model.p1 = distortion.number_or("p1", bounds, 0.0);
  model.p2 = distortion.number_or("p2", bounds, 0.0);
}

void read_intrinsics(const Section& section, uav::CameraModel& model) {
  if (!section.has("size_px")) {
    section.fail("intrinsics", "needs size_px beside it");
  }
  const Section intrinsics = section.section("intrinsics", {"fx_px", "fy_px", "cx_px", "cy_px"});
  const Bounds focal_px{1e-3, 1e6};
  const Bounds place_px{-1e5, 1e5};
  model.fx_px = intrinsics.number("fx_px", focal_px);
  model.fy_px = intrinsics.number("fy_px", focal_px);
  model.cx_px = intrinsics.number_or("cx_px", place_px, 0.5 * (model.width_px - 1));
  model.cy_px = intrinsics.number_or("cy_px", place_px, 0.5 * (model.height_px - 1));
}

void read_size(const Section& section, uav::CameraModel& model) {
  const std::vector<double> size = section.numbers("size_px", 2, {1, 1 << 14});
  if (size[0] != std::floor(size[0]) || size[1] != std::floor(size[1])) {
    section.fail("size_px", "must be whole numbers");
  }
  model.width_px = static_cast<int>(size[0]);
  model.height_px = static_cast<int>(size[1]);
}

void read_fov(const Section& section, uav::CameraModel& model, double& horizontal_fov_rad) {
  horizontal_fov_rad = rad_from_deg(section.number("horizontal_fov_deg", {1.0, 179.0}));
  if (section.has("size_px")) {
    model =
        uav::CameraModel::from_horizontal_fov(model.width_px, model.height_px, horizontal_fov_rad);
  }
}

/// Focal lengths only mean something together with the size of the image that the lens makes; a
/// field of view does with any size.
void read_lens(const Section& section, uav::CameraModel& model, double& horizontal_fov_rad) {
  const bool has_fov = section.has("horizontal_fov_deg");
  if (has_fov && section.has("intrinsics")) {
    section.fail("intrinsics", "and horizontal_fov_deg say the same; give one of them");
  }
  if (!has_fov && !section.has("intrinsics")) {
    if (section.has("distortion")) {
      section.fail("distortion", "needs horizontal_fov_deg or intrinsics beside it");
    }
    return;
  }
  if (has_fov) {
    read_fov(section, model, horizontal_fov_rad);
  } else {
    read_intrinsics(section, model);
  }
  if (section.has("distortion")) {
    read_distortion(section, model);
  }
}

void read_camera(const Section& section, devices::RigSensor& camera) {
  uav::CameraModel model;
  if (section.has("size_px")) {
    read_size(section, model);
  }
  read_lens(section, model, camera.horizontal_fov_rad);
  camera.description.properties = uav::CameraProperties{model};
}

uav::RangeProperties read_range(const Section& section) {
  const double min_m = section.number_or("min_m", {0.0, 1e6}, 0.0);
  const double max_m = section.has("max_m") ? section.number("max_m", kPositive_m) : kInfinity;
  if (max_m <= min_m) {
    section.fail("max_m", "must be more than min_m");
  }
  return {min_m, max_m};
}

uav::Pose read_mounting(const Section& section) {
  uav::Pose X_BS;
  if (section.has("position_m")) {
    X_BS.p = section.vector("position_m", kAny_m);
  }
  if (section.has("rpy_deg")) {
    const uav::Vec3 rpy_deg = section.vector("rpy_deg", {-360.0, 360.0});
    X_BS.q =
        uav::from_rpy(rad_from_deg(rpy_deg.x), rad_from_deg(rpy_deg.y), rad_from_deg(rpy_deg.z));
  }
  return X_BS;
}

std::string read_device(const Section& section, const std::string& path) {
  const std::string device = section.text("device");
  if (!devices::is_device(device)) {
    section.fail("device", "\"" + device + "\" is no device: a path with a '/' (./" + device +
                               " for a file beside this one), a number N for /dev/videoN, a "
                               "stream's URL, or iio:NAME");
  }
  const bool is_path = device.find('/') != std::string::npos;
  if (!is_path || device.find("://") != std::string::npos) {
    return device;
  }
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

uav::SensorKind read_kind(const toml::table& table, const std::string& title) {
  static constexpr std::array kKinds = {uav::SensorKind::kCamera, uav::SensorKind::kImu,
                                        uav::SensorKind::kRange};
  std::vector<std::string_view> any;
  for (const auto& [key, node] : table) {
    any.push_back(key.str());
  }
  return choose(Section(table, title, any), "kind", kKinds);
}

devices::RigSensor read_sensor(const toml::table& table, const std::string& name,
                               const std::string& path) {
  const std::string title = "[sensors." + name + "]";
  const uav::SensorKind kind = read_kind(table, title);
  const Section section(table, title, keys_of(kind));
  devices::RigSensor sensor = plain_sensor(kind, name);
  sensor.description.X_BS = read_mounting(section);
  if (kind == uav::SensorKind::kCamera) {
    read_camera(section, sensor);
  } else if (kind == uav::SensorKind::kRange) {
    sensor.description.properties = read_range(section);
  }
  if (section.has("device")) {
    sensor.device = read_device(section, path);
  }
  return sensor;
}

std::vector<devices::RigSensor> read_sensors(const toml::table& file, const std::string& path) {
  const toml::node* node = file.get("sensors");
  if (node == nullptr || !node->is_table() || node->as_table()->empty()) {
    throw BadInput{node != nullptr ? line_of(*node) : 1, "a rig needs a [sensors.NAME] or more"};
  }
  std::vector<devices::RigSensor> sensors;
  for (const auto& [key, sensor] : *node->as_table()) {
    if (!sensor.is_table()) {
      throw BadInput{line_of(key),
                     "sensors." + std::string(key.str()) + " must be a table: [sensors.NAME]"};
    }
    sensors.push_back(read_sensor(*sensor.as_table(), std::string(key.str()), path));
  }
  return sensors;
}

// Anchors -----------------------------------------------------------------------------------------

/// As the catalogue has it: a cylinder is as wide as it is deep, a sphere as high besides.
void check_proportions(const Section& section, const uav::Anchor& anchor) {
  const uav::Vec3& size = anchor.size_m;
  const bool is_round = anchor.shape != uav::AnchorShape::kBox;
  if ((is_round && size.x != size.y) ||
      (anchor.shape == uav::AnchorShape::kSphere && size.x != size.z)) {
    section.fail("size_m",
                 "is [diameter, diameter, length] of a cylinder, and three times the diameter of a "
                 "sphere");
  }
}

uav::Anchor read_anchor(const toml::table& table) {
  static constexpr std::array kShapes = {uav::AnchorShape::kBox, uav::AnchorShape::kCylinder,
                                         uav::AnchorShape::kSphere};
  const Section section(table, "[[anchor]]", {"name", "shape", "size_m", "color_rgb"});
  uav::Anchor anchor;
  anchor.name = section.text("name");
  anchor.shape = choose(section, "shape", kShapes);
  anchor.size_m = section.vector("size_m", kPositive_m);
  anchor.color_rgb = section.vector("color_rgb", {0.0, 1.0});
  check_proportions(section, anchor);
  return anchor;
}

std::vector<uav::Anchor> read_anchors(const toml::table& file) {
  std::vector<uav::Anchor> anchors;
  const toml::node* node = file.get("anchor");
  if (node == nullptr) {
    return anchors;
  }
  if (!node->is_array_of_tables()) {
    throw BadInput{line_of(*node), "anchor must be one table or more: [[anchor]]"};
  }
  for (const toml::node& table : *node->as_array()) {
    anchors.push_back(read_anchor(*table.as_table()));
    const auto same = [&](const uav::Anchor& other) { return other.name == anchors.back().name; };
    if (std::count_if(anchors.begin(), anchors.end(), same) > 1) {
      throw BadInput{line_of(table),
                     "[[anchor]]: there are two of the name \"" + anchors.back().name + "\""};
    }
  }
  return anchors;
}

devices::Rig read_rig(const toml::table& file, const std::string& path) {
  const Section top(file, "a rig", {"uav", "sensors", "anchor"});
  devices::Rig rig;
  rig.uav = top.has("uav") ? top.text("uav") : "rig";
  rig.sensors = read_sensors(file, path);
  rig.anchors = read_anchors(file);
  return rig;
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
  return read_toml<devices::Rig>(text, path,
                                 [&path](const toml::table& file) { return read_rig(file, path); });
}

Result<devices::Rig> load_rig(const std::string& path) {
  const Result<std::string> text = read_text(path, "rig file");
  if (!text) {
    return text.failure();
  }
  return parse_rig(*text, path);
}

}  // namespace tether::sut
