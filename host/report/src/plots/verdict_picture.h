#pragma once

#include <string>
#include <vector>

#include <tether/report/verdict.h>

namespace tether::report {

/// Two drawings (inline SVG) with a row for each condition: its flights; and, if it is known, the
/// computing time per image by stage beside the camera's period. Empty if no flight has a result.
std::string verdict_picture(const std::vector<std::vector<Verdict>>& groups);
/// Whether the second one has anything to draw.
bool has_bars(const std::vector<std::vector<Verdict>>& groups);

}  // namespace tether::report
