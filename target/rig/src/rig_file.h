#pragma once

#include <string>

#include <tether/base/result.h>
#include <tether/devices/rig.h>

/// Rig files (docs/guide/tasks.md): TOML that describes real sensors and anchors, as the catalogue
/// of a simulated UAV does: `[sensors.NAME]` with `kind`, `device`, mounting and the keys of the
/// kind; `[[anchor]]`.
namespace tether::rig {

/// Reads a rig file. Fails with kInvalid and one line: FILE:LINE and what is wrong.
///
/// Defaults: no device; the body's frame as mounting; 0 for a camera's size, focal lengths and
/// field of view; 0 and +inf for a rangefinder's limits. A relative path of a device is relative
/// to the file's folder.
Result<devices::Rig> load_rig(const std::string& path);
/// The same from the file's text; `path` is for the messages and for relative devices.
Result<devices::Rig> parse_rig(const std::string& text, const std::string& path);

/// A sensor with the defaults of its kind.
devices::RigSensor plain_sensor(uav::SensorKind kind, const std::string& name);

}  // namespace tether::rig
