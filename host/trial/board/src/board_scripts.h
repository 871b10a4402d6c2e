#pragma once

#include <string_view>

/// The scripts of this folder, which are sent to boards.
namespace tether::board {

extern const std::string_view kBoardKeeper, kBoardSut, kTargetProbe;

}  // namespace tether::board
