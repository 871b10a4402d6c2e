#pragma once

#include <string>

#include <tether/record/reader.h>

namespace tether::report {

/// A drawing (inline SVG) of a board that several SUTs share: a lane for each core over ST, filled
/// with the SUTs that compute, each with its share of the cores; the first part of a long run.
/// Cores with pinned SUTs come first. Empty if no SUT of the board has computed.
std::string board_lanes(const record::Record& record, const record::BoardInfo& board);

}  // namespace tether::report
