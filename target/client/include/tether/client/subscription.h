#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include <tether/base/result.h>
#include <tether/client/vehicle.h>
#include <tether/uav/samples.h>

namespace tether::client {

/// Data that comes by itself: a thread of the library's reads a sensor again and again
/// (Read::kNext) and calls the program back with each measurement, at the ET at which it is
/// available.
///
/// A measurement that comes while the callback still works is delivered after it; if several did,
/// only the newest of them. Measurements that other threads read of the same sensor do not come
/// here: a SUT is given each but once by kNext.
///
/// Destruction ends it at once: an open read is given up, a callback that runs is waited for.
/// Destroying it from within its own callback is allowed. Thread-safe.
class Subscription {
 public:
  virtual ~Subscription() = default;
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  /// Why no measurement will come any more, e.g. kRunEnded; none as long as they come.
  virtual std::optional<Failure> ended() const = 0;

 protected:
  Subscription() = default;
};

/// Subscribes to a periodic sensor. `vehicle` must outlive the subscription. The callback runs in
/// the subscription's own thread, with every signal blocked; it may call the vehicle, and must not
/// throw.
///
/// Fails with kInvalid if the vehicle is not concurrent (the program was not started with
/// tether-exec), the UAV has no such sensor, or it measures on demand.
/// @{
Result<std::unique_ptr<Subscription>> subscribe_camera(
    Vehicle& vehicle, std::string_view sensor,
    std::function<void(const uav::CameraSample&)> on_measurement);
Result<std::unique_ptr<Subscription>> subscribe_imu(
    Vehicle& vehicle, std::string_view sensor,
    std::function<void(const uav::ImuSample&)> on_measurement);
Result<std::unique_ptr<Subscription>> subscribe_range(
    Vehicle& vehicle, std::string_view sensor,
    std::function<void(const uav::RangeSample&)> on_measurement);
/// @}

}  // namespace tether::client
