#pragma once

#include <string>

#include <tether/base/result.h>
#include <tether/devices/rig.h>

/// Rig files (docs/guide/tasks.md): TOML that says of real sensors, and of the anchors they will
/// see, what a simulated UAV's catalogue says: `[sensors.NAME]` with `kind`, `device`, mounting,
/// and what belongs to the kind; `[[anchor]]`.
namespace tether::rig {

/// Fails (kInvalid) with one line that names the file, the line and what is wrong there.
///
/// What the file does not say is as an empty rig has it: a sensor's `device` is empty, its mounting
/// the body's frame, a camera's size, focal lengths and field of view 0, a rangefinder's limits 0
/// and +inf. A device that is a relative path is relative to the file's folder.
Result<devices::Rig> load_rig(const std::string& path);
/// The same from the file's text; `path` is for the messages and for relative devices.
Result<devices::Rig> parse_rig(const std::string& text, const std::string& path);

/// What is known of a sensor without a rig file: its kind.
devices::RigSensor plain_sensor(uav::SensorKind kind, const std::string& name);

}  // namespace tether::rig
