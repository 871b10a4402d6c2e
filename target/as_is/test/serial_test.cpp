#include "serial.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <tether/base/random.h>

namespace tether::as_is {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes frame(std::uint8_t version, std::uint8_t payload, bool is_signed = false) {
  Bytes out{version, payload, static_cast<std::uint8_t>(is_signed ? 1 : 0)};
  out.resize(payload + (version == 0xFE ? 8U : is_signed ? 25U : 12U), 7);
  return out;
}

TEST(AsIsSerial, FramesAreWholeHoweverTheyAreWritten) {
  const std::vector<Bytes> sent{frame(0xFD, 9), frame(0xFE, 0), frame(0xFD, 200, true),
                                frame(0xFE, 255)};
  Bytes line;
  for (const Bytes& one : sent) {
    line.insert(line.end(), {1, 2, 3});  // noise
    line.insert(line.end(), one.begin(), one.end());
  }
  KeyedRandom random({.seed = 3});
  for (int i = 0; i < 100; ++i) {
    FrameStream stream;
    std::vector<Bytes> received;
    for (std::size_t at = 0; at < line.size();) {
      const std::size_t size = std::min<std::size_t>(1 + random.bits() % 50, line.size() - at);
      stream.add({line.data() + at, size},
                 [&](auto whole) { received.emplace_back(whole.begin(), whole.end()); });
      at += size;
    }
    ASSERT_EQ(received, sent);
  }
}

TEST(AsIsSerial, KnowsTheUsualPorts) {
  EXPECT_TRUE(is_serial_port("/dev/ttyACM0"));
  EXPECT_TRUE(is_serial_port("/dev/serial0"));
  EXPECT_FALSE(is_serial_port("/dev/tty"));
  EXPECT_FALSE(is_serial_port(nullptr));
  EXPECT_TRUE(is_receiver_port("/dev/ttyACM1"));
  EXPECT_FALSE(is_receiver_port("/dev/ttyACM0"));
}

TEST(AsIsSerial, APortIsATerminalThatCarriesBytesAsTheyAre) {
  const SerialPort port = open_serial_port(O_RDWR | O_NONBLOCK);
  ASSERT_GE(port.program, 0);
  EXPECT_TRUE(::isatty(port.program));
  termios mode{};
  ASSERT_EQ(::tcgetattr(port.program, &mode), 0);
  EXPECT_EQ(::cfsetspeed(&mode, B115200), 0);
  EXPECT_EQ(::tcsetattr(port.program, TCSANOW, &mode), 0);
  const std::string sent("\n\r\x03\x11\xfd", 5);
  ASSERT_EQ(::write(port.other, sent.data(), sent.size()), 5);
  pollfd fd{port.program, POLLIN, 0};
  ASSERT_EQ(::poll(&fd, 1, 1000), 1);
  char got[9];
  ASSERT_EQ(::read(port.program, got, sizeof got), 5);
  EXPECT_EQ(std::string(got, 5), sent);
  fd.fd = port.other;
  EXPECT_EQ(::poll(&fd, 1, 0), 0) << "no echo";
  ::close(port.program);
  ::close(port.other);
}

}  // namespace
}  // namespace tether::as_is
