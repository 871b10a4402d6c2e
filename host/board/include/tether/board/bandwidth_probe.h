#pragma once

#include <optional>

#include <tether/board/ssh_connection.h>

namespace tether::board {

/// What the way to a board is like.
struct Bandwidth {
  double round_trip_s = 0.0;   ///< median of many, of one byte
  double to_board_MB_s = 0.0;  ///< 10^6 bytes per second, the way that images go
};

/// Tries the way to the board as SSH takes it, encryption included; a run's own link is plain TCP
/// and no slower. None where the board does not answer.
std::optional<Bandwidth> probe_bandwidth(const SshConnection& connection);

}  // namespace tether::board
