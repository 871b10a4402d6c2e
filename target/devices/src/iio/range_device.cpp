#include "iio/range_device.h"

#include "iio/iio_folder.h"

#include <array>
#include <cerrno>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace tether::devices {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The ways of the kernel's drivers (drivers/iio/proximity), where they differ from others'.
struct Ways {
  std::string_view driver;  ///< what its `name` file says
  bool eio_is_no_target;    ///< with nothing within range, the read fails with EIO
  double no_target_m;       ///< … or gives this or more
  Duration own_period;      ///< the sensor measures of its own accord, this often; 0: on demand
};
constexpr std::array<Ways, 3> kKnown = {{
    // No look at the sensor's status; the sensor itself gives 8190 or 8191 mm.
    {"vl53l0x", false, 8.19, {}},
    // EIO for each range status but "valid". Where its interrupt is not wired, a read gives the
    // measurement that was completed first since the last read, however long ago.
    {"vl53l1x", true, kInfinity, std::chrono::milliseconds(50)},
    // EIO for an echo later than from 6.45 m.
    {"srf04", true, kInfinity, {}},
}};

Ways ways_of(std::string_view driver) {
  for (const Ways& known : kKnown) {
    if (known.driver == driver) return known;
  }
  return {driver, false, kInfinity, {}};
}

}  // namespace

RangeDevice::RangeDevice(const Timeline& time, std::string label, Channel channel,
                         const uav::RangeProperties& limits)
    : time_(time),
      label_(std::move(label)),
      channel_(std::move(channel)),
      limits_(limits),
      no_target_m_(kInfinity) {}

Result<std::unique_ptr<RangeDevice>> RangeDevice::open(System& system, const Timeline& time,
                                                       std::string label, const std::string& folder,
                                                       const uav::RangeProperties& limits) {
  std::optional<Channel> channel = Channel::open(system, time.clock(), folder, "in_distance", "");
  if (!channel) {
    return invalid(label + ": not a rangefinder: " + folder +
                   " has neither in_distance_input nor in_distance_raw");
  }
  if (!channel->fault().empty()) return invalid(label + ": " + channel->fault());
  // make_unique cannot reach the constructor.
  std::unique_ptr<RangeDevice> device(
      new RangeDevice(time, std::move(label), std::move(*channel), limits));
  const Ways ways = ways_of(iio_name(system, time.clock(), folder));
  device->eio_is_no_target_ = ways.eio_is_no_target;
  device->no_target_m_ = ways.no_target_m;
  device->own_period_ = ways.own_period;
  const Reading first = device->measure_anew();
  if (!first.ok()) return invalid(device->label_ + ": " + first.fault);
  return device;
}

Reading RangeDevice::measure() const {
  Reading reading = channel_.read(time_.clock());
  if (eio_is_no_target_ && reading.error == EIO) reading = {kInfinity, 0, {}};
  return reading;
}

Reading RangeDevice::measure_anew() {
  const Duration asked = time_.clock().now();
  Reading reading = measure();
  // The transfer alone takes a millisecond or two; what took longer was waited for.
  const bool was_there = time_.clock().now() - asked < own_period_ / 10;
  if (reading.ok() && was_there && asked - last_read_ > own_period_) reading = measure();
  last_read_ = time_.clock().now();
  return reading;
}

Result<uav::RangeSample> RangeDevice::read() {
  if (stopped_) return *stopped_;
  const Reading reading = measure_anew();
  uav::RangeSample sample;
  sample.sampled_at = time_.at(time_.clock().now());
  if (!reading.ok()) {
    stopped_ = Failure{Failure::Kind::kDisconnected, label_ + " stopped after " +
                                                         std::to_string(measured_) +
                                                         " measurements (" + reading.fault + ")"};
    return *stopped_;
  }
  sample.index = measured_++;
  const bool too_far = limits_.max_m > 0.0 && reading.value > limits_.max_m;
  sample.range_m = too_far || reading.value >= no_target_m_ ? kInfinity
                   : reading.value < limits_.min_m          ? -kInfinity
                                                            : reading.value;
  return sample;
}

}  // namespace tether::devices
