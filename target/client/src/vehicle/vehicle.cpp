#include <tether/client/vehicle.h>

// What vehicles without a radio, or without a battery that can be read, do.
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

Result<uav::BatterySample> Vehicle::read_battery() {
  return Failure{Failure::Kind::kInvalid, "the battery of this vehicle cannot be read"};
}

Result<RadioMessage> Vehicle::receive(Duration) {
  return kNoRadio;
}

}  // namespace tether::client
