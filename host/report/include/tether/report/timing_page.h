#pragma once

#include <string>
#include <vector>

#include <tether/report/verdict.h>
#include <tether/timing/stage_table.h>
#include <tether/timing/timing.h>

namespace tether::report {

/// The answer that timing gives: the stage with the most computing time.
Answer timing_answer(const std::vector<timing::StageRow>& rows);
/// What to do next.
std::vector<std::string> timing_advice(const timing::Timing& timing,
                                       const std::vector<timing::StageRow>& rows);

/// A page with the table of stages and a histogram of each, below the answer.
std::string timing_page(const timing::Timing& timing);

/// The table in seconds, as CSV (RFC 4180).
std::string timing_csv(const std::vector<timing::StageRow>& rows);

}  // namespace tether::report
