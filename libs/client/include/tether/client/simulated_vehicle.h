#pragma once

#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/client/sut_clock.h>
#include <tether/client/vehicle.h>
#include <tether/link/channel.h>

namespace tether::client {

struct ConnectOptions {
  link::Address address;
  std::string token;
  std::string sut_name;
  std::string uav;                   ///< empty: the only one
  std::unique_ptr<TimeSource> time;  ///< null: the wall clock
  Duration connect_timeout = std::chrono::seconds(10);
  /// Tell the coordinator this often how far ET has come, so that it can simulate meanwhile. 0:
  /// never (scripted clocks).
  Duration progress_period = std::chrono::milliseconds(2);
};

/// Address, token, UAV and clock from the environment that `tether run` sets for the SUT it starts:
/// TETHER_ADDRESS, TETHER_TOKEN, TETHER_UAV, TETHER_CLOCK ("wall", "cpu" or "cpu*FACTOR").
Result<ConnectOptions> options_from_environment();

/// Connects to a coordinator and shakes hands. The returned vehicle's ET starts with the
/// coordinator's Welcome.
Result<std::unique_ptr<Vehicle>> connect(ConnectOptions options);
/// The same over a channel that is already there (tests, other transports). Ignores
/// options.address.
Result<std::unique_ptr<Vehicle>> connect(std::unique_ptr<link::Channel> channel,
                                         ConnectOptions options);

}  // namespace tether::client
