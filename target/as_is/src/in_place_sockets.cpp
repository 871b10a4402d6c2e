// Sockets of the flight controller's port in place of the C library's. Others are left alone.

#include "clocks.h"
#include "in_place.h"
#include "signals.h"

#include <cerrno>
#include <cstdarg>
#include <optional>
#include <span>
#include <vector>

#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <termios.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

/// The agent, if the socket is one of its port.
Agent* agent_of(int socket) {
  Agent* const agent = tether::as_is::agent();
  return agent != nullptr && agent->port().is_ours(socket) ? agent : nullptr;
}

/// As agent_of(), and of other sockets, whose timeout is that of the kernel otherwise.
Agent* reader_of(int socket) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || agent->port().is_ours(socket)) return agent;
  timeval limit{};
  socklen_t size = sizeof limit;
  const bool has_timeout = (agent->is_in_group() || agent->is_stopped()) &&
                           ::getsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, &size) == 0 &&
                           (limit.tv_sec > 0 || limit.tv_usec > 0);
  return has_timeout ? agent : nullptr;
}

constexpr Duration kTenthOfSecond = std::chrono::milliseconds(100);

/// How long a read of it waits; none: for ever.
std::optional<Duration> timeout_of(int socket, int flags) {
  if ((flags & MSG_DONTWAIT) != 0 || (::fcntl(socket, F_GETFL) & O_NONBLOCK) != 0)
    return Duration(0);
  // Of a terminal: VTIME, if it does not wait for a first byte.
  if (termios mode{}; ::tcgetattr(socket, &mode) == 0)
    return mode.c_cc[VMIN] > 0 ? std::nullopt : std::optional(mode.c_cc[VTIME] * kTenthOfSecond);
  timeval limit{};
  socklen_t size = sizeof limit;
  if (::getsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, &size) != 0) return std::nullopt;
  const Duration timeout =
      std::chrono::seconds(limit.tv_sec) + std::chrono::microseconds(limit.tv_usec);
  return timeout > Duration(0) ? std::optional(timeout) : std::nullopt;
}

/// `take()`: the real read, without waiting. −1 with EAGAIN: nothing is there.
template <class Take>
ssize_t read_when_ready(Agent& agent, int socket, int flags, Take take) {
  const int kept = errno;
  const Inside inside;
  agent.fire_timers();
  ssize_t result = take();
  const auto is_empty = [&] { return result < 0 && (errno == EAGAIN || errno == EWOULDBLOCK); };
  if (!is_empty()) return result;
  const auto timeout = timeout_of(socket, flags);
  if (timeout == Duration(0)) {
    if (agent.is_fed()) agent.take_arrived();
    return take();
  }
  bool is_timed_out = true;
  int error = 0;
  const auto deadline = timeout ? std::optional(agent.now() + *timeout) : std::nullopt;
  // After a handler, most go on to read.
  while (agent.wait(
             deadline,
             [&] {
               result = take();
               error = errno;
               is_timed_out = is_empty();
               return !is_timed_out;
             },
             [&](Duration slice, int wake) {
               pollfd fds[] = {{socket, POLLIN, 0}, {wake, POLLIN, 0}};
               const timespec time = to_timespec(slice);
               TETHER_REAL(ppoll)(fds, 2, &time, nullptr);
             }) == Agent::End::kHandler) {
    if (!timeout && Signals::restarts()) continue;
    error = EINTR;
    is_timed_out = false;
    break;
  }
  // After a wait, errno is that of anything.
  errno = result < 0 && is_timed_out ? EAGAIN : result < 0 ? error : kept;
  return result;
}

ssize_t read_serial(Agent& agent, int fd, void* bytes, std::size_t size) {
  const ssize_t got = read_when_ready(agent, fd, 0, [=]() -> ssize_t {
    pollfd ready{fd, POLLIN, 0};
    const timespec at_once{};
    if (TETHER_REAL(ppoll)(&ready, 1, &at_once, nullptr) == 1)
      return TETHER_REAL(read)(fd, bytes, size);
    errno = EAGAIN;
    return -1;
  });
  const bool is_timed_out = got < 0 && errno == EAGAIN && (::fcntl(fd, F_GETFL) & O_NONBLOCK) == 0;
  return is_timed_out ? 0 : got;
}

