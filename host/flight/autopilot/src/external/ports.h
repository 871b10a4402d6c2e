#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <tether/autopilot/flight_controller.h>
#include <tether/base/time.h>
#include <tether/os/file_descriptor.h>

/// Where a flight controller that runs as a process of its own connects to, on this machine. All
/// calls return at once, unless they say otherwise. Not thread-safe.
namespace tether::autopilot {

class UdpPort {
 public:
  /// Binds this port, for what `user` needs; 0: any that is free.
  /// @throws Error(kSetup) if it is in use
  UdpPort(std::uint16_t number, std::string_view user);
  std::uint16_t number() const { return number_; }

  /// The datagrams that have arrived, but no more than so many.
  std::vector<Bytes> receive(std::size_t most = std::numeric_limits<std::size_t>::max());
  /// To `peer`, or, if that is 0, to whoever sent the first datagram.
  void set_peer(std::uint16_t peer) { peer_ = peer; }
  void send(std::span<const std::uint8_t> bytes);
  /// Waits for more, at most so long.
  void wait(Duration limit) const;

 private:
  std::uint16_t number_, peer_ = 0;
  os::FileDescriptor socket_;
};

/// Takes one connection.
class TcpPort {
 public:
  /// @throws Error(kSetup) as above
  TcpPort(std::uint16_t number, std::string_view user);
  std::uint16_t number() const { return number_; }

  /// Takes the connection, if it is there.
  bool accept();
  /// What has arrived over it.
  std::vector<std::uint8_t> receive();
  /// @throws Error(kLinkLost) if the controller has closed it
  void send(std::span<const std::uint8_t> bytes);
  /// Waits for more, at most so long.
  void wait(Duration limit) const;

 private:
  std::uint16_t number_;
  os::FileDescriptor listener_, stream_;
};

}  // namespace tether::autopilot
