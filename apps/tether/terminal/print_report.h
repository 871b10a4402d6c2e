#pragma once

#include <filesystem>

namespace tether::app {

/// Prints the tables of a campaign in the paper's form, the folder, and next steps.
/// @throws Error(kBadFile) if there is no campaign in the folder.
void print_campaign_summary(const std::filesystem::path& folder);

}  // namespace tether::app
