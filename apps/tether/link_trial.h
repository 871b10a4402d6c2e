#pragma once

#include "ssh_connection.h"

#include <optional>

namespace tether::app {

/// What the way to a board is like.
struct LinkTrial {
  double round_trip_s = 0.0;   ///< median of many, of one byte
  double to_board_MB_s = 0.0;  ///< 10^6 bytes per second, the way that images go
};

/// Tries the way to the board as SSH takes it, encryption included; a run's own link is plain TCP
/// and no slower. None where the board does not answer.
std::optional<LinkTrial> try_link(const SshConnection& connection);

}  // namespace tether::app
