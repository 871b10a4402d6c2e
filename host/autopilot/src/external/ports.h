#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tether/autopilot/flight_controller.h>
#include <tether/base/time.h>
#include <tether/os/file_descriptor.h>

namespace tether::autopilot {

/// Where a flight controller that runs as a process of its own connects to, on this machine. All
/// calls return at once, unless they say otherwise. Not thread-safe.
class Ports {
 public:
  struct Numbers {
    std::uint16_t simulator = 4560;    ///< TCP: PX4 connects to it
    std::uint16_t companion = 14540;   ///< UDP: PX4 sends to it …
    std::uint16_t controller = 14580;  ///< … and listens here
    std::uint16_t ground = 18570;      ///< PX4 listens here, too
  };
  /// Binds the ports of that instance of PX4, which are the numbers above plus its own.
  /// @throws Error(kSetup) if one of them is in use
  explicit Ports(int instance);

  const Numbers& numbers() const { return numbers_; }

  /// Takes the connection, if it is there.
  bool accept();
  /// What has arrived from the controller over the connection.
  std::vector<std::uint8_t> receive_stream();
  /// @throws Error(kLinkLost) if the controller has closed it
  void send_stream(std::span<const std::uint8_t> bytes);

  /// The datagrams that the controller has sent.
  std::vector<Bytes> receive_datagrams();
  void send_datagram(std::span<const std::uint8_t> bytes);
  /// Waits for more from the controller, at most so long.
  void wait_for_datagram(Duration limit) const;
  void wait_for_stream(Duration limit) const;

 private:
  Numbers numbers_;
  os::FileDescriptor listener_, stream_, datagrams_;
};

}  // namespace tether::autopilot
