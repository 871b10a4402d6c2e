#include "port.h"

#include "real.h"
#include "serial.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>

#include <arpa/inet.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

// PX4's: the companion's port and the ground station's, and where the flight controller sends from.
constexpr std::uint16_t kCompanions[] = {14540, 14550};
constexpr std::uint16_t kControllers[] = {14580, 18570};
constexpr std::uint16_t kController = kControllers[0];
// Where they take TCP connections: ArduPilot's port, and those of above.
constexpr std::uint16_t kStreams[] = {5760, 14540, 14550, 14580, 18570};
constexpr std::uint16_t kUnbound = 1;  // ours, but not bound by the program
constexpr std::uint16_t kCopy = 2;     // another descriptor of one that is ours
constexpr std::uint16_t kSerial = 3;   // no socket
constexpr std::uint16_t kStream = 4;   // of TCP

void set_port(sockaddr* address, std::uint16_t port) {
  if (address->sa_family == AF_INET)
    reinterpret_cast<sockaddr_in*>(address)->sin_port = htons(port);
  if (address->sa_family == AF_INET6)
    reinterpret_cast<sockaddr_in6*>(address)->sin6_port = htons(port);
}

}  // namespace

std::uint16_t port_of(const sockaddr* address, socklen_t size) {
  if (address == nullptr) return 0;
  if (address->sa_family == AF_INET && size >= sizeof(sockaddr_in))
    return ntohs(reinterpret_cast<const sockaddr_in*>(address)->sin_port);
  if (address->sa_family == AF_INET6 && size >= sizeof(sockaddr_in6))
    return ntohs(reinterpret_cast<const sockaddr_in6*>(address)->sin6_port);
  return 0;
}

Port::Port() {
  own_.sin_family = AF_INET;
  own_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  sender_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  socklen_t size = sizeof own_;
  if (sender_ < 0 ||
      TETHER_REAL(bind)(sender_, reinterpret_cast<const sockaddr*>(&own_), size) != 0 ||
      TETHER_REAL(getsockname)(sender_, reinterpret_cast<sockaddr*>(&own_), &size) != 0)
    own_.sin_port = 0;
}

bool Port::is_companion(const sockaddr* address, socklen_t size) {
  return std::ranges::count(kCompanions, port_of(address, size)) > 0;
}

bool Port::is_controller(const sockaddr* address, socklen_t size) {
  return std::ranges::count(kControllers, port_of(address, size)) > 0;
}

bool Port::is_controllers_stream(const sockaddr* address, socklen_t size) {
  return std::ranges::count(kStreams, port_of(address, size)) > 0;
}

bool Port::is_ours(int socket) const {
  return socket >= 0 && static_cast<std::size_t>(socket) < kSockets &&
         bound_[static_cast<std::size_t>(socket)].load() != 0;
}

int Port::bind(int socket, const sockaddr* address, socklen_t size) {
  sockaddr_storage any{};
  std::memcpy(&any, address, std::min<std::size_t>(size, sizeof any));
  const std::uint16_t believed = port_of(address, size);
  auto* const really = reinterpret_cast<sockaddr*>(&any);
  set_port(really, 0);
  const int result = TETHER_REAL(bind)(socket, really, size);
  if (result != 0 || static_cast<std::size_t>(socket) >= kSockets) return result;
  if (bound_[static_cast<std::size_t>(socket)].exchange(believed) == 0) ++count_;
  return 0;
}

void Port::adopt(int socket) {
  if (socket < 0 || static_cast<std::size_t>(socket) >= kSockets) return;
  std::uint16_t none = 0;
  if (bound_[static_cast<std::size_t>(socket)].compare_exchange_strong(none, kUnbound)) ++count_;
}

void Port::forget(int socket) {
  if (socket < 0 || static_cast<std::size_t>(socket) >= kSockets) return;
  const std::uint16_t bound = bound_[static_cast<std::size_t>(socket)].exchange(0);
  if (bound != 0) --count_;
  if (bound != kSerial && bound != kStream) return;
  const std::lock_guard lock(lines_mutex_);
  const int other = lines_.extract(socket).mapped().other;
  if (std::ranges::none_of(lines_, [other](const auto& l) { return l.second.other == other; }))
    TETHER_REAL(close)(other);
}

int Port::open_serial(Line to, int flags) {
  const SerialPort port = as_is::open_serial_port(flags);
  if (port.program < 0 || static_cast<std::size_t>(port.program) >= kSockets) {
    const int error = errno;
    for (const int end : {port.program, port.other})
      if (end >= 0) TETHER_REAL(close)(end);
    errno = error;
    return -1;
  }
  add_line(port.program, kSerial, {to, port.other});
  return port.program;
}

