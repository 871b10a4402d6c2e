#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/campaign/statistics.h>
#include <tether/report/table.h>

/// Results of a campaign as tables. Pure functions.
namespace tether::report {

/// In the paper's form: a row per condition, with mean and standard deviation of each metric. If
/// the scenario names a table of the paper, its values are beside ours. The notes give the number
/// of trials, each trial that is excluded from a mean with the reason, and unexpected events in
/// trials.
Table paper_form_table(const campaign::ScenarioResults& scenario);

/// A row per metric and condition: n, mean, 95 % interval, standard deviation, median, range.
Table details_table(const campaign::ScenarioResults& scenario);

/// Difference of two conditions in one metric. @pre both have at least one value.
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

/// The optimism of an unsynchronised test: for each metric, the mean under the barrier minus the
/// mean in free running, for conditions with the same clock, factor, target and profiles. For
/// metrics of which less is better, a positive difference means that the unsynchronised test is too
/// optimistic.
std::vector<Comparison> optimism(const campaign::ScenarioResults& scenario);
Table optimism_table(const campaign::ScenarioResults& scenario);

/// Setup and checks: settings and versions, machines, clocks, seeds, audit verdicts, causality
/// violations.
Table basis_table(const campaign::CampaignResults& results);

/// One row per trial and metric, with full precision and the trial's notes: for programs.
Table trials_table(const campaign::CampaignResults& results);
/// One row per condition and metric, with full precision, the paper's values and the number of
/// trials that have notes: for programs.
Table summaries_table(const campaign::CampaignResults& results);

/// The metrics of a run with their limits, and its notes.
Table run_table(const campaign::TrialResult& trial);

/// The clauses of the missions of a run, with what limited each; no rows if there are none.
Table clauses_table(const campaign::TrialResult& trial);
/// The clauses of a scenario, by UAV and name, in the order in which trials first have them.
std::vector<judge::ClauseVerdict> clauses_of(const campaign::ScenarioResults& scenario);
/// A row per clause and condition: trials that met it, and their margins; no rows if there are
/// none.
Table clauses_table(const campaign::ScenarioResults& scenario);
/// A row per clause on commands or reads, such as reaction times, and condition: quantiles over all
/// its trials; no rows if there are none.
Table times_table(const campaign::ScenarioResults& scenario);

/// What the flight of a trial took from the batteries, by task and cause. No rows: no energy.
Table energy_table(const campaign::TrialResult& trial);
/// The same of a scenario, means by condition. No rows: no energy.
Table energy_table(const campaign::ScenarioResults& scenario);

/// All tables for people, in reading order.
std::vector<Table> report_tables(const campaign::CampaignResults& results);

}  // namespace tether::report
