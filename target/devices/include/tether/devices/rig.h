#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>
#include <tether/client/vehicle.h>
#include <tether/uav/catalogue.h>

/// Real sensors behind the interface of the simulated ones, so that a task's perception runs
/// unchanged on real input (paper, Section IV: "Real sensor" in Tables I and II).
namespace tether::devices {

/// One sensor and the device that is read for it.
struct RigSensor {
  /// What the SUT is told of it. The device says nothing of its mounting, field of view or limits,
  /// so these are the rig's to know.
  uav::SensorDescription description;
  /// A camera: "/dev/videoN" or "N" (Video4Linux), a video file's path, or a stream's URL. A
  /// rangefinder or an IMU: a folder laid out like /sys/bus/iio/devices/iio:deviceN, or "iio:NAME"
  /// with NAME "deviceN" or what the driver's `name` file says; two of these with a comma between
  /// where an IMU's driver shows accelerometer and gyroscope as two devices.
  std::string device;
  /// A camera whose description has width 0 gets the model of this field of view, for the size that
  /// its device has; 0: not known.
  double horizontal_fov_rad = 0.0;
};

/// Sensors on a bench or on a UAV's frame, with no UAV that could be flown.
struct Rig {
  std::string uav;
  std::vector<RigSensor> sensors;  ///< names unique
  std::vector<uav::Anchor> anchors;
};

/// Opens every device, in the rig's order; the devices are closed with the vehicle. A camera whose
/// description has width 0 takes the device's size, the centre as its principal point, and the
/// focal lengths of `horizontal_fov_rad`, if that is given. One whose rate is 0 takes the rate that
/// the device says, if it says one.
///
/// Of the vehicle returned:
/// - `now()` is the wall clock's ET since this call; sleeps are real; `annotate` drops what it is
///   given, `finish` succeeds, and `command_velocity` fails with kInvalid: a rig cannot fly.
/// - A camera's sample is from when the device says that the image was taken (Video4Linux's
///   timestamp, where it is plausible), else from its arrival; a stream's from its arrival.
///   `Read::kNext` gives the newest image that was not yet read, and waits for it if need be.
///   `Read::kLatest` gives the one read last again while it is younger than a period, so that there
///   can be no newer one; else it is as `kNext`. The index counts the images that the device gave;
///   the opening of a live camera takes number 0, to see that there are any.
/// - A video file plays at its own rate from the first read on, like a live camera: whoever reads
///   slowly misses frames. A frame is from the instant at which it was due. The file's end is a
///   device that stopped.
/// - Rangefinder and IMU measure when asked; their sample is from the instant at which the read
///   returned. A range beyond the description's `max_m` (0: none known) reads +inf, as does what
///   the driver says when nothing is within range; one below its `min_m` reads −inf. The four
///   components of an IMU's `q_WS` are NaN: such sensors know no attitude.
///
/// Fails with kInvalid (a device that is missing, not allowed, of another kind or size, or busy; a
/// sensor named twice). Reads fail with kInvalid for a sensor that the rig does not have, and with
/// kDisconnected when a device stopped, and then again on every later read of that sensor. Each
/// failure is one line that names the device and says what to do. No read waits for more than about
/// ten seconds. Throws nothing. Not thread-safe, as any Vehicle.
Result<std::unique_ptr<client::Vehicle>> open_rig(Rig rig);

/// Whether an option's value means a device rather than a sensor's name: it has a '/' (a path or a
/// URL), is a number N (/dev/videoN), or begins with "iio:".
bool is_device(std::string_view text);

}  // namespace tether::devices
