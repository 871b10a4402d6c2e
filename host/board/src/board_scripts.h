#pragma once

#include <string_view>

/// The scripts of this folder, as they are sent to a board.
namespace tether::board {

extern const std::string_view kBoardKeeper, kBoardSut, kTargetProbe;

}  // namespace tether::board
