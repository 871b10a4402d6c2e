#pragma once

#include <filesystem>
#include <string>

#include <tether/campaign/campaign_results.h>

/// Results as one HTML page that needs nothing beside it: no network, no scripts; plots and images
/// are inside. Equal results and records give equal pages.
namespace tether::report {

/// A campaign: a verdict for each scenario, the paper's table with ours beside, the optimism of the
/// unsynchronised test, every trial as a point, paths, timelines and camera frames of one seed, and
/// what the numbers rest on. Trials that are missing or failed are named on top.
/// @param folder of the campaign: the records are read from below it. A record that is missing or
///   damaged leaves out its plots, and the page says so.
/// @throws Error(kSetup) when gnuplot is missing or fails.
std::string campaign_page(const campaign::CampaignResults& results,
                          const std::filesystem::path& folder);

/// One run: its outcome and metrics, timelines, lag, path, camera frames, and what they rest on.
/// @param folder with result.json and record.mcap.
/// @throws Error(kBadFile) when there is no usable result; Error(kSetup) as above.
std::string run_page(const std::filesystem::path& folder);

/// The result of one run as a campaign of one trial: for the tables of report.h.
/// @throws Error(kBadFile) when there is no usable result.
campaign::CampaignResults read_run_results(const std::filesystem::path& folder);

}  // namespace tether::report
