#pragma once

#include <string>
#include <vector>

#include <tether/timing/stage_table.h>
#include <tether/timing/timing.h>

namespace tether::report {

/// A page with the table of stages and a histogram of each.
std::string timing_page(const timing::Timing& timing);

/// The table in seconds, as CSV (RFC 4180).
std::string timing_csv(const std::vector<timing::StageRow>& rows);

}  // namespace tether::report