ssize_t send_bytes(Agent& agent, int socket, const void* bytes, std::size_t size) {
  const Inside inside;
  const std::span<const std::uint8_t> all(static_cast<const std::uint8_t*>(bytes), size);
  if (agent.port().is_of_receiver(socket))
    return static_cast<ssize_t>(size);  // settings, which it does not have
  if (agent.port().is_line(socket))
    agent.send_stream(socket, all);
  else
    agent.send(all);
  return static_cast<ssize_t>(size);
}

/// Whether a call may wait for another computer or program: then the caller is outside meanwhile.
bool is_outside(int socket) {
  // Of a group, nobody outside is known; of a program that is stopped, it does not matter.
  if (agent() == nullptr || agent()->is_in_group() || agent()->is_stopped()) return false;
  int family = 0;
  socklen_t size = sizeof family;
  return ::getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &family, &size) == 0 &&
         (family == AF_INET || family == AF_INET6);
}
template <class Call>
auto call_outside(int socket, Call call) {
  if (!is_outside(socket)) return call();
  const Threads::Outside outside;
  return call();
}

/// A connection to another computer is for what comes from there.
void tell_outside(int socket, const sockaddr* address) {
  Agent* const agent = tether::as_is::agent();
  int type = 0;
  socklen_t size = sizeof type;
  if (agent == nullptr || ::getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) != 0) return;
  const KeepErrno keep;
  const Inside inside;
  if (type == SOCK_STREAM) agent->tell_outside(address);
}

/// What is sent on a connection goes out at once: the kernel would hold small packets back by its
/// own clock, until those before have been acknowledged. @return socket
int send_at_once(int socket) {
  const Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !agent->is_in_group() || socket < 0) return socket;
  const KeepErrno keep;
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return socket;
}

/// A descriptor ends.
void forget(int fd) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !agent->is_here()) return;
  const Inside inside;
  const KeepErrno keep;
  agent->forget(fd);
}

/// There is another descriptor of the same.
int copied(int fd, int copy) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || copy < 0 || !agent->is_here()) return copy;
  const Inside inside;
  const KeepErrno keep;
  agent->copy(fd, copy);
  return copy;
}

int type_of(int socket) {
  int type = 0;
  socklen_t size = sizeof type;
  return ::getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) == 0 ? type : -1;
}

/// Whether a message to this address from this socket goes to the flight controller: then it is
/// ours from now on.
Agent* agent_for(int socket, const sockaddr* to, socklen_t size) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return nullptr;
  if (to == nullptr) return agent->port().is_ours(socket) ? agent : nullptr;
  if (!Port::is_controller(to, size) || type_of(socket) != SOCK_DGRAM) return nullptr;
  if (!agent->port().is_ours(socket)) {
    // Bound, so that messages can be sent to it.
    const Inside inside;
    sockaddr_in any{};
    any.sin_family = AF_INET;
    TETHER_REAL(bind)(socket, reinterpret_cast<const sockaddr*>(&any), sizeof any);
    agent->port().adopt(socket);
  }
  return agent;
}

}  // namespace
}  // namespace tether::as_is

using namespace tether::as_is;

TETHER_IN_PLACE int bind(int socket, const sockaddr* address, socklen_t size) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !Port::is_companion(address, size) || type_of(socket) != SOCK_DGRAM)
    return TETHER_REAL(bind)(socket, address, size);
  const Inside inside;
  return agent->port().bind(socket, address, size);
}

TETHER_IN_PLACE int connect(int socket, const sockaddr* address, socklen_t size) {
  if (Agent* const any = tether::as_is::agent();
      any && Port::is_controllers_stream(address, size) && type_of(socket) == SOCK_STREAM &&
      !any->port().is_ours(socket) && any->has_controller()) {
    const Inside inside;
    return any->port().connect_stream(socket, address, size);
  }
  Agent* const agent = agent_for(socket, address, size);
  if (agent == nullptr || address == nullptr) {
    tell_outside(socket, address);
    send_at_once(socket);
    return call_outside(socket, [&] { return TETHER_REAL(connect)(socket, address, size); });
  }
  const sockaddr_in& own = agent->port().own();
  return TETHER_REAL(connect)(socket, reinterpret_cast<const sockaddr*>(&own), sizeof own);
}

