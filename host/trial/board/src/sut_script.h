#pragma once

#include <string>

#include <tether/board/board.h>

namespace tether::board {

/// A line of a shell script that assigns a variable.
std::string assign(const std::string& name, const std::string& value);

/// The variables and functions that board_sut.sh expects: the SUT, its environment, and its
/// command.
std::string sut_prologue(const BoardSut& sut);

}  // namespace tether::board
