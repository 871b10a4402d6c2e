#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <tether/base/result.h>
#include <tether/client/vehicle.h>
#include <tether/devices/rig.h>
#include <tether/rig/mission.h>

/// Real devices on the command line, instead of a coordinator.
namespace tether::rig {

/// Arguments of a command line: the rig's file, and a device for a sensor of each kind; empty:
/// none.
struct DeviceArguments {
  std::string rig;
  std::string camera;
  std::string imu;
  std::string range;
};

/// Moves devices that were given as the name of a task's sensor (`--camera /dev/video0`) to
/// `arguments`. `make_rig` then sets the name of the rig's sensor.
void take_devices(TaskSpec& spec, DeviceArguments& arguments);

/// The sensors to open: those of the rig's file that have a device there or on the command line.
/// Without a file: "camera", "imu" and "range", as far as the command line has their devices.
/// Nothing if neither a file nor a device is given: the program is to connect to a coordinator.
///
/// Sets the names in `mission` for the sensors whose devices were moved from it. Fails with
/// kInvalid and one line for a bad file, and if the rig lacks what the mission needs.
Result<std::optional<devices::Rig>> make_rig(const DeviceArguments& arguments, Mission& mission);

/// The same vehicle, except that its interactions fail with kRunEnded, "interrupted", once
/// `is_interrupted` returns true. A failure caused by the interrupt is reported in the same way.
/// `finish` still works, so that a finished task is reported as finished.
std::unique_ptr<client::Vehicle> make_interruptible(std::unique_ptr<client::Vehicle> vehicle,
                                                    std::function<bool()> is_interrupted);

/// Installs handlers for the whole process: the first SIGINT or SIGTERM, and every SIGHUP (the
/// terminal was closed) unless it is ignored, makes `interrupted` true. The next SIGINT or SIGTERM
/// ends the process. SIGPIPE is ignored: output that nobody reads any more ends nothing.
void catch_interrupts();
bool interrupted();

}  // namespace tether::rig
