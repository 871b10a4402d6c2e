
#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <tether/link/socket.h>

namespace tether::link {
namespace {

void set_option(int descriptor, int level, int option, int value) {
  ::setsockopt(descriptor, level, option, &value, sizeof value);
}

Transfer outcome(ssize_t result) {
  Transfer transfer;
  if (result >= 0) {
    transfer.bytes = static_cast<std::size_t>(result);
  } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
    transfer.would_block = true;
  } else {
    transfer.error = {errno, std::system_category()};
  }
  return transfer;
}

/// Waits for one of the poll events, or an end. False: not within `timeout`.
bool wait_for(int descriptor, short events, Duration timeout) {
  using std::chrono::steady_clock;
  const auto deadline = steady_clock::now() + timeout;
  pollfd entry{descriptor, events, 0};
  while (true) {
    const Duration left = deadline - steady_clock::now();
    const std::int64_t ns = left.count() > 0 ? left.count() : 0;
    const timespec wait{ns / 1'000'000'000, ns % 1'000'000'000};
    const int ready = ::ppoll(&entry, 1, &wait, nullptr);
    if (ready > 0) return true;
    if (ready == 0) return false;
    if (errno != EINTR) return true;  // the next call on the socket will tell what is wrong
  }
}

}  // namespace

Descriptor::~Descriptor() {
  if (is_open()) ::close(value_);
}

void tune(int descriptor) {
  set_option(descriptor, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(descriptor, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_option(descriptor, IPPROTO_TCP, TCP_KEEPIDLE, 10);
  set_option(descriptor, IPPROTO_TCP, TCP_KEEPINTVL, 5);
  set_option(descriptor, IPPROTO_TCP, TCP_KEEPCNT, 4);
  // Child processes (the SUT that `tether run` starts) must not hold our connections open.
  ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

void set_blocking(int descriptor, bool blocks) {
  const int flags = ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK;
  ::fcntl(descriptor, F_SETFL, blocks ? flags : flags | O_NONBLOCK);
}

void limit_sending(int descriptor, Duration limit) {
  const std::int64_t us = std::max<std::int64_t>(limit.count() / 1000, 1);
  const timeval wait{us / 1'000'000, us % 1'000'000};
  ::setsockopt(descriptor, SOL_SOCKET, SO_SNDTIMEO, &wait, sizeof wait);
}

Transfer send_some(int descriptor, const FramePieces& pieces, std::size_t done) {
  std::array<iovec, 3> parts{};
  std::size_t count = 0;
  for (std::span<const std::uint8_t> piece : {pieces.head, pieces.image, pieces.tail}) {
    const std::size_t skipped = done < piece.size() ? done : piece.size();
    done -= skipped;
    if (skipped == piece.size()) continue;
    // iovec serves reading too and so points to non-const.
    parts[count++] = {const_cast<std::uint8_t*>(piece.data() + skipped), piece.size() - skipped};
  }
  msghdr message{};
  message.msg_iov = parts.data();
  message.msg_iovlen = count;
  return outcome(uninterrupted([&] { return ::sendmsg(descriptor, &message, MSG_NOSIGNAL); }));
}

Transfer receive_some(int descriptor, std::span<std::uint8_t> space, bool whole) {
  const int flags = whole ? MSG_WAITALL : 0;
  Transfer transfer =
      outcome(uninterrupted([&] { return ::recv(descriptor, space.data(), space.size(), flags); }));
  transfer.ended = transfer.bytes == 0 && !transfer.would_block && !transfer.error;
  return transfer;
}

bool may_look_out() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  return ::sched_getaffinity(0, sizeof cores, &cores) == 0 && CPU_COUNT(&cores) > 1;
}

bool wait_readable(int descriptor, Duration timeout) {
  return wait_for(descriptor, POLLIN, timeout);
}

bool wait_writable(int descriptor, Duration timeout) {
  return wait_for(descriptor, POLLOUT, timeout);
}

Failure lost(const std::string& peer, const std::error_code& error) {
  return {Failure::Kind::kDisconnected,
          "the connection to " + peer + " was lost: " + error.message()};
}

}  // namespace tether::link
