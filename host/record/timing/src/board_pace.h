#pragma once

#include <span>
#include <vector>

#include <tether/timing/pace.h>

namespace tether::timing {

/// Of each computer of a fleet, in the record's order; empty if there are not several.
/// @param paces of each SUT of the record, in its order.
std::vector<BoardPace> board_paces(const record::Record& record, std::span<const Pace> paces);

}  // namespace tether::timing
