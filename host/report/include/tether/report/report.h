#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/campaign/result.h>
#include <tether/report/plots.h>
#include <tether/report/table.h>
#include <tether/report/verdict.h>
#include <tether/timing/timing.h>

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

// Results as one self-contained HTML page: plots and images are embedded, and there are no scripts
// and no references to other files. Equal results and records give equal pages.

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

/// What `tether run` prints of a run: the answer with its advice (verdict.h), the outcome, and a
/// line for each metric, clause, UAV and circumstance. @param folder of the run: its record is
/// named if it is there.
std::string run_text(const campaign::TrialResult& result, const std::filesystem::path& folder,
                     Markup markup = Markup::kPlain);

// Campaigns with a sweep: the same scenario with other values of some keys. Pure functions.

/// The points of one scenario.
struct Sweep {
  std::string scenario;
  std::vector<const campaign::ScenarioResults*> points;  ///< in the order of the campaign file
};
/// One for each scenario that was swept. The results must outlive them.
std::vector<Sweep> sweeps_of(const campaign::CampaignResults& results);

/// A row per point and condition: the values, the share of trials that reach the goal with its
/// exact 95 % interval, and the mean of each metric with its 95 % interval.
Table sweep_table(const Sweep& sweep);

/// Whether the values of the plots' axis differ in how often the goal is reached: a row per pair of
/// values, for each series of the plots, with Fisher's exact test. No rows: there are no pairs.
Table sweep_tests_table(const Sweep& sweep);

/// The share of trials that reach the goal over the key with the most values, with a series
/// per condition and combination of the other values. None if no flight has a result.
std::optional<Plot> sweep_plot(const Sweep& sweep);
/// … or the mean of a metric, with the value of each trial.
std::optional<Plot> sweep_plot(const Sweep& sweep, const std::string& metric);

/// The answer that timing gives: the stage with the most computing time.
Answer timing_answer(const std::vector<timing::StageRow>& rows);
/// What to do next.
std::vector<std::string> timing_advice(const timing::Timing& timing,
                                       const std::vector<timing::StageRow>& rows);

/// A page with the table of stages and a histogram of each, below the answer.
std::string timing_page(const timing::Timing& timing);

/// The table in seconds, as CSV (RFC 4180).
std::string timing_csv(const std::vector<timing::StageRow>& rows);

/// The table as JSON, with what was timed; and how it changed. Their members: docs/guide/timing.md.
std::string timing_json(const timing::Timing& timing);
std::string change_json(const timing::Timing& now, const timing::Timing& before,
                        const timing::Comparison& comparison, std::optional<double> limit);

/// How the stages changed, as JUnit's XML (see junit.h): a case for each stage, which fails if it
/// is slower than the limit allows. @param limit 0.2 for +20 %
std::string change_junit(const timing::Timing& now, const timing::Timing& before,
                         const timing::Comparison& comparison, double limit);

}  // namespace tether::report
