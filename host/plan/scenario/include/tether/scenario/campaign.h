#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tether/scenario/scenario.h>

namespace tether::scenario {

/// One scenario of a campaign with the conditions to run it under.
struct CampaignScenario {
  Scenario scenario;
  std::vector<std::string> conditions;  ///< names, in the table's order; each exists in `scenario`
  /// The paper's table with which these results are compared: "I" to "V"; empty: none.
  std::string paper_table;
  /// Overrides the scenario's sensors (already part of `scenario`); absolute; empty: none.
  std::filesystem::path profile{};
  /// Of a point of a sweep, whose values are the scenario's settings: the name of the scenario
  /// without them. Empty: the campaign has no sweep.
  std::string swept_from{};
};

/// A campaign file (TOML): scenarios × points of the sweep × conditions × seeds.
struct Campaign {
  std::filesystem::path file;  ///< absolute
  std::string name;            ///< letters, digits, '_', '-', '.'
  std::string description;
  std::vector<std::uint64_t> seeds;         ///< one trial each per condition; unique, not empty
  bool images_of_first_seed = false;        ///< its trials record their images, for the report
  std::vector<CampaignScenario> scenarios;  ///< not empty; their names are unique
};

/// Reads and checks a campaign and every scenario that it names.
/// @throws Error(kBadFile) as `load_scenario`.
Campaign load_campaign(const std::filesystem::path& file);

/// A campaign of one scenario, with the seeds 1 to `trials`.
/// @param conditions names; empty: all of the scenario
/// @throws Error(kUsage), as pick_condition, if it has no such condition, or if one is given twice.
Campaign campaign_of(Scenario scenario, const std::vector<std::string>& conditions,
                     std::size_t trials);

}  // namespace tether::scenario
