// Checks every element of a parsed SDF file before it is converted. Tables list the elements that
// Tether represents; a walk over the file warns of all others and applies the rules of values
// (sdf_rules.h). Some checks of lights and lenses need more than one element.

#include "checks/sdf_check.h"

#include "files/sdf_numbers.h"
#include "files/sdf_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include <ignition/math/Vector2.hh>

namespace tether::sim {

namespace {

using Names = std::set<std::string, std::less<>>;
using ElementTable = std::map<std::string, Names, std::less<>>;

/// The elements of SDF that Tether represents, by parent.
const ElementTable kElements = {
    {"sdf", {"world", "model"}},
    {"world",
     {"physics", "gravity", "scene", "light", "model", "frame", "spherical_coordinates",
      "magnetic_field", "state"}},
    {"state", {"model"}},
    {"spherical_coordinates",
     {"surface_model", "world_frame_orientation", "latitude_deg", "longitude_deg", "elevation",
      "heading_deg"}},
    {"physics", {"max_step_size"}},
    {"scene", {"ambient", "background", "shadows", "sky"}},
    {"model", {"static", "link", "pose", "frame", "model"}},
    {"frame", {"pose"}},
    {"link", {"pose", "inertial", "visual", "collision"}},
    {"inertial", {"mass", "pose", "inertia"}},
    {"inertia", {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"}},
    {"visual", {"pose", "geometry", "material", "cast_shadows", "transparency", "laser_retro"}},
    {"collision", {"pose", "geometry", "surface", "laser_retro"}},
    {"surface", {"friction", "contact"}},
    {"contact", {"collide_bitmask"}},
    {"friction", {"ode"}},
    {"ode", {"mu"}},
    {"geometry", {"empty", "box", "cylinder", "sphere", "capsule", "ellipsoid", "plane", "mesh"}},
    {"box", {"size"}},
    {"cylinder", {"radius", "length"}},
    {"sphere", {"radius"}},
    {"capsule", {"radius", "length"}},
    {"ellipsoid", {"radii"}},
    {"plane", {"normal", "size"}},
    {"mesh", {"uri", "scale", "submesh"}},
    {"submesh", {"name", "center"}},
    {"material",
     {"ambient", "diffuse", "specular", "emissive", "pbr", "script", "double_sided",
      "tether:texture_repeat"}},
    {"script", {"uri", "name"}},
    {"pbr", {"metal", "specular"}},
    {"metal", {"albedo_map"}},
    {"specular", {"albedo_map"}},
    {"light",
     {"pose", "diffuse", "specular", "attenuation", "direction", "spot", "cast_shadows",
      "intensity"}},
    {"attenuation", {"range", "constant", "linear", "quadratic"}},
    {"spot", {"inner_angle", "outer_angle", "falloff"}},
    {"sensor",
     {"pose", "update_rate", "camera", "imu", "ray", "lidar", "navsat", "gps", "magnetometer",
      "air_pressure", "altimeter"}},
    {"camera",
     {"pose", "horizontal_fov", "image", "clip", "noise", "distortion", "lens", "depth_camera"}},
    {"depth_camera", {"clip"}},
    {"image", {"width", "height", "format"}},
    {"clip", {"near", "far"}},
    {"distortion", {"k1", "k2", "k3", "p1", "p2", "center"}},
    {"lens", {"intrinsics"}},
    {"intrinsics", {"fx", "fy", "cx", "cy"}},
    {"noise",
     {"type", "mean", "stddev", "bias_mean", "bias_stddev", "dynamic_bias_stddev",
      "dynamic_bias_correlation_time"}},
    {"imu", {"angular_velocity", "linear_acceleration"}},
    {"angular_velocity", {"x", "y", "z"}},
    {"linear_acceleration", {"x", "y", "z"}},
    {"navsat", {"position_sensing", "velocity_sensing"}},
    {"gps", {"position_sensing", "velocity_sensing"}},
    {"position_sensing", {"horizontal", "vertical"}},
    {"velocity_sensing", {"horizontal", "vertical"}},
    {"magnetometer", {"x", "y", "z"}},
    {"air_pressure", {"reference_altitude", "pressure"}},
    {"pressure", {"noise"}},
    {"altimeter", {"vertical_position"}},
    {"vertical_position", {"noise"}},
    {"x", {"noise"}},
    {"y", {"noise"}},
    {"z", {"noise"}},
    {"ray", {"scan", "range", "noise"}},
    {"lidar", {"scan", "range", "noise"}},
    {"scan", {"horizontal", "vertical"}},
    {"horizontal", {"samples", "resolution", "min_angle", "max_angle", "noise"}},
    {"vertical", {"samples", "resolution", "min_angle", "max_angle", "noise"}},
    {"range", {"min", "max", "resolution"}},
};

/// Elements that only a world or only a UAV's model may have.
const ElementTable kWorldElements = {
    {"link", {"light"}},
    {"world", {"wind", "road"}},
    {"road", {"width", "point", "material"}},
    {"wind", {"linear_velocity"}},
    {"geometry", {"cone", "polyline", "heightmap"}},
    {"cone", {"radius", "length"}},
    {"polyline", {"point", "height"}},
    {"heightmap", {"uri", "size", "pos", "texture", "blend", "sampling"}},
    {"texture", {"diffuse", "normal", "size"}},
    {"blend", {"min_height", "fade_dist"}}};
const ElementTable kUavElements = {{"link", {"sensor", "enable_wind"}},
                                   {"model", {"tether:multirotor", "joint", "enable_wind"}}};

/// Elements that change nothing of what is simulated: windows, topics, pacing, and what SDF demands
/// but other elements already imply.
const ElementTable kWithoutEffect = {
    {"world", {"gui"}},
    {"physics", {"real_time_factor", "real_time_update_rate"}},
    {"scene", {"grid", "origin_visual"}},
    {"visual", {"meta"}},
    {"model", {"allow_auto_disable"}},
    {"sensor", {"always_on", "visualize", "topic", "gz_frame_id", "ignition_frame_id"}},
    {"camera", {"optical_frame_id"}},
    {"depth_camera", {"output"}},
};

/// What of a material cannot be drawn. A world has hundreds of them: the first one is named.
const Names kFinePoints = {"normal_map", "roughness_map",  "metalness_map",
                           "roughness",  "metalness",      "environment_map",
                           "light_map",  "emissive_map",   "ambient_occlusion_map",
                           "glossiness", "glossiness_map", "specular_map",
                           "shader",     "lighting",       "render_order"};

/// What a world can go without, if it is not usable.
const Names kDispensable = {"visual", "collision", "light", "material"};

/// What of these is represented is not told by their children.
const Names kLeaves = {"tether:multirotor", "joint", "plugin", "sky", "state"};

/// Sensor types that Tether represents.
const Names kSensorTypes = {"camera",
                            "depth",
                            "depth_camera",
                            "rgbd",
                            "rgbd_camera",
                            "segmentation",
                            "segmentation_camera",
                            "imu",
                            "ray",
                            "gpu_ray",
                            "lidar",
                            "gpu_lidar",
                            "navsat",
                            "gps",
                            "magnetometer",
                            "air_pressure",
                            "altimeter"};

bool contains(const ElementTable& table, std::string_view parent, std::string_view child) {
  const auto row = table.find(parent);
  return row != table.end() && row->second.contains(child);
}

bool is_known(SdfPurpose purpose, const std::string& parent, const std::string& child) {
  return contains(kElements, parent, child) ||
         contains(purpose == SdfPurpose::kWorld ? kWorldElements : kUavElements, parent, child);
}

std::string attribute(const sdf::ElementPtr& element, const std::string& key) {
  return element->HasAttribute(key) ? element->GetAttribute(key)->GetAsString() : "";
}

bool is_numeric(const sdf::ElementPtr& element) {
  static const Names types = {"double", "float",   "int",      "unsigned int",
                              "pose",   "vector3", "vector2d", "color"};
  return element->GetValue() && types.contains(element->GetValue()->GetTypeName());
}

void check_numbers_of(const SdfSource& source, const sdf::ElementPtr& element,
                      const std::vector<double>& numbers, const std::string& text) {
  const std::string& parent = element->GetParent()->GetName();
  // Of an inertia, all moments together decide (`mend`).
  const ValueRule* rule = parent == "inertia" ? nullptr : find_rule(parent, element->GetName());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i])) refuse(source, element, "is " + text + "; it must be finite");
    if (rule != nullptr && i < rule->count && !rule->holds(numbers[i])) {
      refuse(source, element, "is " + text + "; " + rule->allowed);
    }
  }
}

