#include <tether/client/vehicle.h>

// What vehicles without a radio, without queues, without a battery that can be read, or that only
// take velocities, do.
namespace tether::client {
namespace {

const Failure kNoRadio{Failure::Kind::kInvalid, "this vehicle has no radio"};

}  // namespace

const std::vector<std::string>& Vehicle::peers() const {
  static const std::vector<std::string> none;
  return none;
}

Status Vehicle::send(std::string_view, std::span<const std::uint8_t>) {
  return kNoRadio;
}

Status Vehicle::set_queue(std::string_view, std::uint32_t) {
  return Failure{Failure::Kind::kInvalid, "this vehicle keeps the newest measurement only"};
}

Status Vehicle::skip(std::string_view) {
  return Failure{Failure::Kind::kInvalid, "this vehicle keeps the newest measurement only"};
}

Result<uav::BatterySample> Vehicle::read_battery() {
  return Failure{Failure::Kind::kInvalid, "the battery of this vehicle cannot be read"};
}

Status Vehicle::follow(std::span<const uav::TimedSetpoint>) {
  return Failure{Failure::Kind::kInvalid, "this vehicle does not take set-points"};
}

Status Vehicle::command(const uav::Setpoint& setpoint) {
  const uav::TimedSetpoint only{Duration(0), setpoint};
  return follow({&only, 1});
}

Result<RadioMessage> Vehicle::receive(Duration) {
  return kNoRadio;
}

Result<std::vector<RadioMessage>> Vehicle::receive_or_measure(Duration,
                                                              std::span<const std::string_view>,
                                                              std::uint32_t) {
  return Failure{Failure::Kind::kInvalid, "this vehicle waits for one thing at a time"};
}

Status each_once(const std::vector<std::string_view>& sensors) {
  for (auto sensor = sensors.begin(); sensor != sensors.end(); ++sensor)
    if (std::find(sensors.begin(), sensor, *sensor) != sensor)
      return Failure{Failure::Kind::kInvalid, "'" + std::string(*sensor) +
                                                  "' is named twice; name each sensor that is "
                                                  "read together once"};
  return ok_status();
}

Duration most_apart(const uav::Catalogue& catalogue, const std::vector<std::string_view>& sensors) {
  double highest_rate_hz = 0.0;
  bool own_stamps = false;
  for (const std::string_view name : sensors) {
    const uav::SensorDescription* const sensor = catalogue.find_sensor(name);
    if (sensor == nullptr) continue;
    highest_rate_hz = std::max(highest_rate_hz, sensor->rate_hz);
    own_stamps |= sensor->own_stamps;
  }
  return own_stamps && highest_rate_hz > 0.0 ? duration_from_seconds(0.5 / highest_rate_hz)
                                             : Duration(0);
}

}  // namespace tether::client
