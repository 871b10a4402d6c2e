#pragma once

#include <string>

#include <tether/board/board.h>

namespace tether::board {

/// A line that gives a variable of a shell that value.
std::string assign(const std::string& name, const std::string& value);

/// What board_sut.sh is given: who the SUT is, what joins it to the run, and what runs it.
std::string sut_prologue(const BoardSut& sut);

}  // namespace tether::board
