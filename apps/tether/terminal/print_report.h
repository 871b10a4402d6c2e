#pragma once

#include <filesystem>

#include <tether/campaign/campaign_results.h>

namespace tether::app {

/// Prints the tables of a campaign in the paper's form, the folder, and next steps.
void print_campaign_summary(const campaign::CampaignResults& results,
                            const std::filesystem::path& folder);

}  // namespace tether::app
