#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/result.h>
#include <tether/campaign/statistics.h>

/// All results of a campaign, from its folder alone.
namespace tether::campaign {

struct ConditionResults {
  std::string condition;
  std::vector<TrialResult> trials;  ///< those that have a result, in order of the seeds
  std::size_t planned = 0;          ///< trials in the campaign's plan

  /// The values of a metric over those distinct flights (copies.h) that have one.
  std::vector<double> values(std::string_view metric) const;
  std::size_t count(Outcome outcome) const;
};

struct ScenarioResults {
  std::string scenario;
  std::string description;
  std::string paper_table;  ///< empty: none
  std::vector<std::string> metrics;
  std::vector<ConditionResults> conditions;
  /// As in CampaignManifest::Entry.
  std::string swept_from{};
  std::vector<Setting> settings{};

  const ConditionResults* find_condition(std::string_view condition) const;
  /// Label, kind and unit of a metric, from any trial; nullptr if there is no trial.
  const MetricValue* find_metric(std::string_view metric) const;
};

struct CampaignResults {
  CampaignManifest manifest;
  std::vector<ScenarioResults> scenarios;
  std::vector<std::string> damaged;  ///< one line for each result that exists but is unreadable
};

/// @throws Error(kBadFile) if the folder contains no campaign.
CampaignResults read_campaign_results(const std::filesystem::path& folder);

}  // namespace tether::campaign