void check_value(const SdfSource& source, const sdf::ElementPtr& element) {
  if (!is_numeric(element)) return;
  const std::string text = element->GetValue()->GetAsString();
  const auto numbers = parse_numbers(text);
  if (numbers) check_numbers_of(source, element, *numbers, text);  // else it is hexadecimal
}

/// A model that fell for ever when its world was saved, for example.
bool is_far_away(const sdf::ElementPtr& model) {
  const sdf::ElementPtr pose = model->FindElement("pose");
  if (!pose || !pose->GetValue()) return false;
  const auto numbers = parse_numbers(pose->GetValue()->GetAsString());
  const ValueRule* rule = find_rule("model", "pose");
  if (!numbers || rule == nullptr) return false;
  for (std::size_t i = 0; i < std::min(numbers->size(), rule->count); ++i)
    if (!std::isfinite((*numbers)[i]) || !rule->holds((*numbers)[i])) return true;
  return false;
}

/// Lights reach as far as their attenuation lets them; from this range on, no scene shows the end.
constexpr double kEndlessRange_m = 1000.0;

bool shows_range(const sdf::ElementPtr& light, const sdf::ElementPtr& range) {
  return attribute(light, "type") != "directional" && range->Get<double>() < kEndlessRange_m;
}

/// Inside an inner cone the light is even. It is so everywhere without a falloff.
bool shows_inner_angle(const sdf::ElementPtr& light, const sdf::ElementPtr& angle) {
  const sdf::ElementPtr falloff = angle->GetParent()->FindElement("falloff");
  return attribute(light, "type") == "spot" && angle->Get<double>() > 0.0 && falloff &&
         falloff->Get<double>() > 0.0;
}

