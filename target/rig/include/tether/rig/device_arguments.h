#pragma once

#include <optional>
#include <string>

#include <tether/base/result.h>
#include <tether/devices/rig.h>
#include <tether/rig/mission.h>

/// Real devices on the command line, instead of a coordinator.
namespace tether::rig {

/// What a command line says: the rig's file, and a device for a sensor of each kind; empty: none.
struct DeviceArguments {
  std::string rig;
  std::string camera;
  std::string imu;
  std::string range;
};

/// Devices that were given where a task has a sensor's name (`--camera /dev/video0`) go to
/// `arguments`; the task gets the name of the rig's sensor later, from `make_rig`.
void take_devices(TaskSpec& spec, DeviceArguments& arguments);

/// The sensors to open: those of the rig's file, with the devices of the command line, and without
/// those that have none. Without a file: "camera", "imu" and "range", of which only the device is
/// known. Nothing, if neither a file nor a device was given: a coordinator is meant.
///
/// `mission` gets the names of the sensors whose devices were taken from it. Fails (kInvalid, one
/// line) for a bad file, and for what the mission needs and the rig does not say.
Result<std::optional<devices::Rig>> make_rig(const DeviceArguments& arguments, Mission& mission);

}  // namespace tether::rig
