#pragma once

#include "clock.h"
#include "iio/iio_attribute.h"
#include "system.h"

#include <memory>
#include <optional>
#include <string>

#include <tether/base/result.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/samples.h>

namespace tether::devices {

/// A rangefinder of the kernel's IIO interface: in_distance_input, or in_distance_raw with scale
/// and offset [m]. Measures whenever it is read.
///
/// The timestamp of a sample is the instant at which the read returned: the kernel does not report
/// the time of the exposure, but nothing later can be in the value (docs/design.md section 2, rule
/// 1). A driver of a sensor that measures continuously can return an old measurement; it is dropped
/// for the next one.
class RangeDevice {
 public:
  /// Opens the channel in `folder`, and measures once, so that a sensor that does not answer is
  /// reported at once. `label` begins each message. Fails with kInvalid.
  static Result<std::unique_ptr<RangeDevice>> open(System& system, const Timeline& time,
                                                   std::string label, const std::string& folder,
                                                   const uav::RangeProperties& limits);

  /// A range beyond the limits' maximum (0: none known), or none that the driver holds for valid,
  /// reads +inf; one below the minimum −inf. Fails with kDisconnected, and then for ever.
  Result<uav::RangeSample> read();

 private:
  RangeDevice(const Timeline& time, std::string label, Channel channel,
              const uav::RangeProperties& limits);
  /// The range, with what the driver gives where it has none; no reading at all has a fault.
  Reading measure() const;
  /// The same, not of something that was measured long before.
  Reading measure_anew();

  Timeline time_;
  std::string label_;
  Channel channel_;
  uav::RangeProperties limits_;
  bool eio_is_no_target_ = false;
  double no_target_m_;      ///< the driver's value for "nothing there", and all above it
  Duration own_period_{0};  ///< of a sensor that measures of its own accord; 0: on demand
  Duration last_read_{0};   ///< when the last read returned
  std::uint64_t measured_ = 0;
  std::optional<Failure> stopped_;
};

}  // namespace tether::devices