/// Warns of what external simulators show of a light and the embedded one does not. libsdformat
/// adds these elements to lights without them; only those of the file have a line.
void check_light_shape(const SdfSource& source, const std::string& parent,
                       const sdf::ElementPtr& element, const WarningSink& warn) {
  if (!element->LineNumber()) return;
  const sdf::ElementPtr light = element->GetParent()->GetParent();
  if (parent == "attenuation" && element->GetName() == "range" && shows_range(light, element)) {
    warn_at(
        source, element, Consequence::kLooksDifferent,
        "is not represented in the embedded simulator, whose lights have no range limit; use at "
        "least 1000 m",
        warn);
  }
  if (parent == "spot" && element->GetName() == "inner_angle" &&
      shows_inner_angle(light, element)) {
    warn_at(source, element, Consequence::kLooksDifferent,
            "is not represented in the embedded simulator, whose spot lights have no inner cone; "
            "use 0",
            warn);
  }
}

/// Of a battery plugin: each parameter that read_battery does not read.
void warn_of_ignored(const SdfSource& source, const sdf::ElementPtr& battery_plugin,
                     const WarningSink& warn) {
  constexpr std::array<std::string_view, 8> kRead = {"voltage",
                                                     "open_circuit_voltage_constant_coef",
                                                     "open_circuit_voltage_linear_coef",
                                                     "capacity",
                                                     "initial_charge",
                                                     "resistance",
                                                     "battery_name",  // there is one only
                                                     "link_name"};
  for_each_child(battery_plugin, [&](const sdf::ElementPtr& child) {
    if (std::ranges::find(kRead, child->GetName()) == kRead.end())
      warn_at(source, child, Consequence::kNoEffect,
              "has no effect: the loads of a battery are those of the energy file", warn);
  });
}

/// The lens is taken to be centred where the optical axis meets the image.
void check_distortion_center(const SdfSource& source, const std::string& parent,
                             const sdf::ElementPtr& element, const WarningSink& warn) {
  if (parent != "distortion" || element->GetName() != "center") return;
  const auto center = element->Get<ignition::math::Vector2d>();
  if (center.X() == 0.5 && center.Y() == 0.5) return;
  warn_at(source, element, Effect(Consequence::kLooksDifferent, true),
          "is not represented: the distortion is centred on the optical axis; use 0.5 0.5, and set "
          "a principal point that is not in the middle by <cx> and <cy> of <lens>",
          warn);
}

class Walk {
 public:
  Walk(const SdfSource& source, SdfPurpose purpose, const WarningSink& warn)
      : source_(source), purpose_(purpose), warn_(warn) {}

