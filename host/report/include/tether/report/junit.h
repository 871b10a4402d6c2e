#pragma once

#include <filesystem>
#include <string>

#include <tether/campaign/campaign_results.h>
#include <tether/report/size_report.h>

namespace tether::report {

/// The results as JUnit's XML, as continuous integration reads it (schema of Apache Ant's JUnit
/// task): a suite for each scenario and condition; for each trial a case for its outcome, for each
/// metric and for each clause, with value or margin, limit and record. The property "verdict" of a
/// suite is the answer (verdict.h). A trial that failed, or has
/// no result, is an error; a missed goal, metric or clause is a failure.
/// @param folder of the run or the campaign.
std::string to_junit(const campaign::CampaignResults& results, const std::filesystem::path& folder);

/// The answer of `tether size`: one suite with a case for the answer, which fails if it is not as
/// sure as asked, and one for each board, which fails unless the board suffices. @param folder of
/// its flights.
std::string to_junit(const SizeAnswer& answer, const std::filesystem::path& folder);

/// A file with one error, for what ended before there was a result. `name`: of the suite.
std::string junit_of_error(const std::string& name, const std::string& message);

}  // namespace tether::report
