#include <tether/client/vehicle.h>

// What vehicles without a radio, without queues, or without a battery that can be read, do.
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

Result<RadioMessage> Vehicle::receive(Duration) {
  return kNoRadio;
}

}  // namespace tether::client
