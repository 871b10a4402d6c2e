#include "checks/sdf_effects.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

namespace tether::sim {
namespace {

using Effects = std::map<std::string, Effect, std::less<>>;

constexpr Effect cannot_change(Consequence what) {
  return {what, false};
}
constexpr Effect can_change(Consequence what) {
  return {what, true};
}

/// By the element, else by its parent, else nothing follows.
const Effects kEffectOfElement = {
    {"actor", Consequence::kMissing},
    {"population", Consequence::kMissing},
    // Both hide what is behind them.
    {"fog", can_change(Consequence::kLooksDifferent)},
    {"particle_emitter", can_change(Consequence::kLooksDifferent)},
    {"projector", Consequence::kLooksDifferent},
    {"enable_wind", Consequence::kBehavesDifferent},
    {"gravity", Consequence::kBehavesDifferent},
    {"joint", Consequence::kBehavesDifferent},
    {"kinematic", Consequence::kBehavesDifferent},
    {"self_collide", Consequence::kBehavesDifferent},
    {"velocity_decay", Consequence::kBehavesDifferent},
    {"wind", Consequence::kBehavesDifferent},
    {"max_contacts", Consequence::kNoEffect},
    // Of a camera: not of what it sees.
    {"camera_info_topic", Consequence::kNoEffect},
    {"save", Consequence::kNoEffect},
    {"trigger_topic", Consequence::kNoEffect},
};
// How a contact feels matters only after it; that there was one is in the result.
const Effects kEffectOfParent = {
    {"geometry", Consequence::kMissing},
    {"attenuation", Consequence::kLooksDifferent},
    {"light", Consequence::kLooksDifferent},
    {"material", Consequence::kLooksDifferent},
    {"metal", Consequence::kLooksDifferent},
    {"mesh", Consequence::kLooksDifferent},
    {"pbr", Consequence::kLooksDifferent},
    {"scene", Consequence::kLooksDifferent},
    {"specular", Consequence::kLooksDifferent},
    {"spot", Consequence::kLooksDifferent},
    {"visual", Consequence::kLooksDifferent},
    {"camera", Consequence::kBehavesDifferent},
    {"lens", Consequence::kBehavesDifferent},
    {"collision", Consequence::kBehavesDifferent},
    {"friction", cannot_change(Consequence::kBehavesDifferent)},
    {"imu", Consequence::kBehavesDifferent},
    {"altimeter", Consequence::kBehavesDifferent},
    {"inertial", Consequence::kBehavesDifferent},
    {"noise", Consequence::kBehavesDifferent},
    {"ode", cannot_change(Consequence::kBehavesDifferent)},
    {"surface", cannot_change(Consequence::kBehavesDifferent)},
    {"contact", cannot_change(Consequence::kBehavesDifferent)},
};

/// Plugins that do what Tether does itself, or only pass on what is simulated: the libraries of
/// Gazebo Sim without "gz-sim" and "-system", those of Gazebo 11 without "lib" and ".so".
constexpr std::array<std::string_view, 18> kPluginsWithoutEffect = {"physics",
                                                                    "user-commands",
                                                                    "scene-broadcaster",
                                                                    "sensors",
                                                                    "imu",
                                                                    "contact",
                                                                    "log",
                                                                    "pose-publisher",
                                                                    "air-pressure",
                                                                    "altimeter",
                                                                    "magnetometer",
                                                                    "navsat",
                                                                    "odometry-publisher",
                                                                    "joint-state-publisher",
                                                                    "gazebo_ros_init",
                                                                    "gazebo_ros_factory",
                                                                    "gazebo_ros_state",
                                                                    "gazebo_ros_camera"};
/// Of a UAV: <tether:multirotor> says how it flies.
constexpr std::array<std::string_view, 4> kPluginsOfRotors = {
    "multicopter-motor-model", "multicopter-control", "gazebo_motor_model",
    "rotors_gazebo_motor_model"};

/// "physics" of "gz-sim7-physics-system" and "libignition-gazebo-physics-system.so",
/// "gazebo_ros_init" of "libgazebo_ros_init.so".
std::string_view short_name(std::string_view library) {
  library = library.substr(library.rfind('/') + 1);
  if (library.ends_with(".so")) library.remove_suffix(3);
  if (library.starts_with("lib")) library.remove_prefix(3);
  for (const std::string_view simulator : {"gz-sim", "ignition-gazebo"}) {
    if (!library.starts_with(simulator) || !library.ends_with("-system")) continue;
    library.remove_suffix(std::string_view("-system").size());
    library.remove_prefix(std::min(library.find('-', simulator.size()), library.size() - 1) + 1);
  }
  return library;
}

Effect effect_of_plugin(const sdf::ElementPtr& plugin, SdfPurpose purpose) {
  const std::string file =
      plugin->HasAttribute("filename") ? plugin->Get<std::string>("filename") : "";
  const std::string_view name = short_name(file);
  const bool is_known =
      std::ranges::count(kPluginsWithoutEffect, name) > 0 ||
      (purpose == SdfPurpose::kUav && std::ranges::count(kPluginsOfRotors, name) > 0);
  return is_known ? Consequence::kNoEffect : Consequence::kBehavesDifferent;
}

bool is_default(const sdf::ParamPtr& value) {
  sdf::ParamPtr otherwise = value->Clone();
  otherwise->Reset();
  bool is_on = false, is_on_otherwise = false;
  const bool is_switch =
      value->GetTypeName() == "bool" && value->Get(is_on) && otherwise->Get(is_on_otherwise);
  return is_switch ? is_on == is_on_otherwise : value->GetAsString() == otherwise->GetAsString();
}

/// Whether an element says what holds without it, and so do all elements in it.
bool is_as_without(const sdf::ElementPtr& element) {
  if (!name_attribute(element).empty()) return false;
  if (const sdf::ParamPtr value = element->GetValue(); value && !is_default(value)) return false;
  bool is_same = true;
  for_each_child(element,
                 [&](const sdf::ElementPtr& child) { is_same = is_same && is_as_without(child); });
  return is_same;
}

/// Whether it decides what a shape meets in the simulator that the file was written for.
bool decides_what_is_met(const sdf::ElementPtr& element) {
  const std::string& name = element->GetName();
  return name == "category_bitmask" || (name == "collide_without_contact" && element->Get<bool>());
}

}  // namespace

bool is_in_static_model(const sdf::ElementPtr& element) {
  for (sdf::ElementPtr e = element->GetParent(); e; e = e->GetParent())
    if (e->GetName() == "model" && e->Get<bool>("static", false).first) return true;
  return false;
}

bool says_nothing(const sdf::ElementPtr& element) {
  const std::string& name = element->GetName();
  if (!element->GetParent()->HasElementDescription(name) || !is_as_without(element)) return false;
  for (std::size_t i = 0; i < element->GetAttributeCount(); ++i)
    if (!is_default(element->GetAttribute(static_cast<unsigned>(i)))) return false;
  // <sky/> and <wind/> say something by being there.
  static const std::set<std::string, std::less<>> kSettings = {
      "atmosphere", "bounce",       "contact",      "enable_wind",   "fdir1",        "friction",
      "gravity",    "kinematic",    "max_contacts", "mu2",           "self_collide", "slip1",
      "slip2",      "soft_contact", "torsional",    "velocity_decay"};
  return kSettings.contains(name) || element->GetParent()->GetName() == "contact";
}

Effect effect_without(const sdf::ElementPtr& element, SdfPurpose purpose) {
  const std::string& name = element->GetName();
  if (name == "plugin") return effect_of_plugin(element, purpose);
  const sdf::ElementPtr parent = element->GetParent();
  // What it was meant to do is not known. Other programs have prefixes of their own.
  const bool is_unknown = name.starts_with("tether:") ? name != "tether:multirotor"
                                                      : name.find(':') == std::string::npos &&
                                                            !parent->HasElementDescription(name);
  if (is_unknown)
    return can_change(name.starts_with("tether:") ? Consequence::kNoEffect
                                                  : Consequence::kBehavesDifferent);
  if (decides_what_is_met(element)) return can_change(Consequence::kBehavesDifferent);
  Effect effect = Consequence::kNoEffect;
  if (const auto of_element = kEffectOfElement.find(name); of_element != kEffectOfElement.end())
    effect = of_element->second;
  else if (const auto of_parent = kEffectOfParent.find(parent->GetName());
           of_parent != kEffectOfParent.end())
    effect = of_parent->second;
  const bool is_of_motion = effect.consequence == Consequence::kBehavesDifferent;
  if (is_as_without(element) || (is_of_motion && is_in_static_model(element)))
    effect.can_change_verdict = false;
  return effect;
}

}  // namespace tether::sim
