#include <tether/client/vehicle.h>

// What vehicles without a radio do.
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

Result<RadioMessage> Vehicle::receive(Duration) {
  return kNoRadio;
}

}  // namespace tether::client
