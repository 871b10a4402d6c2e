#include "checks/sdf_check.h"
#include "convert/sdf_convert.h"

#include <algorithm>
#include <cmath>
#include <functional>

// What the motor plugins of Gazebo's models say of an airframe. There are two kinds:
// - One plugin for each motor: MulticopterMotorModel of Gazebo Sim and its ancestors of RotorS and
//   PX4. Thrust is motorConstant · ω², the reaction torque momentConstant · thrust (F. Furrer et
//   al., "RotorS, a modular Gazebo MAV simulator framework", 2016).
// - ArduPilotPlugin, whose channels turn joints, with a LiftDrag plugin for each blade of a rotor.
//   A blade with its centre of pressure at r from the axis lifts ½ ρ (ω r)² A c_l a_0, and its drag
//   has the same with c_d: both are proportional to ω².
namespace tether::sim {
namespace {

using uav::MultirotorParameters;
using uav::Vec3;

constexpr double kUpright = 0.99;  // cosine of a rotor's axis to the body's z: 8 degrees
constexpr double kAlike = 1e-3;    // relative

struct Motor {
  sdf::ElementPtr declared_by;
  std::string joint{};
  uav::Rotor rotor{};
  double thrust_coefficient = 0.0;
  double moment_coefficient_m = 0.0;
  double max_rotor_speed_rad_s = 0.0;
  std::optional<double> time_constant_up_s{}, time_constant_down_s{}, drag_coefficient{};
};

/// A number of MultirotorParameters by the name that <tether:multirotor> has for it.
struct Given {
  const char* name;
  double MultirotorParameters::*member;
  std::function<std::optional<double>(const Motor&)> of_motor;
};
const std::vector<Given>& given_by_motors() {
  static const std::vector<Given> numbers = {
      {"thrust_coefficient_N_s2", &MultirotorParameters::thrust_coefficient,
       &Motor::thrust_coefficient},
      {"moment_coefficient_m", &MultirotorParameters::moment_coefficient_m,
       &Motor::moment_coefficient_m},
      {"max_rotor_speed_rad_s", &MultirotorParameters::max_rotor_speed_rad_s,
       &Motor::max_rotor_speed_rad_s},
      {"time_constant_up_s", &MultirotorParameters::time_constant_up_s, &Motor::time_constant_up_s},
      {"time_constant_down_s", &MultirotorParameters::time_constant_down_s,
       &Motor::time_constant_down_s},
      {"rotor_drag_N_s2_per_m", &MultirotorParameters::drag_coefficient, &Motor::drag_coefficient}};
  return numbers;
}

std::string text_of(const sdf::ElementPtr& parent, const char* name) {
  const sdf::ElementPtr child = parent->FindElement(name);
  return child && child->GetValue() ? child->GetValue()->GetAsString() : "";
}

/// @throws Error(kBadFile) unless it is greater than 0.
double positive(const SdfSource& source, const sdf::ElementPtr& parent, const char* name) {
  const auto value = read_number(source, parent, name);
  if (!value || *value <= 0.0)
    refuse(source, parent,
           std::string("needs a <") + name + "> greater than 0, to know how its rotor pushes");
  return *value;
}

/// The plugins of a model and of those nested in it, with the scope of the names in them.
struct Plugin {
  sdf::ElementPtr element;
  std::string scope;  ///< "iris::"; empty: the outermost
  MotorPlugin kind;
};
void collect_plugins(const sdf::Model& model, const std::string& scope,
                     std::vector<Plugin>& plugins) {
  for_each_child(model.Element(), [&](const sdf::ElementPtr& child) {
    if (const MotorPlugin kind = motor_plugin(child); kind != MotorPlugin::kNone)
      plugins.push_back({child, scope, kind});
  });
  for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
    const sdf::Model& nested = *model.ModelByIndex(i);
    collect_plugins(nested, scope + nested.Name() + "::", plugins);
  }
}

/// Reads the motors of one model.
class MotorReader {
 public:
  MotorReader(const SdfSource& source, const sdf::Model& model, const std::vector<Part>& parts,
              const uav::Pose& X_BM)
      : source_(source), model_(model), parts_(parts), X_BM_(X_BM) {
    collect_plugins(model, "", plugins_);
  }

  std::vector<Motor> read() const {
    std::vector<Motor> motors;
    for (const Plugin& plugin : plugins_) {
      if (plugin.kind == MotorPlugin::kMotorModel) motors.push_back(of_motor_model(plugin));
      if (plugin.kind != MotorPlugin::kArduPilot) continue;
      for_each_child(plugin.element, [&](const sdf::ElementPtr& channel) {
        if (channel->GetName() == "control" && text_of(channel, "type") == "VELOCITY")
          motors.push_back(of_channel(plugin, channel));
      });
    }
    return motors;
  }

 private:
  Motor of_motor_model(const Plugin& plugin) const {
    const sdf::ElementPtr& element = plugin.element;
    const std::string turns = text_of(element, "turningDirection");
    if (turns != "cw" && turns != "ccw")
      refuse(source_, element, "has <turningDirection> '" + turns + "'; it must be cw or ccw");
    if (const std::string type = text_of(element, "motorType"); !type.empty() && type != "velocity")
      refuse(source_, element,
             "has <motorType> '" + type + "'; only motors with a speed as their command fly");
    Motor motor{.declared_by = element, .joint = plugin.scope + text_of(element, "jointName")};
    motor.rotor = {up_at(plugin, text_of(element, "linkName"), {0, 0, 1}), turns == "ccw" ? 1 : -1};
    motor.thrust_coefficient = positive(source_, element, "motorConstant");
    motor.moment_coefficient_m = positive(source_, element, "momentConstant");
    motor.max_rotor_speed_rad_s = positive(source_, element, "maxRotVelocity");
    motor.time_constant_up_s = positive(source_, element, "timeConstantUp");
    motor.time_constant_down_s = positive(source_, element, "timeConstantDown");
    motor.drag_coefficient = read_number(source_, element, "rotorDragCoefficient");
    return motor;
  }