TETHER_IN_PLACE int accept(int socket, sockaddr* __restrict address, socklen_t* __restrict size) {
  return send_at_once(TETHER_REAL(accept)(socket, address, size));
}

TETHER_IN_PLACE int accept4(int socket, sockaddr* __restrict address, socklen_t* __restrict size,
                            int flags) {
  return send_at_once(TETHER_REAL(accept4)(socket, address, size, flags));
}

TETHER_IN_PLACE int getsockname(int socket, sockaddr* __restrict address,
                                socklen_t* __restrict size) {
  Agent* const agent = agent_of(socket);
  if (agent != nullptr && agent->port().believed(socket, address, size)) return 0;
  return TETHER_REAL(getsockname)(socket, address, size);
}

TETHER_IN_PLACE int getpeername(int socket, sockaddr* __restrict address,
                                socklen_t* __restrict size) {
  Agent* const agent = agent_of(socket);
  const int result = TETHER_REAL(getpeername)(socket, address, size);
  if (agent != nullptr && result == 0) agent->port().believe_peer(socket, address, size);
  return result;
}

TETHER_IN_PLACE int close(int fd) {
  forget(fd);
  return TETHER_REAL(close)(fd);
}

TETHER_IN_PLACE ssize_t recvfrom(int socket, void* __restrict bytes, size_t size, int flags,
                                 sockaddr* __restrict from, socklen_t* __restrict from_size) {
  Agent* const agent = reader_of(socket);
  if (agent == nullptr)
    return call_outside(
        socket, [&] { return TETHER_REAL(recvfrom)(socket, bytes, size, flags, from, from_size); });
  const ssize_t got = read_when_ready(*agent, socket, flags, [&] {
    return TETHER_REAL(recvfrom)(socket, bytes, size, flags | MSG_DONTWAIT, from, from_size);
  });
  if (got >= 0) agent->port().believe(from, from_size);
  return got;
}

TETHER_IN_PLACE ssize_t recv(int socket, void* bytes, size_t size, int flags) {
  return recvfrom(socket, bytes, size, flags, nullptr, nullptr);
}

TETHER_IN_PLACE ssize_t read(int fd, void* bytes, size_t size) {
  if (const Agent* const any = tether::as_is::agent(); any && any->is_camera(fd)) {
    errno = EINVAL;  // images are in buffers
    return -1;
  }
  if (Agent* const any = tether::as_is::agent(); any && any->timers().is_ours(fd))
    return read_when_ready(*any, fd, 0, [&] { return any->timers().take(fd, bytes, size); });
  Agent* const agent = reader_of(fd);
  if (agent == nullptr) return call_outside(fd, [&] { return TETHER_REAL(read)(fd, bytes, size); });
  if (agent->port().is_serial(fd)) return read_serial(*agent, fd, bytes, size);
  return recvfrom(fd, bytes, size, 0, nullptr, nullptr);
}

TETHER_IN_PLACE ssize_t recvmsg(int socket, msghdr* message, int flags) {
  Agent* const agent = reader_of(socket);
  if (agent == nullptr)
    return call_outside(socket, [&] { return TETHER_REAL(recvmsg)(socket, message, flags); });
  const ssize_t got = read_when_ready(*agent, socket, flags, [&] {
    return TETHER_REAL(recvmsg)(socket, message, flags | MSG_DONTWAIT);
  });
  if (got >= 0)
    agent->port().believe(static_cast<sockaddr*>(message->msg_name), &message->msg_namelen);
  return got;
}

// One message at a time, which the caller must expect.
TETHER_IN_PLACE int recvmmsg(int socket, mmsghdr* messages, unsigned count, int flags,
                             timespec* timeout) {
  if (agent_of(socket) == nullptr)
    return TETHER_REAL(recvmmsg)(socket, messages, count, flags, timeout);
  if (count == 0) return 0;
  const ssize_t got = recvmsg(socket, &messages[0].msg_hdr, flags & ~MSG_WAITFORONE);
  if (got < 0) return -1;
  messages[0].msg_len = static_cast<unsigned>(got);
  return 1;
}

