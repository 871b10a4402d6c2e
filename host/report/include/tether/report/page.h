#pragma once

#include <filesystem>
#include <string>

#include <tether/campaign/campaign_results.h>

/// Results as one self-contained HTML page: plots and images are embedded, and there are no scripts
/// and no references to other files. Equal results and records give equal pages.
namespace tether::report {

/// A campaign: the answer for each scenario, what to do next, and a picture of both flights and
/// computing time; missing and failed trials; then for each scenario what was compared, where the
/// time goes, the paper's table with our results, the optimism of the unsynchronised test, a plot
/// of all trials, and paths, timelines and camera images of one seed; then setup and checks.
/// @param folder of the campaign, which contains the records. A record that is missing or damaged
///   has no plots; a damaged one is listed on the page.
/// @throws Error(kSetup) if gnuplot is missing or fails.
std::string campaign_page(const campaign::CampaignResults& results,
                          const std::filesystem::path& folder);

/// One run: answer, outcome, picture, metrics, timelines, lag, path, camera images, setup and
/// checks.
/// @param folder with result.json and record.mcap.
/// @throws Error(kBadFile) if there is no usable result; Error(kSetup) as above.
std::string run_page(const std::filesystem::path& folder);

/// The result of one run as a campaign of one trial: for the tables of report.h.
campaign::CampaignResults results_of_run(const campaign::TrialResult& trial);
/// … from the run's folder.
/// @throws Error(kBadFile) if there is no usable result.
campaign::CampaignResults read_run_results(const std::filesystem::path& folder);

}  // namespace tether::report
