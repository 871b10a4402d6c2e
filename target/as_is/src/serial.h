#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tether::as_is {

/// Whether a path is that of a serial port to which companions have a flight controller connected.
bool is_serial_port(const char* path);
/// Whether it is that of one to which they have a receiver of satellite navigation connected.
bool is_receiver_port(const char* path);
/// Opens such a port as a pseudo-terminal: the program's end, as open(), and the other one. What is
/// written to the other one can be read at the program's, as far as the kernel has room.
struct SerialPort {
  int program = -1;
  int other = -1;
};
SerialPort open_serial_port(int flags);

/// Divides a stream of bytes into MAVLink's frames, versions 1 and 2, as a line has no datagrams.
/// What is between frames is left out.
class FrameStream {
 public:
  void add(std::span<const std::uint8_t> bytes,
           const std::function<void(std::span<const std::uint8_t> frame)>& on_frame);

 private:
  std::vector<std::uint8_t> waiting_;  // begins with the first byte of a frame
};

}  // namespace tether::as_is
