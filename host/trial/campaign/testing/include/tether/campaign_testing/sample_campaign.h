#pragma once

#include <cstdint>
#include <string>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/campaign/result.h>
#include <tether/scenario/campaign.h>

namespace tether::campaign {

/// Three conditions as in the paper's Section V, two metrics, seeds 1 to 3; files are in `scratch`.
scenario::Campaign make_campaign(const ScratchFolder& scratch);

/// A trial that ran well.
TrialResult make_trial(const scenario::Scenario& scenario, const std::string& condition,
                       std::uint64_t seed, double oscillations, double time_required_s);

}  // namespace tether::campaign
