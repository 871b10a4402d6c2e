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

}  // namespace tether::client