TETHER_IN_PLACE int flock(int file, int operation) {
  const int now_or_never = TETHER_REAL(flock)(file, operation | LOCK_NB);
  Agent* const agent = tether::as_is::agent();
  if (now_or_never == 0 || errno != EWOULDBLOCK || (operation & LOCK_NB) != 0) return now_or_never;
  if (agent != nullptr && agent->is_in_group()) {
    const Inside inside;
    agent->tell_locked(file);
  }
  return TETHER_REAL(flock)(file, operation);
}

TETHER_IN_PLACE int dup(int fd) {
  return copied(fd, TETHER_REAL(dup)(fd));
}

TETHER_IN_PLACE int fcntl64(int fd, int command, ...) {
  va_list list;
  va_start(list, command);
  const long argument = va_arg(list, long);
  va_end(list);
  if (Agent* const agent = tether::as_is::agent();
      command == F_SETLKW && agent != nullptr && agent->is_in_group()) {
    const Inside inside;
    agent->tell_locked(fd);
  }
  const int result = TETHER_REAL(fcntl64)(fd, command, argument);
  return command == F_DUPFD || command == F_DUPFD_CLOEXEC ? copied(fd, result) : result;
}

TETHER_IN_PLACE int fcntl(int fd, int command, ...) {
  va_list list;
  va_start(list, command);
  const long argument = va_arg(list, long);
  va_end(list);
  return fcntl64(fd, command, argument);
}

TETHER_IN_PLACE int dup2(int fd, int copy) {
  if (copy == fd) return TETHER_REAL(dup2)(fd, copy);
  forget(copy);
  return copied(fd, TETHER_REAL(dup2)(fd, copy));
}

TETHER_IN_PLACE int dup3(int fd, int copy, int flags) {
  forget(copy);
  return copied(fd, TETHER_REAL(dup3)(fd, copy, flags));
}

TETHER_IN_PLACE ssize_t __recv_chk(int socket, void* bytes, size_t size, size_t, int flags) {
  return recv(socket, bytes, size, flags);
}

TETHER_IN_PLACE ssize_t __recvfrom_chk(int socket, void* bytes, size_t size, size_t, int flags,
                                       sockaddr* from, socklen_t* from_size) {
  return recvfrom(socket, bytes, size, flags, from, from_size);
}

TETHER_IN_PLACE ssize_t __read_chk(int fd, void* bytes, size_t size, size_t) {
  return read(fd, bytes, size);
}

TETHER_IN_PLACE ssize_t sendto(int socket, const void* bytes, size_t size, int flags,
                               const sockaddr* to, socklen_t to_size) {
  Agent* const agent = agent_for(socket, to, to_size);
  if (agent == nullptr) return TETHER_REAL(sendto)(socket, bytes, size, flags, to, to_size);
  return send_bytes(*agent, socket, bytes, size);
}

TETHER_IN_PLACE ssize_t send(int socket, const void* bytes, size_t size, int flags) {
  if (agent_of(socket) == nullptr) return TETHER_REAL(send)(socket, bytes, size, flags);
  return sendto(socket, bytes, size, flags, nullptr, 0);
}

TETHER_IN_PLACE ssize_t write(int fd, const void* bytes, size_t size) {
  if (agent_of(fd) == nullptr) return TETHER_REAL(write)(fd, bytes, size);
  return sendto(fd, bytes, size, 0, nullptr, 0);
}

TETHER_IN_PLACE ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  Agent* const agent =
      agent_for(socket, static_cast<const sockaddr*>(message->msg_name), message->msg_namelen);
  if (agent == nullptr) return TETHER_REAL(sendmsg)(socket, message, flags);
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
    const auto* begin = static_cast<const std::uint8_t*>(message->msg_iov[i].iov_base);
    bytes.insert(bytes.end(), begin, begin + message->msg_iov[i].iov_len);
  }
  return send_bytes(*agent, socket, bytes.data(), bytes.size());
}

TETHER_IN_PLACE int sendmmsg(int socket, mmsghdr* messages, unsigned count, int flags) {
  for (unsigned i = 0; i < count; ++i) {
    const ssize_t sent = sendmsg(socket, &messages[i].msg_hdr, flags);
    if (sent < 0) return i > 0 ? static_cast<int>(i) : -1;
    messages[i].msg_len = static_cast<unsigned>(sent);
  }
  return static_cast<int>(count);
}
