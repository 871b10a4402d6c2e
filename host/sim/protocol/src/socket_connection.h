#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <tether/link/socket.h>
#include <tether/sim_protocol/connection.h>

namespace tether::sim::protocol {

/// A connection over a connected, blocking stream socket. Failures call the other end `peer`.
std::unique_ptr<Connection> make_connection(link::Descriptor socket, std::string peer);

/// A socket connected to the one at `path`. Fails with kDisconnected, kTimeout (so many wait there
/// already that it cannot even wait) or, where the path cannot be that of a socket, kInvalid;
/// without saying what of.
Result<link::Descriptor> open_unix(const std::filesystem::path& path, Duration timeout);
/// A socket that listens there, the owner's only. Fails with kInvalid; without saying what of.
Result<link::Descriptor> listen_on_unix(const std::filesystem::path& path);

}  // namespace tether::sim::protocol
