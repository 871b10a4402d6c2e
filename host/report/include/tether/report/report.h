#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/campaign/statistics.h>
#include <tether/report/table.h>

/// What a campaign showed, as tables. Pure functions of the results.
namespace tether::report {

/// In the paper's form: a row per condition; mean and standard deviation per metric, the paper's
/// figures beside ours where the scenario names one of its tables. The notes say how many trials
/// each number rests on, name every trial that is missing from a mean, and why, and every trial in
/// which something happened that nobody meant to.
Table paper_form_table(const campaign::ScenarioResults& scenario);

/// A row per metric and condition: n, mean, 95 % interval, standard deviation, median, range.
Table details_table(const campaign::ScenarioResults& scenario);

/// How two conditions differ in one metric. @pre of both: at least one value each.
struct Comparison {
  std::string metric;
  std::string unit;
  std::string a;  ///< condition
  std::string b;
  campaign::MeanDifference means;  ///< a − b
  campaign::RankTest ranks;
};
/// Every pair of conditions in every metric.
std::vector<Comparison> compare_conditions(const campaign::ScenarioResults& scenario);
Table comparisons_table(const campaign::ScenarioResults& scenario);

/// The optimism of an unsynchronised test: per metric, the mean under the barrier minus the mean
/// in free running, for conditions that are alike in clock, factor, target and profiles. All of our
/// metrics are better when smaller, so a positive difference is what the unsynchronised test hides.
std::vector<Comparison> optimism(const campaign::ScenarioResults& scenario);
Table optimism_table(const campaign::ScenarioResults& scenario);

/// What the numbers rest on: settings and versions, machines, clocks, seeds, audit verdicts,
/// causality violations.
Table basis_table(const campaign::CampaignResults& results);

/// One row per trial and metric, full precision, the trial's notes last: for other programs.
Table trials_table(const campaign::CampaignResults& results);
/// One row per condition and metric, full precision, the paper's figures beside, and last how many
/// of the condition's trials have notes: for programs.
Table summaries_table(const campaign::CampaignResults& results);

/// One run's metrics, each with its limit; below it the run's notes.
Table run_table(const campaign::TrialResult& trial);

/// All tables for people, in reading order.
std::vector<Table> report_tables(const campaign::CampaignResults& results);

}  // namespace tether::report
