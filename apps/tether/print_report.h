#pragma once

#include <filesystem>

namespace tether::app {

/// A campaign's tables in the paper's form, where its records lie, and what to look at next; to
/// stdout.
/// @throws Error(kBadFile) when the folder holds no campaign.
void print_campaign_summary(const std::filesystem::path& folder);

}  // namespace tether::app
