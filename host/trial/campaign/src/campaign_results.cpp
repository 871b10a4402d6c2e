#include <algorithm>

#include <fmt/format.h>

#include <tether/campaign/campaign_results.h>

namespace tether::campaign {
namespace {

ConditionResults read_condition(const std::filesystem::path& folder,
                                const CampaignManifest& manifest, const std::string& scenario,
                                const std::string& condition, std::vector<std::string>& damaged) {
  ConditionResults results{condition, {}, manifest.seeds.size()};
  for (const std::uint64_t seed : manifest.seeds) {
    const auto trial = folder / trial_folder(scenario, condition, seed);
    std::error_code ignored;
    if (!std::filesystem::exists(trial / kResultFile, ignored)) continue;
    try {
      TrialResult result = read_result(trial);
      // A folder that was moved here is no flight of this condition.
      if (result.condition != condition || result.seed != seed)
        damaged.push_back(fmt::format("{}: is of condition \"{}\", seed {}; it is not counted",
                                      (trial / kResultFile).string(), result.condition,
                                      result.seed));
      else if (result.end != kEndInterrupted)
        results.trials.push_back(std::move(result));
    } catch (const Error& error) {
      damaged.emplace_back(error.what());
    }
  }
  return results;
}

}  // namespace

std::vector<double> ConditionResults::values(std::string_view metric) const {
  std::vector<double> values;
  for (const TrialResult* trial : distinct_flights(trials)) {
    const MetricValue* found = trial->find_metric(metric);
    if (found != nullptr && found->value) values.push_back(*found->value);
  }
  return values;
}

std::size_t ConditionResults::count(Outcome outcome) const {
  return static_cast<std::size_t>(std::ranges::count(trials, outcome, &TrialResult::outcome));
}

const ConditionResults* ScenarioResults::find_condition(std::string_view condition) const {
  const auto found = std::ranges::find(conditions, condition, &ConditionResults::condition);
  return found == conditions.end() ? nullptr : &*found;
}

const MetricValue* ScenarioResults::find_metric(std::string_view metric) const {
  for (const ConditionResults& results : conditions) {
    for (const TrialResult& trial : results.trials) {
      if (const MetricValue* found = trial.find_metric(metric)) return found;
    }
  }
  return nullptr;
}

CampaignResults read_campaign_results(const std::filesystem::path& folder) {
  CampaignResults results;
  results.manifest = read_manifest(folder);
  for (const CampaignManifest::Entry& entry : results.manifest.scenarios) {
    ScenarioResults scenario{
        entry.scenario,   entry.description, entry.paper_table, entry.metrics, {},
        entry.swept_from, entry.settings};
    for (const std::string& condition : entry.conditions) {
      scenario.conditions.push_back(
          read_condition(folder, results.manifest, entry.scenario, condition, results.damaged));
    }
    results.scenarios.push_back(std::move(scenario));
  }
  return results;
}

}  // namespace tether::campaign
