#pragma once

#include <optional>

#include <tether/board/ssh_connection.h>
#include <tether/record/messages.h>

/// Reads the state of a machine, with the same script (src/target_probe.sh) here and on a board.
namespace tether::board {

enum class ProbeDepth {
  kBrief,  ///< what can change from run to run; takes some milliseconds
  kFull,   ///< everything; takes more than a second
};

/// Of this machine; empty if its shell does not respond. @throws Error(kSetup) if it cannot be
/// started.
record::Readings probe_here(ProbeDepth depth);
/// Of a board; empty if its shell does not respond or the connection is lost.
record::Readings probe_board(const SshConnection& connection, ProbeDepth depth);

/// Round trip and bandwidth of the connection to a board.
struct Bandwidth {
  double round_trip_s = 0.0;   ///< median, of one byte
  double to_board_MB_s = 0.0;  ///< 10^6 bytes per second, in the direction of images
};

/// Measures the connection over SSH, with encryption. The TCP connection of a run is not slower.
/// None if the board does not respond.
std::optional<Bandwidth> probe_bandwidth(const SshConnection& connection);

}  // namespace tether::board
