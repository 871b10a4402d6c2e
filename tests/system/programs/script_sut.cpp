// A SUT that does what its arguments say, one call after the other:
//   sleep:MS  send:UAV (send: to all)  receive:MS  turn:RAD_S  abort  finish
//   follow:MASK,MASK,…  set-points 7 ms apart near a hover at 1 m; refused:MASK  one that fails
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <tether/client/simulated_vehicle.h>

namespace {

using tether::Status;
using tether::client::Vehicle;

tether::Duration milliseconds(const std::string& text) {
  return tether::Duration(static_cast<std::int64_t>(std::stod(text) * 1e6));
}

/// With values for any mask; a mask above 1000 has velocities in the heading frame.
tether::uav::Setpoint setpoint(int mask) {
  return {.mask = static_cast<std::uint16_t>(mask % 1000),
          .in_heading = mask >= 1000,
          .p_WB_m = {0.4, -0.2, 1.3},
          .velocity_m_s = {0.3, 0.1, -0.05},
          .acceleration_m_s2 = {0.2, -0.1, 0.1},
          .yaw_rad = 0.5,
          .yaw_rate_rad_s = 0.2,
          .q_WB = tether::uav::from_rpy(0.02, -0.03, 0.1),
          .w_WB_B_rad_s = {0.02, 0.01, 0.1},
          .thrust_N = 7.1,
          .rotor_speeds_rad_s = {450, 455, 450, 455},
          .joints_rad = {-0.6, 1.2}};
}

Status follow(Vehicle& vehicle, const std::string& masks) {
  std::vector<tether::uav::TimedSetpoint> trajectory;
  std::istringstream in(masks);
  for (std::string mask; std::getline(in, mask, ',');)
    trajectory.push_back(
        {trajectory.size() * std::chrono::milliseconds(7), setpoint(std::stoi(mask))});
  return vehicle.follow(trajectory);
}

Status do_call(Vehicle& vehicle, const std::string& call, const std::string& value) {
  if (call == "sleep") return vehicle.sleep_for(milliseconds(value));
  if (call == "send") return vehicle.send(value, {});
  if (call == "turn") return vehicle.command_velocity({{}, std::stod(value)});
  if (call == "follow") return follow(vehicle, value);
  if (call == "refused") {
    const Status refused = follow(vehicle, value);
    const bool is_invalid = !refused && refused.failure().kind == tether::Failure::Kind::kInvalid;
    return is_invalid ? tether::ok_status()
                      : tether::Failure{tether::Failure::Kind::kProtocol, "it was not refused"};
  }
  if (call == "finish") return vehicle.finish(true, "done", "");
  if (call == "abort") std::abort();
  const auto message = vehicle.receive(milliseconds(value));
  const bool is_good = message || message.failure().kind == tether::Failure::Kind::kNothingYet;
  return is_good ? tether::ok_status() : Status(message.failure());
}

}  // namespace

int main(int argc, char** argv) {
  auto options = tether::client::options_from_environment();
  auto vehicle = tether::client::connect(std::move(options).value());
  if (!vehicle) return 3;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t colon = std::min(word.find(':'), word.size());
    const std::string value = colon < word.size() ? word.substr(colon + 1) : "";
    if (const Status done = do_call(**vehicle, word.substr(0, colon), value); !done) {
      std::fprintf(stderr, "%s: %s\n", word.c_str(), done.failure().message.c_str());
      return 3;
    }
  }
  return 0;
}
