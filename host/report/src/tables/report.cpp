#include "tables/paper_figures.h"
#include "tables/report_format.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <tether/report/report.h>

// The tables for people. A scenario has one in the paper's form with notes on each trial that is
// missing or special, one with all statistics, one that compares its conditions, and one on the
// optimism of the unsynchronised test. report_basis.cpp has the others.
namespace tether::report {
namespace {

struct Column {
  std::string name;
  std::string kind;
  std::string heading;  // label with unit
  bool in_paper = false;
};

std::vector<Column> columns_of(const campaign::ScenarioResults& scenario) {
  const PaperTable* paper = find_paper_table(scenario.paper_table);
  std::vector<Column> columns;
  for (const std::string& name : scenario.metrics) {
    const campaign::MetricValue* metric = scenario.find_metric(name);
    if (metric == nullptr) continue;
    const bool in_paper = paper != nullptr && paper->has_metric(metric->kind, name);
    columns.push_back({name, metric->kind, with_unit(metric->label, metric->unit), in_paper});
  }
  return columns;
}

// The paper's form.

void add_headings(Table& table, const std::vector<Column>& columns) {
  table.headings = {{{"", 1}}, {{"", 1}}, {{"SUT location", 1}}};
  for (const Column& column : columns) {
    table.headings[0].push_back({column.heading, column.in_paper ? 4u : 2u});
    table.headings[1].push_back({"measured", 2});
    if (column.in_paper) table.headings[1].push_back({"paper", 2});
    for (int i = 0; i < (column.in_paper ? 2 : 1); ++i) {
      table.headings[2].push_back({"mean", 1});
      table.headings[2].push_back({"std. dev.", 1});
    }
  }
}

void add_paper_cells(std::vector<std::string>& row, std::string_view condition,
                     const Column& column, const PaperTable& paper) {
  const PaperFigure* figure = paper.find(condition, column.kind, column.name);
  row.push_back(figure != nullptr ? exact(figure->mean) : kNone);
  row.push_back(figure != nullptr && figure->stddev ? exact(*figure->stddev) : kNone);
}

void add_cells(std::vector<std::string>& row, const campaign::ConditionResults& results,
               const Column& column, const PaperTable* paper) {
  const campaign::Summary summary = campaign::summarise(results.values(column.name));
  row.push_back(summary.n > 0 ? decimals(summary.mean) : kNone);
  row.push_back(decimals(summary.stddev));
  if (column.in_paper) add_paper_cells(row, results.condition, column, *paper);
}

// Conditions of the paper that the campaign does not have, such as real sensors.
void add_rows_of_paper_only(Table& table, const campaign::ScenarioResults& scenario,
                            const std::vector<Column>& columns, const PaperTable& paper) {
  if (std::ranges::none_of(columns, &Column::in_paper)) return;
  for (const std::string_view condition : paper.conditions()) {
    const bool is_flown = std::ranges::any_of(scenario.conditions, [&](const auto& results) {
      return without_clock(results.condition) == condition;
    });
    if (is_flown) continue;
    std::vector<std::string> row = {fmt::format("{} (paper only)", condition)};
    for (const Column& column : columns) {
      row.insert(row.end(), 2, kNone);
      if (column.in_paper) add_paper_cells(row, condition, column, paper);
    }
    table.rows.push_back(std::move(row));
  }
}

std::string trials_note(const campaign::ScenarioResults& scenario) {
  std::string note = "Trials:";
  const char* separator = "";
  for (const campaign::ConditionResults& results : scenario.conditions) {
    note += fmt::format("{} {} {} of {} ({} reached the goal)", separator, results.condition,
                        results.trials.size(), results.planned,
                        results.count(campaign::Outcome::kGoalReached));
    separator = ";";
  }
  return note + ". Times are simulated time.";
}

/// "seed 3", "6 trials, the first of seed 1"
std::string trials_text(const std::vector<std::uint64_t>& seeds) {
  if (seeds.size() == 1) return fmt::format("seed {}", seeds.front());
  return fmt::format("{} trials, the first of seed {}", seeds.size(), seeds.front());
}

// Why trials have no value: once per reason.
void add_missing_notes(Table& table, const campaign::ConditionResults& results,
                       const std::vector<Column>& columns) {
  std::vector<std::pair<std::string, std::vector<std::uint64_t>>> reasons;
  for (const campaign::TrialResult& trial : results.trials) {
    for (const Column& column : columns) {
      const campaign::MetricValue* metric = trial.find_metric(column.name);
      const bool has_value = metric != nullptr && metric->value;
      if (has_value) continue;
      const std::string why = metric != nullptr ? metric->missing_because : "not computed";
      const std::string& reason = trial.outcome == campaign::Outcome::kFailed ? trial.reason : why;
      auto known = std::ranges::find(reasons, reason, [](const auto& one) { return one.first; });
      if (known == reasons.end()) known = reasons.insert(known, {reason, {}});
      if (known->second.empty() || known->second.back() != trial.seed)
        known->second.push_back(trial.seed);
    }
  }
  for (const auto& [reason, seeds] : reasons)
    table.notes.push_back(fmt::format("Excluded from means: {}, {}: {}.", results.condition,
                                      trials_text(seeds), reason));
  if (results.trials.size() == results.planned) return;
  table.notes.push_back(
      fmt::format("No readable result for {} trials of {} (not run yet, or damaged).",
                  results.planned - results.trials.size(), results.condition));
}

void add_crash_notes(Table& table, const campaign::ConditionResults& results) {
  for (const campaign::TrialResult& trial : results.trials) {
    if (has_crash(trial))
      table.notes.push_back(
          fmt::format("Crash: {}, seed {}: {}.", results.condition, trial.seed, trial.reason));
  }
}

void add_second_attempt_notes(Table& table, const campaign::ConditionResults& results) {
  for (const campaign::TrialResult& trial : results.trials) {
    if (trial.this_run.attempts > 1)
      table.notes.push_back(fmt::format("Attempt {}: {}, seed {}. The first attempt failed: {}.",
                                        trial.this_run.attempts, results.condition, trial.seed,
                                        trial.this_run.first_failure));
  }
}

void add_target_notes(Table& table, const campaign::ConditionResults& results) {
  for (const campaign::TrialResult& trial : results.trials) {
    if (!trial.this_run.target) continue;
    for (const std::string& warning : trial.this_run.target->warnings)
      table.notes.push_back(
          fmt::format("{}, seed {}: {}.", results.condition, trial.seed, warning));
  }
}

// On a machine that is too busy, every trial can have notes. Only the first few are shown in full.
constexpr std::size_t kTrialsNotedInFull = 3;

void add_run_notes(Table& table, const campaign::ConditionResults& results) {
  std::size_t noted = 0;
  std::vector<std::uint64_t> others;
  for (const campaign::TrialResult& trial : results.trials) {
    if (trial.this_run.notes.empty()) continue;
    if (++noted > kTrialsNotedInFull)
      others.push_back(trial.seed);
    else
      table.notes.push_back(
          fmt::format("Note: {}, seed {}: {}.", results.condition, trial.seed, notes_of(trial)));
  }
  if (others.empty()) return;
  table.notes.push_back(fmt::format(
      "Notes on {}, seed{} {} ({} of {} trials have notes): see result.json.", results.condition,
      others.size() > 1 ? "s" : "", fmt::join(others, ", "), noted, results.trials.size()));
}

// Comparisons.

std::optional<Comparison> compare(const std::string& metric, const std::string& unit,
                                  const campaign::ConditionResults& a,
                                  const campaign::ConditionResults& b) {
  const std::vector<double> values_a = a.values(metric), values_b = b.values(metric);
  if (values_a.empty() || values_b.empty()) return std::nullopt;
  return Comparison{metric,
                    unit,
                    a.condition,
                    b.condition,
                    campaign::compare_means(values_a, values_b),
                    campaign::mann_whitney(values_a, values_b)};
}

template <class Wanted>
std::vector<Comparison> compare_where(const campaign::ScenarioResults& scenario,
                                      const Wanted& wanted) {
  std::vector<Comparison> comparisons;
  for (const std::string& name : scenario.metrics) {
    const campaign::MetricValue* metric = scenario.find_metric(name);
    if (metric == nullptr) continue;
    for (std::size_t i = 0; i < scenario.conditions.size(); ++i) {
      for (std::size_t j = 0; j < scenario.conditions.size(); ++j) {
        if (!wanted(i, j)) continue;
        const campaign::ConditionResults &a = scenario.conditions[i], &b = scenario.conditions[j];
        if (auto result = compare(name, metric->unit, a, b)) comparisons.push_back(*result);
      }
    }
  }
  return comparisons;
}

bool is_synchronised_twin(const campaign::ConditionResults& a,
                          const campaign::ConditionResults& b) {
  if (a.trials.empty() || b.trials.empty()) return false;
  const campaign::TrialResult &first_a = a.trials.front(), &first_b = b.trials.front();
  return first_a.policy == record::kConservativeBarrier && first_b.policy == record::kFreeRunning &&
         first_a.clock == first_b.clock && first_a.target == first_b.target &&
         first_a.profiles == first_b.profiles;
}

Table table_of(const campaign::ScenarioResults& scenario,
               const std::vector<Comparison>& comparisons) {
  Table table;
  table.text_columns = 2;
  table.headings = {
      single_headings({"Metric", "Conditions", "Difference of means", "95 % interval", "p"})};
  for (const Comparison& c : comparisons) {
    const campaign::MetricValue* metric = scenario.find_metric(c.metric);
    table.rows.push_back({with_unit(metric->label, c.unit), fmt::format("{} − {}", c.a, c.b),
                          decimals(c.means.difference), interval(c.means.ci95),
                          p_value(c.ranks.p_two_sided)});
  }
  const bool all_exact =
      std::ranges::all_of(comparisons, [](const Comparison& c) { return c.ranks.exact; });
  table.notes = {
      fmt::format("Interval of the difference: Welch's t. p: Mann-Whitney U, two-sided, {}.",
                  all_exact ? "exact" : "exact up to 100 trials, else approximate"),
      "p is not corrected for multiple comparisons."};
  return table;
}

}  // namespace

Table paper_form_table(const campaign::ScenarioResults& scenario) {
  const PaperTable* paper = find_paper_table(scenario.paper_table);
  const std::vector<Column> columns = columns_of(scenario);
  Table table;
  table.title = paper != nullptr ? fmt::format("Table {}: {}", paper->number, paper->title)
                                 : fmt::format("Scenario {}", scenario.scenario);
  add_headings(table, columns);
  for (const campaign::ConditionResults& results : scenario.conditions) {
    std::vector<std::string> row = {results.condition};
    for (const Column& column : columns) add_cells(row, results, column, paper);
    table.rows.push_back(std::move(row));
  }
  if (paper != nullptr) add_rows_of_paper_only(table, scenario, columns, *paper);
  table.notes.push_back(trials_note(scenario));
  if (paper != nullptr) table.notes.push_back(fmt::format("Paper: {}.", paper->source));
  for (const campaign::ConditionResults& results : scenario.conditions) {
    add_missing_notes(table, results, columns);
    add_crash_notes(table, results);
    add_second_attempt_notes(table, results);
    add_target_notes(table, results);
    add_run_notes(table, results);
  }
  return table;
}

Table details_table(const campaign::ScenarioResults& scenario) {
  Table table;
  table.title = fmt::format("Details of {}", scenario.scenario);
  table.text_columns = 2;
  table.headings = {single_headings(
      {"Metric", "Condition", "n", "Mean", "95 % interval", "Std. dev.", "Median", "Min", "Max"})};
  for (const Column& column : columns_of(scenario)) {
    for (const campaign::ConditionResults& results : scenario.conditions) {
      const campaign::Summary s = campaign::summarise(results.values(column.name));
      std::vector<std::string> row = {column.heading, results.condition, std::to_string(s.n)};
      if (s.n == 0) {
        row.resize(9, kNone);
      } else {
        row.insert(row.end(), {decimals(s.mean), interval(s.ci95), decimals(s.stddev),
                               decimals(s.median), decimals(s.min), decimals(s.max)});
      }
      table.rows.push_back(std::move(row));
    }
  }
  table.notes = {"Interval of the mean: Student's t."};
  return table;
}

std::vector<Comparison> compare_conditions(const campaign::ScenarioResults& scenario) {
  // Each pair once: the later minus the earlier condition.
  return compare_where(scenario, [](std::size_t a, std::size_t b) { return a > b; });
}

Table comparisons_table(const campaign::ScenarioResults& scenario) {
  Table table = table_of(scenario, compare_conditions(scenario));
  table.title = fmt::format("Differences between the conditions of {}", scenario.scenario);
  return table;
}

std::vector<Comparison> optimism(const campaign::ScenarioResults& scenario) {
  return compare_where(scenario, [&](std::size_t a, std::size_t b) {
    return is_synchronised_twin(scenario.conditions[a], scenario.conditions[b]);
  });
}

Table optimism_table(const campaign::ScenarioResults& scenario) {
  Table table = table_of(scenario, optimism(scenario));
  table.title = fmt::format("Optimism of the unsynchronised test of {}", scenario.scenario);
  table.notes.emplace_back(
      "Positive: the unsynchronised test reports a value that is better by this amount.");
  for (const Comparison& c : optimism(scenario)) {
    const campaign::MetricValue& metric = *scenario.find_metric(c.metric);
    if (metric.is_better_if_more())
      table.notes.push_back(
          fmt::format("{}: more is better, so negative values are better.", metric.label));
  }
  return table;
}

std::vector<Table> report_tables(const campaign::CampaignResults& results) {
  std::vector<Table> tables;
  for (const Sweep& sweep : sweeps_of(results)) {
    tables.push_back(sweep_table(sweep));
    if (Table tests = sweep_tests_table(sweep); !tests.rows.empty())
      tables.push_back(std::move(tests));
  }
  for (const campaign::ScenarioResults& scenario : results.scenarios) {
    tables.push_back(paper_form_table(scenario));
    tables.push_back(details_table(scenario));
    if (Table clauses = clauses_table(scenario); !clauses.rows.empty())
      tables.push_back(std::move(clauses));
    if (Table times = times_table(scenario); !times.rows.empty())
      tables.push_back(std::move(times));
    if (Table energy = energy_table(scenario); !energy.rows.empty())
      tables.push_back(std::move(energy));
    if (!compare_conditions(scenario).empty()) tables.push_back(comparisons_table(scenario));
    if (!optimism(scenario).empty()) tables.push_back(optimism_table(scenario));
  }
  tables.push_back(basis_table(results));
  return tables;
}

}  // namespace tether::report
