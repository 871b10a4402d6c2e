#pragma once

#include "clock.h"
#include "iio/iio_attribute.h"
#include "system.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/uav/math.h>
#include <tether/uav/samples.h>

namespace tether::devices {

/// Three axes of one quantity, turned by the device's mounting matrix.
class Triad {
 public:
  /// The channels BASE_x, _y and _z in `folder`. None: the device has not all three.
  static std::optional<Triad> open(System& system, Clock& clock, const std::string& folder,
                                   const std::string& base);

  /// Empty, or why the axes cannot be read.
  const std::string& fault() const { return fault_; }
  /// Measures axis after axis. `fault` says why there is nothing.
  uav::Vec3 read(Clock& clock, std::string& fault) const;

 private:
  std::vector<Channel> axes_;
  std::array<uav::Vec3, 3> rows_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::string fault_;
};

/// An accelerometer and a gyroscope of the kernel's IIO interface: in_accel_{x,y,z} [m/s²] and
/// in_anglvel_{x,y,z} [rad/s], each as "_input", or as "_raw" with scale and offset, multiplied by
/// the mounting matrix. The kernel's convention is that of `ImuSample`: +9.81 upwards at rest.
///
/// The six values are measured one after the other whenever the device is read; a sample is from
/// the instant at which the last of them was there (see RangeDevice). Its `q_WS` is NaN.
class ImuDevice {
 public:
  /// Opens the channels and measures once. Many drivers show accelerometer and gyroscope as two
  /// devices, so they are looked for in each of the folders. Fails with kInvalid.
  static Result<std::unique_ptr<ImuDevice>> open(System& system, const Timeline& time,
                                                 std::string label,
                                                 const std::vector<std::string>& folders);

  /// Fails with kDisconnected, and then for ever.
  Result<uav::ImuSample> read();

 private:
  ImuDevice(const Timeline& time, std::string label, Triad accelerometer, Triad gyroscope);
  /// Returns the fault, or an empty text.
  std::string measure(uav::ImuSample& sample) const;

  Timeline time_;
  std::string label_;
  Triad accelerometer_;
  Triad gyroscope_;
  std::uint64_t measured_ = 0;
  std::optional<Failure> stopped_;
};

/// "0, 1, 0; 1, 0, 0; 0, 0, -1", row by row. None: it is not that.
std::optional<std::array<uav::Vec3, 3>> parse_mount_matrix(const std::string& text);

}  // namespace tether::devices
