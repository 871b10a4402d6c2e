#include "serial.h"

#include "real.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string_view>

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

constexpr std::string_view kPorts[] = {"/dev/ttyACM0", "/dev/ttyUSB0", "/dev/ttyAMA0",
                                       "/dev/ttyS0",   "/dev/ttyTHS1", "/dev/serial0"};
constexpr std::string_view kReceiverPorts[] = {"/dev/ttyACM1", "/dev/ttyUSB1", "/dev/gps0"};
constexpr std::uint8_t kVersion1 = 0xFE, kVersion2 = 0xFD;
constexpr std::uint8_t kSigned = 1;  // a flag of version 2

bool is_begin(std::uint8_t byte) {
  return byte == kVersion1 || byte == kVersion2;
}

/// How long the frame is that begins there; 0: that is not known yet.
std::size_t frame_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 3) return 0;
  if (bytes[0] == kVersion1) return bytes[1] + std::size_t{8};
  return bytes[1] + std::size_t{12} + ((bytes[2] & kSigned) != 0 ? 13 : 0);
}

}  // namespace

bool is_serial_port(const char* path) {
  return path != nullptr && std::ranges::count(kPorts, std::string_view(path)) > 0;
}

bool is_receiver_port(const char* path) {
  return path != nullptr && std::ranges::count(kReceiverPorts, std::string_view(path)) > 0;
}

// Raw at first, so that it does not send back what it receives.
SerialPort open_serial_port(int flags) {
  SerialPort port;
  char name[64];
  port.other = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (port.other < 0 || ::grantpt(port.other) != 0 || ::unlockpt(port.other) != 0 ||
      ::ptsname_r(port.other, name, sizeof name) != 0)
    return port;
  port.program = TETHER_REAL(open)(name, flags | O_NOCTTY);
  termios mode{};
  if (port.program < 0 || ::tcgetattr(port.program, &mode) != 0) return port;
  ::cfmakeraw(&mode);
  ::cfsetspeed(&mode, B57600);
  ::tcsetattr(port.program, TCSANOW, &mode);
  return port;
}

void FrameStream::add(std::span<const std::uint8_t> bytes,
                      const std::function<void(std::span<const std::uint8_t> frame)>& on_frame) {
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
  std::span<const std::uint8_t> rest(waiting_);
  for (;;) {
    const auto begin = std::ranges::find_if(rest, is_begin);
    rest = rest.subspan(static_cast<std::size_t>(begin - rest.begin()));
    const std::size_t size = frame_bytes(rest);
    if (size == 0 || rest.size() < size) break;
    on_frame(rest.first(size));
    rest = rest.subspan(size);
  }
  waiting_.erase(waiting_.begin(), waiting_.end() - static_cast<std::ptrdiff_t>(rest.size()));
}

}  // namespace tether::as_is
