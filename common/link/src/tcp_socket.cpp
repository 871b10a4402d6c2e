#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include <netdb.h>
#include <sys/socket.h>

#include <tether/link/channel.h>
#include <tether/link/socket.h>

namespace tether::link {
namespace {

using SteadyClock = std::chrono::steady_clock;

Failure cannot_connect(const Address& address, Failure::Kind kind, const std::string& why) {
  return {kind, "cannot connect to " + to_string(address) + ": " + why};
}
Failure cannot_listen(const Address& address, const std::string& why) {
  return {Failure::Kind::kInvalid, "cannot listen on " + to_string(address) + ": " + why};
}

std::string reason(int error) {
  return std::system_category().message(error);
}

// ---- finding addresses --------------------------------------------------------------------------

using FoundAddresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

/// All addresses of a name. Fails with kInvalid and the system's reason.
Result<FoundAddresses> resolve(const Address& address) {
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_protocol = IPPROTO_TCP;
  const std::string port = std::to_string(address.port);
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(address.host.c_str(), port.c_str(), &wanted, &found);
  if (error != 0) return invalid(error == EAI_SYSTEM ? reason(errno) : ::gai_strerror(error));
  return FoundAddresses(found, &::freeaddrinfo);
}

Address in_numbers(const sockaddr_storage& address, socklen_t size) {
  char host[NI_MAXHOST] = "";
  char port[NI_MAXSERV] = "";
  ::getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host, sizeof host, port,
                sizeof port, NI_NUMERICHOST | NI_NUMERICSERV);
  return {host, static_cast<std::uint16_t>(std::strtoul(port, nullptr, 10))};
}

// ---- connecting ---------------------------------------------------------------------------------

/// What trying one address came to.
struct Attempt {
  Descriptor socket;  // connected, unless `error`
  int error = 0;      // of errno
  bool out_of_time = false;
};

Attempt failed(int error) {
  Attempt attempt;
  attempt.error = error;
  return attempt;
}

int outcome_of_connecting(int descriptor) {
  int error = 0;
  socklen_t size = sizeof error;
  return ::getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

Attempt try_address(const addrinfo& candidate, SteadyClock::time_point deadline) {
  const int type = candidate.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC;
  Attempt attempt{Descriptor(::socket(candidate.ai_family, type, candidate.ai_protocol))};
  if (!attempt.socket.is_open()) return failed(errno);
  const int descriptor = attempt.socket.get();
  if (::connect(descriptor, candidate.ai_addr, candidate.ai_addrlen) != 0) {
    // Interrupted or not, the connection is being made from here on.
    if (errno != EINPROGRESS && errno != EINTR) return failed(errno);
    attempt.out_of_time = !wait_writable(descriptor, deadline - SteadyClock::now());
    attempt.error = attempt.out_of_time ? ETIMEDOUT : outcome_of_connecting(descriptor);
  }
  set_blocking(descriptor, true);
  return attempt;
}

/// The first address that answers; else the last one's failure.
Attempt try_all(const addrinfo* candidate, SteadyClock::time_point deadline) {
  Attempt attempt = failed(EHOSTUNREACH);
  for (; candidate != nullptr; candidate = candidate->ai_next) {
    attempt = try_address(*candidate, deadline);
    if (attempt.error == 0 || attempt.out_of_time) break;
  }
  return attempt;
}

// ---- listening ----------------------------------------------------------------------------------

Attempt try_to_listen(const addrinfo& candidate) {
  const int type = candidate.ai_socktype | SOCK_CLOEXEC;
  Attempt attempt{Descriptor(::socket(candidate.ai_family, type, candidate.ai_protocol))};
  if (!attempt.socket.is_open()) return failed(errno);
  const int descriptor = attempt.socket.get();
  // A server that was ended a moment ago must not keep its port from the next one.
  const int yes = 1;
  ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(descriptor, candidate.ai_addr, candidate.ai_addrlen) != 0 ||
      ::listen(descriptor, SOMAXCONN) != 0) {
    return failed(errno);
  }
  return attempt;
}

}  // namespace

Result<Descriptor> listen_on_tcp(const Address& address) {
  const auto found = resolve(address);
  if (!found) return cannot_listen(address, found.failure().message);
  Attempt attempt = failed(EADDRNOTAVAIL);
  for (const addrinfo* a = found->get(); a != nullptr; a = a->ai_next) {
    attempt = try_to_listen(*a);
    if (attempt.error == 0) return std::move(attempt.socket);
  }
  return cannot_listen(address, reason(attempt.error));
}

Address local_address(int descriptor) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0) return {};
  return in_numbers(address, size);
}

Accepted accept_tcp(int listening) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  Accepted accepted;
  accepted.socket = Descriptor(::accept4(listening, reinterpret_cast<sockaddr*>(&address), &size,
                                         SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!accepted.socket.is_open()) {
    accepted.error = {errno, std::system_category()};
    return accepted;
  }
  tune(accepted.socket.get());
  accepted.remote = in_numbers(address, size);
  return accepted;
}

Result<Descriptor> open_tcp(const Address& address, Duration timeout) {
  const auto found = resolve(address);
  if (!found) return cannot_connect(address, Failure::Kind::kDisconnected, found.failure().message);
  const auto deadline = SteadyClock::now() + std::min(timeout, kLongestTimeout);
  Attempt attempt = try_all(found->get(), deadline);
  if (attempt.out_of_time) return cannot_connect(address, Failure::Kind::kTimeout, "timed out");
  if (attempt.error != 0)
    return cannot_connect(address, Failure::Kind::kDisconnected, reason(attempt.error));
  tune(attempt.socket.get());
  return std::move(attempt.socket);
}

}  // namespace tether::link