void Port::add_line(int fd, std::uint16_t kind, const OpenLine& line) {
  const std::lock_guard lock(lines_mutex_);
  lines_[fd] = line;
  if (bound_[static_cast<std::size_t>(fd)].exchange(kind) == 0) ++count_;
}

// Over the loopback a connection is there at once, also if the program does not wait for it.
int Port::connect_stream(int socket, const sockaddr* address, socklen_t size) {
  sockaddr_in here = own_;
  here.sin_port = 0;
  socklen_t size_of_here = sizeof here;
  auto* const listens_at = reinterpret_cast<sockaddr*>(&here);
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  int result = -1;
  if (listener >= 0 && TETHER_REAL(bind)(listener, listens_at, size_of_here) == 0 &&
      ::listen(listener, 1) == 0 &&
      TETHER_REAL(getsockname)(listener, listens_at, &size_of_here) == 0)
    result = TETHER_REAL(connect)(socket, listens_at, size_of_here);
  const int error = errno;
  if ((result == 0 || error == EINPROGRESS) && static_cast<std::size_t>(socket) < kSockets) {
    const int other = ::accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    add_line(socket, kStream, {Line::kController, other, port_of(address, size)});
  }
  if (listener >= 0) TETHER_REAL(close)(listener);
  errno = error;
  return result;
}

bool Port::is_serial(int fd) const {
  return is_ours(fd) && bound_[static_cast<std::size_t>(fd)].load() == kSerial;
}

bool Port::is_line(int fd) const {
  return is_serial(fd) || (is_ours(fd) && bound_[static_cast<std::size_t>(fd)].load() == kStream);
}

bool Port::is_of_receiver(int fd) const {
  const std::lock_guard lock(lines_mutex_);
  const auto line = lines_.find(fd);
  return line != lines_.end() && line->second.to == Line::kReceiver;
}

bool Port::has_receiver() const {
  if (!is_any()) return false;
  const std::lock_guard lock(lines_mutex_);
  return std::ranges::any_of(lines_, [](const auto& l) { return l.second.to == Line::kReceiver; });
}

// It has one queue, so what is delivered to the first one is there for both.
void Port::copy(int socket, int copy) {
  if (!is_ours(socket) || copy < 0 || static_cast<std::size_t>(copy) >= kSockets) return;
  if (!is_line(socket)) {
    if (bound_[static_cast<std::size_t>(copy)].exchange(kCopy) == 0) ++count_;
    return;
  }
  const OpenLine line = [&] {
    const std::lock_guard lock(lines_mutex_);
    return lines_[socket];
  }();
  add_line(copy, bound_[static_cast<std::size_t>(socket)], line);
}

bool Port::believed(int socket, sockaddr* address, socklen_t* size) const {
  if (!is_ours(socket)) return false;
  const std::uint16_t port = bound_[static_cast<std::size_t>(socket)].load();
  if (port <= kStream) return false;
  if (TETHER_REAL(getsockname)(socket, address, size) == 0) set_port(address, port);
  return true;
}

// A socket that is not bound yet has no address to send to; the kernel gives it one.
void Port::deliver(std::span<const std::uint8_t> bytes) {
  for (std::size_t socket = 0; socket < kSockets; ++socket) {
    const std::uint16_t bound = bound_[socket].load();
    if (bound == 0 || (bound != kUnbound && bound <= kStream)) continue;
    sockaddr_storage to{};
    socklen_t size = sizeof to;
    auto* const address = reinterpret_cast<sockaddr*>(&to);
    if (TETHER_REAL(getsockname)(static_cast<int>(socket), address, &size) != 0) continue;
    sockaddr_in target = own_;
    target.sin_port = htons(port_of(address, size));
    if (target.sin_port == 0) continue;
    TETHER_REAL(sendto)
    (sender_, bytes.data(), bytes.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&target),
     sizeof target);
  }
  write_to_lines(Line::kController, bytes);
}

// What finds no room is lost, as on a line.
void Port::write_to_lines(Line to, std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(lines_mutex_);
  std::set<int> others;
  for (const auto& [fd, line] : lines_)
    if (line.to == to && others.insert(line.other).second)
      if (TETHER_REAL(send)(line.other, bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0 &&
          errno == ENOTSOCK)
        static_cast<void>(TETHER_REAL(write)(line.other, bytes.data(), bytes.size()));
}

void Port::believe(sockaddr* address, const socklen_t* size) const {
  if (address == nullptr || size == nullptr) return;
  if (port_of(address, *size) == ntohs(own_.sin_port)) set_port(address, kController);
}

void Port::believe_peer(int socket, sockaddr* address, const socklen_t* size) const {
  believe(address, size);
  const std::lock_guard lock(lines_mutex_);
  const auto line = lines_.find(socket);
  if (line != lines_.end() && line->second.peer != 0) set_port(address, line->second.peer);
}

}  // namespace tether::as_is
