#pragma once

#include <string_view>

/// The scripts of apps/tether/board, as they are sent to a board.
namespace tether::app {

extern const std::string_view kBoardKeeper, kBoardSut, kTargetProbe;

}  // namespace tether::app