  Motor of_channel(const Plugin& plugin, const sdf::ElementPtr& channel) const {
    const std::string name = text_of(channel, "jointName");
    const std::string joint_name =
        model_.JointByName(plugin.scope + name) != nullptr ? plugin.scope + name : name;
    const sdf::Joint* const joint = model_.JointByName(joint_name);
    if (joint == nullptr || joint->Axis() == nullptr)
      refuse(source_, channel, "has <jointName> '" + name + "', which is no joint with an axis");
    const std::size_t end = joint_name.rfind("::");
    const std::string link =
        (end == std::string::npos ? "" : joint_name.substr(0, end + 2)) + joint->ChildLinkName();
    const double multiplier = read_number(source_, channel, "multiplier").value_or(0.0);
    if (multiplier == 0.0)
      refuse(source_, channel,
             "needs a <multiplier> other than 0: the speed of its rotor at full throttle [rad/s]");
    const double axis = joint->Axis()->Xyz().Z() < 0.0 ? -1.0 : 1.0;
    Motor motor{.declared_by = channel, .joint = joint_name};
    motor.rotor = {up_at(plugin, link, axis * to_vec3(joint->Axis()->Xyz())),
                   axis * multiplier > 0.0 ? 1 : -1};
    motor.max_rotor_speed_rad_s = std::abs(multiplier);
    add_blades(link, motor);
    return motor;
  }

  void add_blades(const std::string& link, Motor& motor) const {
    double moment = 0.0;  // per ω² [N m s²]
    for (const Plugin& plugin : plugins_) {
      const std::string own = text_of(plugin.element, "link_name");
      if (plugin.kind != MotorPlugin::kLiftDrag || (own != link && plugin.scope + own != link))
        continue;
      const sdf::ElementPtr& blade = plugin.element;
      const auto number = [&](const char* name, double otherwise) {
        return read_number(source_, blade, name).value_or(otherwise);
      };
      const sdf::ElementPtr at = blade->FindElement("cp");
      const auto cp = at ? read_numbers(source_, at, 3) : std::vector<double>(3);
      const double r_m = std::hypot(cp[0], cp[1]);
      const double pressure_area =
          0.5 * number("air_density", 1.2041) * r_m * r_m * number("area", 1.0);
      motor.thrust_coefficient += pressure_area * number("cla", 1.0) * number("a0", 0.0);
      moment += pressure_area * std::abs(number("cda", 0.01) * number("a0", 0.0)) * r_m;
    }
    if (motor.thrust_coefficient <= 0.0 || moment <= 0.0)
      refuse(source_, motor.declared_by,
             "turns a rotor without LiftDrag plugins on its link '" + link +
                 "' that lift and have drag, so its thrust is not known; write a "
                 "<tether:multirotor>: the guide your-own-uav.md");
    motor.moment_coefficient_m = moment / motor.thrust_coefficient;
  }

  /// Where a rotor is whose axis is `axis_L` of its link.
  Vec3 up_at(const Plugin& plugin, const std::string& name, const Vec3& axis_L) const {
    const auto part = std::ranges::find_if(parts_, [&](const Part& one) {
      return one.name == plugin.scope + name || one.name == name;
    });
    if (part == parts_.end())
      refuse(source_, plugin.element, "names the link '" + name + "', which the model lacks");
    const uav::Pose X_BL = X_BM_ * part->X_MN * resolved_pose(source_, *part->link);
    if (uav::rotate(X_BL.q, axis_L).z < kUpright)
      refuse(source_, plugin.element,
             "has a rotor (link '" + name +
                 "') that does not push up. Only multirotors whose rotors all do can fly; planes, "
                 "tilted rotors and vehicles on the ground cannot");
    return X_BL.p;
  }

  const SdfSource& source_;
  const sdf::Model& model_;
  const std::vector<Part>& parts_;
  uav::Pose X_BM_;
  std::vector<Plugin> plugins_{};
};

}  // namespace

bool has_motor_plugins(const sdf::Model& model) {
  std::vector<Plugin> plugins;
  collect_plugins(model, "", plugins);
  return std::ranges::any_of(
      plugins, [](const Plugin& plugin) { return plugin.kind != MotorPlugin::kLiftDrag; });
}

Motors read_motors(const SdfSource& source, const sdf::Model& model, const std::vector<Part>& parts,
                   const uav::Pose& X_BM, MultirotorParameters& airframe) {
  Motors result;
  const std::vector<Motor> motors = MotorReader(source, model, parts, X_BM).read();
  for (const Motor& motor : motors) {
    airframe.rotors.push_back(motor.rotor);
    result.joints.insert(motor.joint);
  }
  if (motors.empty()) return result;
  for (const auto& [name, member, of_motor] : given_by_motors()) {
    const auto value = of_motor(motors.front());
    if (!value) continue;
    airframe.*member = *value;
    result.given.insert(name);
    for (const Motor& motor : motors)
      if (std::abs(of_motor(motor).value_or(0.0) - *value) > kAlike * *value)
        refuse(
            source, motor.declared_by,
            std::string("differs from the first motor in ") + name + "; all rotors must be alike");
  }
  return result;
}

}  // namespace tether::sim
