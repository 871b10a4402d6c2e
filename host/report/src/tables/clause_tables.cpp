#include "tables/report_format.h"

#include <algorithm>

#include <fmt/format.h>

#include <tether/campaign/campaign_results.h>
#include <tether/report/report.h>
#include <tether/report/verdict.h>
#include <tether/stats/sample_statistics.h>

// The clauses of missions: of a run, and over the trials of a campaign.
namespace tether::report {
namespace {

std::string seconds_text(const std::optional<SimTime>& time) {
  return time ? decimals(to_seconds(*time)) : kNone;
}

std::string margin_text(const judge::ClauseVerdict& clause) {
  return clause.margin ? fmt::format("{} {}", decimals(*clause.margin), clause.unit) : kNone;
}

std::vector<std::string> row_of(const judge::ClauseVerdict& clause,
                                const campaign::ConditionResults& condition) {
  std::size_t n = 0, met = 0;
  std::vector<double> margins;
  for (const campaign::TrialResult* trial : campaign::distinct_flights(condition.trials)) {
    for (const judge::ClauseVerdict& own : trial->clauses) {
      if (own.uav != clause.uav || own.name != clause.name) continue;
      ++n;
      met += own.met ? 1U : 0U;
      if (own.margin) margins.push_back(*own.margin);
    }
  }
  std::vector<std::string> row = {clause.name, condition.condition, fmt::format("{} of {}", met, n),
                                  n > 0 ? interval(exact_interval(met, n)) : kNone, clause.unit};
  if (margins.empty()) {
    row.insert(row.end(), 5, kNone);
    return row;
  }
  const campaign::Summary s = campaign::summarise(margins);
  row.insert(row.end(), {decimals(s.mean), interval(s.ci95), decimals(s.min), decimals(s.median),
                         decimals(s.max)});
  return row;
}

/// The quantiles of all trials, sorted.
std::vector<double> quantiles_of(const judge::ClauseVerdict& clause,
                                 const campaign::ConditionResults& condition) {
  std::vector<double> all;
  for (const campaign::TrialResult& trial : condition.trials)
    for (const judge::ClauseVerdict& own : trial.clauses)
      if (own.uav == clause.uav && own.name == clause.name)
        all.insert(all.end(), own.quantiles.begin(), own.quantiles.end());
  std::ranges::sort(all);
  return all;
}

}  // namespace

std::vector<judge::ClauseVerdict> clauses_of(const campaign::ScenarioResults& scenario) {
  std::vector<judge::ClauseVerdict> all;
  for (const auto& condition : scenario.conditions)
    for (const campaign::TrialResult& trial : condition.trials)
      for (const judge::ClauseVerdict& clause : trial.clauses) {
        const auto known = std::ranges::find_if(all, [&](const auto& other) {
          return other.uav == clause.uav && other.name == clause.name;
        });
        if (known == all.end())
          all.push_back(clause);
        else if (!known->limit)  // that trial failed
          known->limit = clause.limit;
      }
  return all;
}

Table clauses_table(const campaign::TrialResult& trial) {
  Table table;
  table.title = "Clauses of the mission";
  table.text_columns = 2;
  table.headings = {single_headings(
      {"Clause", "Verdict", "Margin", "From (s)", "To (s)", "Deadline (s)", "Decided (s)"})};
  const bool has_failed = trial.outcome == campaign::Outcome::kFailed;  // for one reason for all
  for (const judge::ClauseVerdict& clause : trial.clauses) {
    table.rows.push_back({clause.name,
                          has_failed   ? "not evaluated"
                          : clause.met ? "met"
                                       : "missed",
                          margin_text(clause), seconds_text(clause.from), seconds_text(clause.to),
                          seconds_text(clause.deadline), seconds_text(clause.decided_at)});
    if (!has_failed && !clause.limited_by.empty())
      table.notes.push_back(fmt::format("{}: {}.", clause.name, clause.limited_by));
  }
  return table;
}

Table clauses_table(const campaign::ScenarioResults& scenario) {
  Table table;
  table.title = fmt::format("Clauses of the missions of {}", scenario.scenario);
  table.text_columns = 2;
  table.headings = {
      single_headings({"Clause", "Condition", "Met", "95 % interval of the share",
                       "Unit of the margin", "Mean", "95 % interval", "Min", "Median", "Max"})};
  for (const judge::ClauseVerdict& clause : clauses_of(scenario))
    for (const auto& condition : scenario.conditions)
      table.rows.push_back(row_of(clause, condition));
  table.notes = {
      "Interval of the share: exact (Clopper and Pearson). Interval of the mean margin: Student's "
      "t. A "
      "negative margin is by how much a clause was missed."};
  return table;
}

Table times_table(const campaign::ScenarioResults& scenario) {
  Table table;
  table.title = fmt::format("Reaction times and loops of {}", scenario.scenario);
  table.text_columns = 3;
  table.headings = {
      single_headings({"Clause", "Condition", "Unit", "Limit", "Median", "95 %", "Worst"})};
  for (const judge::ClauseVerdict& clause : clauses_of(scenario))
    for (const auto& condition : scenario.conditions) {
      const std::vector<double> all = quantiles_of(clause, condition);
      if (all.empty()) continue;
      table.rows.push_back({clause.name, condition.condition, clause.unit, decimals(clause.limit),
                            decimals(stats::quantile(all, 0.5)),
                            decimals(stats::quantile(all, 0.95)), decimals(all.back())});
    }
  return table;
}

}  // namespace tether::report
