#pragma once

#include <filesystem>
#include <string>

#include <tether/campaign/result.h>
#include <tether/report/verdict.h>

namespace tether::report {

/// What `tether run` prints of a run: the answer with its advice (verdict.h), the outcome, and a
/// line for each metric, clause, UAV and circumstance. @param folder of the run: its record is
/// named if it is there.
std::string run_text(const campaign::TrialResult& result, const std::filesystem::path& folder,
                     Markup markup = Markup::kPlain);

}  // namespace tether::report
