#pragma once

#include "checks/sdf_effects.h"
#include "files/sdf_source.h"

#include <tether/sim/world.h>

namespace tether::sim {

/// Walks through everything that the file says: warns of each element that Tether does not
/// represent and removes it, and refuses values that no scene can have.
/// @throws Error(kBadFile) at the first impossible value.
void check_elements(const SdfSource& source, SdfPurpose purpose, const WarningSink& warn);

/// A plugin of Gazebo's LinearBatteryPlugin, of Gazebo Sim or Gazebo 11.
bool is_battery_plugin(const sdf::ElementPtr& element);
/// Whether it publishes an odometry.
bool is_odometry_plugin(const sdf::ElementPtr& element);

/// Plugins that say how the rotors of a UAV turn and push, of Gazebo Sim or Gazebo 11.
enum class MotorPlugin {
  kNone,
  kMotorModel,  ///< MulticopterMotorModel and its kin of RotorS and PX4: one for each motor
  kArduPilot,   ///< ArduPilotPlugin: its channels turn joints
  kLiftDrag,    ///< of a blade
};
MotorPlugin motor_plugin(const sdf::ElementPtr& element);

/// Warns about an element: its place, and `describe(element)` as the subject.
void warn_at(const SdfSource& source, const sdf::ElementPtr& element, const Effect& effect,
             const std::string& message, const WarningSink& warn);
/// The message of a warning about what a world goes without.
std::string left_out_because(const Error& error);

/// Refuses an element. The error has the element's place, `describe(element)` as its subject, and
/// a message with the model of the element.
[[noreturn]] void refuse(const SdfSource& source, const sdf::ElementPtr& element,
                         const std::string& message);

/// The finite numbers of an element's text. @throws Error(kBadFile) unless there are `count`.
std::vector<double> read_numbers(const SdfSource& source, const sdf::ElementPtr& element,
                                 std::size_t count);
/// The number of a child; none: there is no such child.
std::optional<double> read_number(const SdfSource& source, const sdf::ElementPtr& parent,
                                  const char* name);

}  // namespace tether::sim