  void visit_children(const sdf::ElementPtr& element) const {
    std::vector<sdf::ElementPtr> unrepresented;
    for_each_child(element, [&](const sdf::ElementPtr& child) {
      if (child->GetExplicitlySetInFile() && !visit_if_usable(element->GetName(), child))
        unrepresented.push_back(child);
    });
    // Only now: the place of an element depends on those before it.
    for (const sdf::ElementPtr& child : unrepresented) child->RemoveFromParent();
  }

 private:
  /// The same. Without --strict, a world goes without what it can do without.
  bool visit_if_usable(const std::string& parent, const sdf::ElementPtr& element) const {
    const bool may_go = source_.options().is_tolerant && purpose_ == SdfPurpose::kWorld &&
                        (kDispensable.contains(element->GetName()) ||
                         (element->GetName() == "model" && is_far_away(element)));
    if (!may_go) return visit(parent, element);
    try {
      if (element->GetName() == "model") check_value(source_, element->FindElement("pose"));
      return visit(parent, element);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kBadFile) throw;
      warn_at(source_, element, Consequence::kMissing, left_out_because(error), warn_);
      return false;
    }
  }

  /// @return whether it is to stay. libsdformat would check it further, for nothing; but a pose may
  /// be relative to a joint.
  bool visit(const std::string& parent, const sdf::ElementPtr& element) const {
    const std::string& name = element->GetName();
    if (!is_represented(parent, element)) return name == "joint";
    check_value(source_, element);
    check_light_shape(source_, parent, element, warn_);
    check_distortion_center(source_, parent, element, warn_);
    // These two are read, and warned of, where a UAV is put together.
    if (!kLeaves.contains(name)) visit_children(element);
    // Of what it consisted, nothing may be left.
    return name != "model" || parent == "sdf" || element->HasElement("link") ||
           element->HasElement("model");
  }

  /// Warns of an element that is not and should be.
  bool is_represented(const std::string& parent, const sdf::ElementPtr& element) const {
    const std::string& name = element->GetName();
    if (contains(kWithoutEffect, parent, name) || is_own_plugin(element)) return false;
    if (!is_known(purpose_, parent, name) && says_nothing(element)) return false;
    if (name == "inertial" && is_in_static_model(element)) return false;
    if (purpose_ == SdfPurpose::kUav && parent == "model" &&
        (is_odometry_plugin(element) || motor_plugin(element) != MotorPlugin::kNone))
      return true;
    if (purpose_ == SdfPurpose::kUav && parent == "model" && is_battery_plugin(element)) {
      warn_of_ignored(source_, element, warn_);
      return true;
    }
    if (kFinePoints.contains(name) &&
        (parent == "material" || parent == "metal" || parent == "specular")) {
      if (!said_fine_points_)
        warn_at(source_, element, Consequence::kLooksDifferent,
                "is not represented, nor is any other fine point of materials (maps of normals, "
                "roughness and the like); ignored",
                warn_);
      said_fine_points_ = true;
      return false;
    }
    if (name == "sky")
      warn_at(source_, element, Consequence::kLooksDifferent,
              "is drawn as one colour, without sun and clouds", warn_);
    if (!is_known(purpose_, parent, name)) {
      warn_at(source_, element, effect_without(element, purpose_), unrepresented(parent, element),
              warn_);
      return false;
    }
    if (name == "sensor" && !kSensorTypes.contains(attribute(element, "type"))) {
      if (!sdf::Sensor().SetType(attribute(element, "type")))
        refuse(source_, element,
               "is of type '" + attribute(element, "type") + "', which SDF does not have");
      warn_at(source_, element, Consequence::kMissing,
              "is of type '" + attribute(element, "type") +
                  "', which is not simulated (cameras, imu, ray, navsat, magnetometer, "
                  "air_pressure and "
                  "altimeter are); left out",
              warn_);
      return false;
    }
    return true;
  }

  static bool is_own_plugin(const sdf::ElementPtr& element) {
    return element->GetName() == "plugin" &&
           attribute(element, "filename").find("tether") != std::string::npos;
  }

  std::string unrepresented(const std::string& parent, const sdf::ElementPtr& element) const {
    const std::string& name = element->GetName();
    if (name == "tether:multirotor") {
      return "is ignored: the scenario places the UAVs, not the world";
    }
    if (name.starts_with("tether:")) return "is not a known element of <" + parent + ">; ignored";
    if (name == "sensor") return "is not on a UAV; left out";
    // External simulators read the world themselves, but receive the UAVs from here.
    const bool is_for_all = purpose_ == SdfPurpose::kUav;
    const std::string where = is_for_all ? "" : " in the embedded simulator";
    if (parent == "geometry") return "is a shape that is not represented" + where + "; left out";
    return "is not represented" + where + "; ignored";
  }

  const SdfSource& source_;
  SdfPurpose purpose_;
  const WarningSink& warn_;
  mutable bool said_fine_points_ = false;
};

