#include "convert/sdf_convert.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <tether/base/text.h>

namespace tether::sim {

namespace {

using uav::MultirotorParameters;

constexpr std::size_t kMinRotors = 4;

/// The numbers of <tether:multirotor>. What is rarely known of a UAV may be missing: it is then
/// that of the Hummingbird (docs/guide/your-own-uav.md).
struct NumberElement {
  const char* name;
  double MultirotorParameters::*member;
  bool may_be_zero;
  bool may_be_missing;
};
constexpr NumberElement kNumbers[] = {
    {"thrust_coefficient_N_s2", &MultirotorParameters::thrust_coefficient, false, false},
    {"moment_coefficient_m", &MultirotorParameters::moment_coefficient_m, false, true},
    {"rotor_drag_N_s2_per_m", &MultirotorParameters::drag_coefficient, true, true},
    {"linear_drag_N_s_per_m", &MultirotorParameters::linear_drag_N_s_m, true, true},
    {"max_rotor_speed_rad_s", &MultirotorParameters::max_rotor_speed_rad_s, false, false},
    {"time_constant_up_s", &MultirotorParameters::time_constant_up_s, false, true},
    {"time_constant_down_s", &MultirotorParameters::time_constant_down_s, false, true},
    {"max_tilt_rad", &MultirotorParameters::max_tilt_rad, false, true},
    {"max_horizontal_speed_m_s", &MultirotorParameters::max_horizontal_speed_m_s, false, true},
    {"max_vertical_speed_m_s", &MultirotorParameters::max_vertical_speed_m_s, false, true},
    {"max_yaw_rate_rad_s", &MultirotorParameters::max_yaw_rate_rad_s, false, true},
};

const NumberElement* find_number(const std::string& name) {
  const auto* const found = std::ranges::find(kNumbers, name, &NumberElement::name);
  return found == std::end(kNumbers) ? nullptr : found;
}

std::string allowed_elements(const std::string& given) {
  std::vector<std::string_view> names = {"rotor"};
  for (const NumberElement& number : kNumbers) names.emplace_back(number.name);
  return allowed_hint(given, names);
}

/// Names all of those that are missing.
void require(const SdfSource& source, const sdf::ElementPtr& parent,
             const std::vector<const char*>& names) {
  std::string missing;
  for (const char* name : names)
    if (!parent->FindElement(name))
      missing += (missing.empty() ? "<" : ", <") + std::string(name) + ">";
  if (!missing.empty())
    refuse(source, parent, "lacks " + missing + "; the guide your-own-uav.md explains each");
}

double read_number(const SdfSource& source, const sdf::ElementPtr& element, bool may_be_zero) {
  const double value = read_numbers(source, element, 1)[0];
  if (value < 0.0 || (value == 0.0 && !may_be_zero)) {
    refuse(source, element,
           "is " + element->GetValue()->GetAsString() +
               (may_be_zero ? "; it must not be negative" : "; it must be greater than 0"));
  }
  return value;
}

uav::Rotor read_rotor(const SdfSource& source, const sdf::ElementPtr& element) {
  require(source, element, {"position_m", "direction"});
  const auto position = read_numbers(source, element->FindElement("position_m"), 3);
  const sdf::ElementPtr direction = element->FindElement("direction");
  const std::string text = direction->GetValue() ? direction->GetValue()->GetAsString() : "";
  if (text != "cw" && text != "ccw") {
    refuse(source, direction, "is '" + text + "'; it must be cw or ccw, seen from above");
  }
  return {{position[0], position[1], position[2]}, text == "ccw" ? 1 : -1};
}

void read_children(const SdfSource& source, const sdf::ElementPtr& multirotor,
                   MultirotorParameters& airframe) {
  for_each_child(multirotor, [&](const sdf::ElementPtr& child) {
    if (child->GetName() == "rotor") {
      airframe.rotors.push_back(read_rotor(source, child));
    } else if (const NumberElement* number = find_number(child->GetName())) {
      airframe.*number->member = read_number(source, child, number->may_be_zero);
    } else {
      refuse(source, child,
             "is not a parameter of a multirotor; " + allowed_elements(child->GetName()));
    }
  });
}

/// The rotors' forces act on the centre of mass, along the body's axes.
void read_body(const SdfSource& source, const sdf::ElementPtr& model, const Link& body,
               MultirotorParameters& airframe) {
  const uav::Pose& X_LI = body.X_LI;
  if (uav::norm(X_LI.p) > 1e-9 || std::abs(X_LI.q.w) < 1.0 - 1e-12) {
    refuse(source, model,
           "has a centre of mass or principal axes that differ from the frame of link '" +
               body.name + "'; they must coincide with it");
  }
  airframe.mass_kg = body.mass_kg;
  airframe.inertia_kg_m2 = body.inertia_kg_m2;
}

}  // namespace

std::set<std::string> read_airframe(const SdfSource& source, const sdf::Model& model,
                                    const std::vector<Part>& parts, double gravity_m_s2, Uav& uav) {
  const sdf::ElementPtr multirotor = model.Element()->FindElement("tether:multirotor");
  const bool has_plugins = has_motor_plugins(model);
  if (!multirotor && !has_plugins)
    refuse(source, model.Element(),
           "has neither a <tether:multirotor> nor plugins of motors (MulticopterMotorModel, "
           "ArduPilotPlugin). A UAV needs its rotors, <thrust_coefficient_N_s2> and "
           "<max_rotor_speed_rad_s>: the guide your-own-uav.md");
  MultirotorParameters& airframe = uav.airframe;
  const MultirotorParameters typical = uav::hummingbird();
  std::vector<const char*> needed = {"rotor"};
  for (const NumberElement& number : kNumbers) {
    if (!number.may_be_missing) needed.push_back(number.name);
    airframe.*number.member = typical.*number.member;
  }
  Motors motors;
  if (multirotor) {
    read_children(source, multirotor, airframe);
    require(source, multirotor, needed);
  } else {
    motors = read_motors(source, model, parts, uav::inverse(uav.body.X_ML), airframe);
  }
  uav.airframe_from = multirotor ? "<tether:multirotor>" : "the plugins of its motors";
  for (const NumberElement& number : kNumbers)
    if (multirotor ? !multirotor->HasElement(number.name) : !motors.given.contains(number.name))
      uav.by_default.emplace_back(number.name);
  const sdf::ElementPtr declared_by = multirotor ? multirotor : model.Element();
  if (airframe.rotors.size() < kMinRotors ||
      airframe.rotors.size() > uav::MultirotorState::kMaxRotors) {
    refuse(source, declared_by,
           "has " + std::to_string(airframe.rotors.size()) + " rotors; it must have 4 to 8");
  }
  read_body(source, model.Element(), uav.body, airframe);

  const double thrust_N = flight_limits(airframe).max_thrust_N;
  const double weight_N = airframe.mass_kg * gravity_m_s2;
  if (thrust_N <= weight_N)
    refuse(source, declared_by,
           fmt::format("has less thrust than weight: {:.3g} N with all rotors at full speed, and "
                       "{:.3g} N (mass {:.3g} kg)",
                       thrust_N, weight_N, airframe.mass_kg));
  return motors.joints;
}

}  // namespace tether::sim
