#pragma once

#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/client/sut_clock.h>
#include <tether/client/vehicle.h>
#include <tether/link/channel.h>
#include <tether/link/messages.h>

namespace tether::client {

struct ConnectOptions {
  /// Path of tether-exec's socket. If not empty, the vehicle is concurrent, and tether-exec has the
  /// address, the token and the clock.
  std::string exec_socket;
  link::Address address;
  std::string token;
  std::string sut_name;              ///< the program's name and version, for the record
  std::string uav;                   ///< empty: the only one
  std::unique_ptr<TimeSource> time;  ///< null: the wall clock
  Duration connect_timeout = std::chrono::seconds(10);
  /// Time limit for the coordinator's answer to Hello. It can wait for other SUTs or load the
  /// world.
  Duration welcome_timeout = std::chrono::seconds(60);
  /// Interval at which the coordinator receives the ET reached so far, so that it can simulate in
  /// parallel. 0: never. Not used with scripted clocks.
  Duration progress_period = std::chrono::milliseconds(2);
  /// In free-running mode the same message is a heartbeat, sent at this interval while the SUT
  /// computes, stalls or sleeps. 0: never; the coordinator then reports a SUT as hung that makes no
  /// call for a long time.
  Duration heartbeat_period = std::chrono::milliseconds(500);
};

/// Options from the environment: TETHER_EXEC, the path of the socket, if tether-exec started this
/// program; else TETHER_ADDRESS, TETHER_TOKEN, TETHER_UAV (unset: the only one) and TETHER_CLOCK
/// (see parse_time_source; unset: "wall"), which `tether run` sets. Fails with kInvalid; the
/// message has the variable, its value and the allowed values.
Result<ConnectOptions> options_from_environment();

/// Connects to a coordinator, directly or through tether-exec. The vehicle's ET starts with the
/// coordinator's Welcome.
///
/// Fails with kDisconnected or kTimeout (no coordinator, or no answer), kRefused (with the
/// coordinator's message), or kInvalid (unusable options; in free-running mode also a clock faster
/// than the CPU or a wall clock with a factor; with tether-exec any clock except the plain wall
/// clock).
///
/// The vehicle's calls fail with kInvalid for wrong arguments; later calls can succeed. After any
/// other failure (kRefused, kRunEnded, kDisconnected, kProtocol) every later call fails with the
/// same.
///
/// Under the barrier, calls are interactions in the sense of the paper (Section II): ET is stamped
/// when the call begins, is stopped until the reply is complete, and continues from the reply's
/// timestamp. In free-running mode nothing is held: ET follows ST, as far as the replies tell it.
/// With a CPU clock the client then stalls before each call for the time by which the virtual
/// target is slower; ET includes this time before the stall begins.
Result<std::unique_ptr<Vehicle>> connect(ConnectOptions options);
/// The same over an existing channel (tests, other transports). Ignores options.address.
Result<std::unique_ptr<Vehicle>> connect(std::unique_ptr<link::Channel> channel,
                                         ConnectOptions options);

/// One interaction as another program asks for it, for those that pass calls on. The vehicle of
/// `connect` stamps it.
Result<link::Reply> pass_on(Vehicle& vehicle, decltype(link::Request::body) body);

}  // namespace tether::client
