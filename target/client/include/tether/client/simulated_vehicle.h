#pragma once

#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/client/sut_clock.h>
#include <tether/client/vehicle.h>
#include <tether/link/channel.h>

namespace tether::client {

struct ConnectOptions {
  /// Path of tether-exec's socket. Not empty: the vehicle is a concurrent one, and tether-exec
  /// knows address, token and clock.
  std::string exec_socket;
  link::Address address;
  std::string token;
  std::string sut_name;              ///< the program's name and version, for the record
  std::string uav;                   ///< empty: the only one
  std::unique_ptr<TimeSource> time;  ///< null: the wall clock
  Duration connect_timeout = std::chrono::seconds(10);
  /// How long the coordinator may take to answer the Hello (it may wait for other SUTs, or load the
  /// world).
  Duration welcome_timeout = std::chrono::seconds(60);
  /// Tell the coordinator this often how far ET has come, so that it can simulate meanwhile. 0:
  /// never. Scripted clocks never do.
  Duration progress_period = std::chrono::milliseconds(2);
  /// In free running, where ST waits for nobody, the same message serves as a sign of life, sent
  /// this often while the SUT computes, stalls or sleeps. 0: never; the coordinator then takes a
  /// SUT for hung that makes no call for long.
  Duration heartbeat_period = std::chrono::milliseconds(500);
};

/// From the environment that tether-exec sets for the command it starts: TETHER_EXEC, the path of
/// its socket. Where that is not set: address, token, UAV and clock from what `tether run` sets for
/// the SUT it starts: TETHER_ADDRESS, TETHER_TOKEN, TETHER_UAV (may be unset: the only one),
/// TETHER_CLOCK (see parse_time_source; unset: "wall"). Fails with kInvalid, naming the variable,
/// its value and what is allowed.
Result<ConnectOptions> options_from_environment();

/// Connects to a coordinator, or to the tether-exec that stands between, and shakes hands. The
/// returned vehicle's ET starts with the coordinator's Welcome.
///
/// Fails with kDisconnected or kTimeout (no coordinator there, or no answer), kRefused (the
/// coordinator's own words), kInvalid (options that cannot be used, or, in free running, a
/// clock faster than the CPU or a wall clock with a factor; with tether-exec, any clock other than
/// the plain wall clock).
///
/// The vehicle's calls fail with kInvalid for wrong arguments, and can then be called again. After
/// any other failure (kRefused, kRunEnded, kDisconnected, kProtocol) every later call fails with
/// the same.
///
/// Under the barrier, calls are interactions in the sense of the paper (Section II): ET is stamped
/// when the call begins, stands still until the reply is there whole, and goes on from the reply's
/// timestamp. In free running nothing is held: ET is the wall time since the Welcome, sleeps are
/// real, and with a CPU clock the client stalls before each call for the time by which the virtual
/// target would have been slower; its ET includes that time as soon as it is owed.
Result<std::unique_ptr<Vehicle>> connect(ConnectOptions options);
/// The same over a channel that is already there (tests, other transports). Ignores
/// options.address.
Result<std::unique_ptr<Vehicle>> connect(std::unique_ptr<link::Channel> channel,
                                         ConnectOptions options);

}  // namespace tether::client
