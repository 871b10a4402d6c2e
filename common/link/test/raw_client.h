#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sys/socket.h>

#include <tether/link/channel.h>
#include <tether/link/codec.h>
#include <tether/link/socket.h>

namespace tether::link {

/// The frame of one message.
inline std::string frame_bytes(const Message& message) {
  Encoder encoder;
  const auto frame = encoder.encode(message);
  return {frame.begin(), frame.end()};
}

/// A peer that sends any bytes, whatever the protocol allows.
class RawClient {
 public:
  explicit RawClient(const Address& address)
      : socket_(open_tcp(address, std::chrono::seconds(10)).value()) {}

  /// The server may have hung up already.
  void write(const std::string& text) {
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    Transfer sent;
    for (std::size_t done = 0; done < bytes.size() && !sent.error; done += sent.bytes)
      sent = send_some(socket_.get(), {bytes, {}, {}}, done);
  }
  void write(const Message& message) { write(frame_bytes(message)); }

  bool has_input() { return wait_readable(socket_.get(), Duration(0)); }
  /// Everything up to the end of the stream, decoded as one frame.
  Result<Message> read_last_message() {
    std::vector<std::uint8_t> bytes;
    std::uint8_t chunk[4096];
    Transfer got;
    while (!got.ended && !got.error) {
      got = receive_some(socket_.get(), chunk);
      bytes.insert(bytes.end(), chunk, chunk + got.bytes);
    }
    return decode(bytes);
  }
  void close_half() { ::shutdown(socket_.get(), SHUT_WR); }
  void close() { socket_ = Descriptor(); }

 private:
  Descriptor socket_;
};

}  // namespace tether::link
