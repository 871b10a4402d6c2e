#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/report/verdict.h>
#include <tether/timing/change.h>
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

/// The table as JSON, with what was timed; and how it changed. Their members: docs/guide/timing.md.
std::string timing_json(const timing::Timing& timing);
std::string change_json(const timing::Timing& now, const timing::Timing& before,
                        const timing::Comparison& comparison, std::optional<double> limit);

/// How the stages changed, as JUnit's XML (see junit.h): a case for each stage, which fails if it
/// is slower than the limit allows. @param limit 0.2 for +20 %
std::string change_junit(const timing::Timing& now, const timing::Timing& before,
                         const timing::Comparison& comparison, double limit);

}  // namespace tether::report
