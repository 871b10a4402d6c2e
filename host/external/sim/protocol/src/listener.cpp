#include "socket_connection.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/link/socket.h>
#include <tether/sim_protocol/connection.h>

namespace tether::sim::protocol {
namespace {

using link::Descriptor;

class SocketListener final : public Listener {
 public:
  SocketListener(Descriptor socket, Descriptor closed, Endpoint endpoint)
      : socket_(std::move(socket)), closed_(std::move(closed)), endpoint_(std::move(endpoint)) {
    // accept must not block if a host closes its connection between poll and accept.
    link::set_blocking(socket_.get(), false);
  }
  ~SocketListener() override {
    if (const auto* path = std::get_if<std::filesystem::path>(&endpoint_)) {
      ::unlink(path->c_str());
    }
  }

  Result<std::unique_ptr<Connection>> accept() override;
  Endpoint endpoint() const override { return endpoint_; }
  void close() override {
    const std::uint64_t one = 1;
    // Fails only if the counter is full, which wakes the reader as well.
    [[maybe_unused]] const auto written = ::write(closed_.get(), &one, sizeof one);
  }

 private:
  Failure failure(const std::string& why) const {
    return {Failure::Kind::kDisconnected, "listening on " + to_string(endpoint_) + ": " + why};
  }

  Descriptor socket_;
  Descriptor closed_;  // an eventfd
  Endpoint endpoint_;
};

Result<std::unique_ptr<Connection>> SocketListener::accept() {
  while (true) {
    std::array<pollfd, 2> entries{{{socket_.get(), POLLIN, 0}, {closed_.get(), POLLIN, 0}}};
    if (::poll(entries.data(), entries.size(), -1) < 0 && errno != EINTR) {
      return failure(std::system_category().message(errno));
    }
    if (entries[1].revents != 0) return failure("closed");
    if (entries[0].revents == 0) continue;
    Descriptor socket(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (socket.is_open()) {
      link::tune(socket.get());
      return make_connection(std::move(socket), "the host");
    }
    if (errno != EAGAIN && errno != ECONNABORTED && errno != EINTR) {
      return failure(std::system_category().message(errno));
    }
  }
}

Failure cannot_listen(const Endpoint& endpoint, const std::string& why) {
  return {Failure::Kind::kInvalid, "cannot listen on " + to_string(endpoint) + ": " + why};
}

}  // namespace

Result<std::unique_ptr<Listener>> listen(const Endpoint& endpoint) {
  Descriptor closed(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!closed.is_open()) return cannot_listen(endpoint, std::system_category().message(errno));
  Endpoint bound = endpoint;
  const auto* path = std::get_if<std::filesystem::path>(&endpoint);
  auto socket = path ? listen_on_unix(*path) : link::listen_on_tcp(std::get<link::Address>(bound));
  if (!socket && path) return cannot_listen(endpoint, socket.failure().message);
  if (!socket) return socket.failure();
  if (!path) std::get<link::Address>(bound).port = link::local_address(socket->get()).port;
  return std::unique_ptr<Listener>(
      std::make_unique<SocketListener>(std::move(*socket), std::move(closed), std::move(bound)));
}

}  // namespace tether::sim::protocol
