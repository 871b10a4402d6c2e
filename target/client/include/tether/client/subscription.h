#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include <tether/base/result.h>
#include <tether/client/vehicle.h>
#include <tether/uav/samples.h>

namespace tether::client {

/// Measurements that are delivered to a callback. A thread of the library reads the sensor
/// continuously (Read::kNext) and calls the program with each measurement, at the ET at which it is
/// available.
///
/// If measurements arrive while the callback runs, it receives the newest of them afterwards.
/// Measurements that other threads read from the same sensor are not delivered: kNext returns each
/// measurement once for each SUT.
///
/// Destruction cancels an open read and waits for a running callback. A callback can destroy its
/// own subscription. Thread-safe.
class Subscription {
 public:
  virtual ~Subscription() = default;
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  /// Why no more measurements will arrive, for example kRunEnded; none while they arrive.
  virtual std::optional<Failure> ended() const = 0;

 protected:
  Subscription() = default;
};

/// Subscribes to a periodic sensor. `vehicle` must outlive the subscription. The callback runs in a
/// thread of the subscription with every signal blocked; it can call the vehicle, and must not
/// throw.
///
/// Fails with kInvalid if the vehicle is not concurrent (the program was not started with
/// tether-exec), the UAV has no such sensor, or it measures on demand.
/// @{
Result<std::unique_ptr<Subscription>> subscribe_any(
    Vehicle& vehicle, std::string_view sensor, uav::SensorKind kind,
    std::function<void(const uav::Sample&)> on_measurement);
/// `subscribe<uav::ImuSample>(vehicle, "imu", [](const uav::ImuSample& sample) { … })`
template <class Sample, class Callback>
Result<std::unique_ptr<Subscription>> subscribe(Vehicle& vehicle, std::string_view sensor,
                                                Callback on_measurement) {
  return subscribe_any(vehicle, sensor, uav::kind_of<Sample>(),
                       [on_measurement = std::move(on_measurement)](const uav::Sample& sample) {
                         on_measurement(std::get<Sample>(sample));
                       });
}
/// @}

}  // namespace tether::client