/// Gazebo Sim names the class of the plugin; of Gazebo 11's, only the file is known.
bool is_plugin_of(const sdf::ElementPtr& element, std::string_view class_name,
                  std::string_view file) {
  const auto has = [&](const char* attribute, std::string_view text) {
    return element->HasAttribute(attribute) &&
           element->Get<std::string>(attribute).find(text) != std::string::npos;
  };
  return element->GetName() == "plugin" && (has("name", class_name) || has("filename", file));
}

/// " in model 'm'" of a link and what belongs to it.
std::string in_model(const sdf::ElementPtr& element) {
  bool is_of_link = false;
  for (sdf::ElementPtr e = element; e; e = e->GetParent()) {
    is_of_link = is_of_link || e->GetName() == "link";
    if (is_of_link && e->GetName() == "model") return " in " + describe(e);
  }
  return "";
}

}  // namespace

std::string left_out_because(const Error& error) {
  std::string reason = error.what();
  const FileLocation& where = error.where();  // that of the warning, or near it
  const std::string place = where.file + ":" + std::to_string(where.line) + ": ";
  if (reason.starts_with(place)) reason.erase(0, place.size());
  return "cannot be used and is left out: " + reason;
}

bool is_battery_plugin(const sdf::ElementPtr& element) {
  return is_plugin_of(element, "LinearBatteryPlugin", "LinearBatteryPlugin");
}

bool is_odometry_plugin(const sdf::ElementPtr& element) {
  return is_plugin_of(element, "OdometryPublisher", "odometry-publisher");
}

MotorPlugin motor_plugin(const sdf::ElementPtr& element) {
  struct Row {
    const char *class_name, *file;
    MotorPlugin kind;
  };
  constexpr Row kRows[] = {
      {"MulticopterMotorModel", "multicopter-motor-model", MotorPlugin::kMotorModel},
      {"MulticopterMotorModel", "gazebo_motor_model", MotorPlugin::kMotorModel},
      {"ArduPilotPlugin", "ArduPilotPlugin", MotorPlugin::kArduPilot},
      {"systems::LiftDrag", "LiftDragPlugin", MotorPlugin::kLiftDrag}};
  for (const Row& row : kRows)
    if (is_plugin_of(element, row.class_name, row.file)) return row.kind;
  return MotorPlugin::kNone;
}

void warn_at(const SdfSource& source, const sdf::ElementPtr& element, const Effect& effect,
             const std::string& message, const WarningSink& warn) {
  if (warn)
    warn({effect.consequence, source.where(element), describe(element), message,
          effect.can_change_verdict});
}

void refuse(const SdfSource& source, const sdf::ElementPtr& element, const std::string& message) {
  const std::string subject = describe(element);
  throw Error(ErrorCode::kBadFile, source.where(element),
              subject + in_model(element) + " " + message)
      .about(subject);
}

std::vector<double> read_numbers(const SdfSource& source, const sdf::ElementPtr& element,
                                 std::size_t count) {
  const std::string text = element->GetValue() ? element->GetValue()->GetAsString() : "";
  const auto numbers = parse_numbers(text);
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!numbers || numbers->size() != count || !std::ranges::all_of(*numbers, is_finite)) {
    refuse(source, element,
           "is '" + text + "'; it must be " + std::to_string(count) +
               (count == 1 ? " finite number" : " finite numbers"));
  }
  check_numbers_of(source, element, *numbers, text);
  return *numbers;
}

std::optional<double> read_number(const SdfSource& source, const sdf::ElementPtr& parent,
                                  const char* name) {
  const sdf::ElementPtr child = parent->FindElement(name);
  if (!child) return std::nullopt;
  return read_numbers(source, child, 1)[0];
}

void check_elements(const SdfSource& source, SdfPurpose purpose, const WarningSink& warn) {
  Walk(source, purpose, warn).visit_children(source.element());
}

}  // namespace tether::sim
