#pragma once

#include <optional>

#include <tether/board/ssh_connection.h>

namespace tether::board {

/// Round trip and bandwidth of the connection to a board.
struct Bandwidth {
  double round_trip_s = 0.0;   ///< median, of one byte
  double to_board_MB_s = 0.0;  ///< 10^6 bytes per second, in the direction of images
};

/// Measures the connection over SSH, with encryption. The TCP connection of a run is not slower.
/// None if the board does not respond.
std::optional<Bandwidth> probe_bandwidth(const SshConnection& connection);

}  // namespace tether::board
