#pragma once

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

}  // namespace tether::board
