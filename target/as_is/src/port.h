#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>

#include <netinet/in.h>
#include <sys/socket.h>

namespace tether::as_is {

/// That of an address; 0: it is of no network.
std::uint16_t port_of(const sockaddr* address, socklen_t size);

/// The flight controller's UDP ports, as the program's own sockets. A socket that the program binds
/// to the port of a companion, or sends from to that of a flight controller, is *ours*: what it
/// sends goes to the coordinator, and what the flight controller sends is really sent to it over
/// the loopback, so that the kernel has the queue and wakes who waits. Bound ports are others than
/// the program believes, so that programs of several runs can have the same. A serial port and a
/// TCP connection to a flight controller are *lines*: they carry bytes, whose other end is here.
///
/// Thread-safe.
class Port {
 public:
  Port();

  /// Whether this address is that of a companion, which programs bind, or of a flight controller.
  static bool is_companion(const sockaddr* address, socklen_t size);
  static bool is_controller(const sockaddr* address, socklen_t size);
  /// Whether it is one at which flight controllers take TCP connections.
  static bool is_controllers_stream(const sockaddr* address, socklen_t size);

  bool is_ours(int socket) const;
  bool is_any() const { return count_.load() > 0; }
  /// Binds a socket of the program to the port of a companion. As bind().
  int bind(int socket, const sockaddr* address, socklen_t size);
  /// The program sends from this socket to a flight controller, or has connected it.
  void adopt(int socket);
  void forget(int socket);
  /// A descriptor of the same socket, if that is ours.
  void copy(int socket, int copy);
  /// What a serial port leads to.
  enum class Line { kController, kReceiver };  // of satellite navigation
  /// Opens a serial port, as open(). It is ours, and no socket.
  int open_serial(Line to, int flags);
  bool is_serial(int fd) const;
  /// Connects a TCP socket of the program to the flight controller, as connect().
  int connect_stream(int socket, const sockaddr* address, socklen_t size);
  /// A serial port, or such a connection.
  bool is_line(int fd) const;
  bool is_of_receiver(int fd) const;
  /// Whether the program has a serial port of a receiver.
  bool has_receiver() const;

  /// The address that the program believes it has bound; false: it is not ours.
  bool believed(int socket, sockaddr* address, socklen_t* size) const;

  /// A message of the flight controller: to all our sockets.
  void deliver(std::span<const std::uint8_t> bytes);
  /// What a receiver says: to the serial ports that lead to it.
  void deliver_of_receiver(std::span<const std::uint8_t> bytes) {
    write_to_lines(Line::kReceiver, bytes);
  }
  /// If an address is that of the sender of `deliver`: replaces it by the flight controller's.
  void believe(sockaddr* address, const socklen_t* size) const;
  /// The address to which the program believes it has connected a socket of ours.
  void believe_peer(int socket, sockaddr* address, const socklen_t* size) const;
  /// Where to connect a socket in place of a flight controller.
  const sockaddr_in& own() const { return own_; }

 private:
  static constexpr std::size_t kSockets = 4096;
  /// 0: not ours.
  std::array<std::atomic<std::uint16_t>, kSockets> bound_{};  // by descriptor: the port believed
  std::atomic<int> count_ = 0;
  int sender_ = -1;
  sockaddr_in own_{};
  struct OpenLine {
    Line to;
    int other;               // its other end
    std::uint16_t peer = 0;  // of TCP: the port that the program believes it has connected to
  };
  void add_line(int fd, std::uint16_t kind, const OpenLine& line);
  void write_to_lines(Line to, std::span<const std::uint8_t> bytes);
  mutable std::mutex lines_mutex_;
  std::map<int, OpenLine> lines_;  // by descriptor
};

}  // namespace tether::as_is
