#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>

#include <tether/link/channel.h>
#include <tether/link/codec.h>

namespace tether::link {

/// A peer that says what it likes, whatever the protocol.
class RawClient {
 public:
  explicit RawClient(const Address& address) {
    socket_.connect({asio::ip::make_address(address.host), address.port});
  }

  void write(std::span<const std::uint8_t> bytes) {
    std::error_code ignored;  // the server may have hung up already
    asio::write(socket_, asio::buffer(bytes.data(), bytes.size()), ignored);
  }
  void write(const std::string& text) {
    write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  void write(const Message& message) { write(Encoder().encode(message)); }

  bool has_input() { return socket_.available() > 0; }
  /// Everything up to the end of the stream, decoded as one frame.
  Result<Message> read_last_message() {
    std::vector<std::uint8_t> bytes;
    std::error_code error;
    while (!error) {
      std::uint8_t chunk[4096];
      const std::size_t count = socket_.read_some(asio::buffer(chunk), error);
      bytes.insert(bytes.end(), chunk, chunk + count);
    }
    return decode(bytes);
  }
  void close_half() { socket_.shutdown(Tcp::socket::shutdown_send); }
  void close() { socket_.close(); }

 private:
  using Tcp = asio::ip::tcp;
  asio::io_context context_;
  Tcp::socket socket_{context_};
};

}  // namespace tether::link
