#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <tether/link/socket.h>
#include <tether/sim_protocol/connection.h>

namespace tether::sim::protocol {

/// A connection over a connected, blocking stream socket. `peer` names the other end in failures.
std::unique_ptr<Connection> make_connection(link::Descriptor socket, std::string peer);

/// A socket connected to the one at `path`. Fails with kDisconnected, kTimeout (the queue of
/// waiting connections is full) or, if the path cannot be that of a socket, kInvalid; the message
/// does not contain the path.
Result<link::Descriptor> open_unix(const std::filesystem::path& path, Duration timeout);
/// A socket that listens there, for its owner only. Fails with kInvalid; the message does not
/// contain the path.
Result<link::Descriptor> listen_on_unix(const std::filesystem::path& path);

}  // namespace tether::sim::protocol
