#pragma once

#include <span>
#include <vector>

#include <tether/report/verdict.h>

namespace tether::report {

/// The slowest one: by the cost of an image or, without images, by how long the others waited for
/// it. @pre not empty.
const BoardPace& slowest_of(std::span<const BoardPace> boards);

/// The boards of several flights of one fleet, in one: means, and how they spread. A flight without
/// boards does not count.
std::vector<BoardPace> over_flights(std::span<const std::vector<BoardPace>> flights);

}  // namespace tether::report
