#pragma once

#include <memory>
#include <string>

#include <tether/link/channel.h>
#include <tether/link/socket.h>

namespace tether::link {

/// A channel over a connected, blocking stream socket of any family. Failures call the other end
/// `peer`.
std::unique_ptr<Channel> make_socket_channel(Descriptor socket, std::string peer);

}  // namespace tether::link
