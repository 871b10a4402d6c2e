#pragma once

#include <tether/board/ssh_connection.h>
#include <tether/record/messages.h>

/// What a machine tells of itself: the same script (src/target_probe.sh) here and on a board.
namespace tether::board {

enum class ProbeDepth {
  kBrief,  ///< what may change from run to run; some milliseconds
  kFull,   ///< all of it; somewhat more than a second
};

/// Empty where the machine's shell does not answer within some seconds.
record::Readings probe_here(ProbeDepth depth);
/// The same of a board; empty also where the connection is gone.
record::Readings probe_board(const SshConnection& connection, ProbeDepth depth);

}  // namespace tether::board
