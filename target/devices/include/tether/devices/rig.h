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
  /// What the SUT knows about the sensor. The mounting, field of view and limits come from the rig,
  /// because devices do not have them.
  uav::SensorDescription description;
  /// Camera: "/dev/videoN" or "N" (Video4Linux), the path of a video file, or the URL of a stream.
  /// Rangefinder and IMU: a folder like /sys/bus/iio/devices/iio:deviceN, or "iio:NAME" with NAME
  /// "deviceN" or the content of the driver's `name` file; two of these, separated by a comma, if
  /// accelerometer and gyroscope of an IMU are two devices.
  std::string device;
  /// Field of view of a camera whose description has width 0: its model is computed from this and
  /// the device's size. 0: unknown.
  double horizontal_fov_rad = 0.0;
};

/// Sensors on a bench or on a UAV's frame, without a UAV to fly.
struct Rig {
  std::string uav;
  std::vector<RigSensor> sensors;  ///< names unique
  std::vector<uav::Anchor> anchors;
};

/// Opens every device, in the rig's order; the vehicle closes them. A camera whose description has
/// width 0 gets the device's size, the centre as its principal point, and focal lengths from
/// `horizontal_fov_rad` if that is given. A camera with rate 0 gets the device's rate, if known.
///
/// The vehicle:
/// - `now()` is the wall time since this call. Sleeps are real. `annotate` does nothing, `finish`
///   succeeds, and `command_velocity` fails with kInvalid, because a rig cannot fly.
/// - The timestamp of a camera's sample is that of the device (Video4Linux) if it is plausible;
///   otherwise, and for a stream, it is the time of arrival. `Read::kNext` returns the newest image
///   that was not yet read, and waits for one if needed. `Read::kLatest` returns the last image
///   again while it is younger than a period; else it acts as `kNext`. The index counts the images
///   of the device; opening a live camera reads number 0.
/// - A video file plays at its rate from the first read on, like a live camera; a slow reader
///   misses frames. The timestamp of a frame is the instant at which it was due. At the end of the
///   file, reads fail with kDisconnected.
/// - Rangefinder and IMU measure on demand. Their timestamp is the instant at which the read
///   returned. A range above the description's `max_m` (0: unknown), or the driver's value for no
///   target, reads +inf; a range below `min_m` reads −inf. `q_WS` of an IMU is NaN, because such
///   sensors have no attitude.
///
/// Fails with kInvalid for a device that is missing, not permitted, of another kind or size, or
/// busy, and for duplicate names. Reads fail with kInvalid for an unknown sensor, and with
/// kDisconnected for good once a device has failed. The message is one line with the device and
/// what to do. No read waits longer than about ten seconds. Throws nothing. Thread-safe.
Result<std::unique_ptr<client::Vehicle>> open_rig(Rig rig);

/// Whether the value of an option is a device rather than the name of a sensor: it contains a '/'
/// (path or URL), is a number N (/dev/videoN), or begins with "iio:".
bool is_device(std::string_view text);

}  // namespace tether::devices
