#include "socket_channel.h"

#include <memory>
#include <utility>

#include <tether/link/channel.h>
#include <tether/link/socket.h>

namespace tether::link {

Result<std::unique_ptr<Channel>> connect_tcp(const Address& address, Duration timeout) {
  auto socket = open_tcp(address, timeout);
  if (!socket) {
    const Failure& failure = socket.failure();
    return Failure{failure.kind, failure.message + " (is the coordinator running there?)"};
  }
  return make_socket_channel(std::move(*socket), to_string(address));
}

}  // namespace tether::link
