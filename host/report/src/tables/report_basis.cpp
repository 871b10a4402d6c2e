#include "tables/paper_figures.h"
#include "tables/report_format.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <tether/report/report.h>

// The table of a campaign's setup and checks, collected over all trials by `Basis`; the table of
// one run; and the two tables for programs (CSV).
namespace tether::report {
namespace {

std::string joined(const std::set<std::string>& texts) {
  return texts.empty() ? kNone : fmt::format("{}", fmt::join(texts, "; "));
}

std::string seeds_text(const std::vector<std::uint64_t>& seeds) {
  if (seeds.empty()) return kNone;
  if (seeds.size() == 1) return std::to_string(seeds.front());
  const auto [first, last] = std::minmax_element(seeds.begin(), seeds.end());
  if (*last - *first + 1 == seeds.size()) return fmt::format("{} to {}", *first, *last);
  return fmt::format("{}", fmt::join(seeds, ", "));
}

template <class Visit>
void for_each_trial(const campaign::CampaignResults& results, const Visit& visit) {
  for (const campaign::ScenarioResults& scenario : results.scenarios) {
    for (const campaign::ConditionResults& condition : scenario.conditions) {
      for (const campaign::TrialResult& trial : condition.trials) visit(scenario, trial);
    }
  }
}

std::size_t noted_trials(const campaign::ConditionResults& condition) {
  return static_cast<std::size_t>(std::ranges::count_if(
      condition.trials, [](const auto& trial) { return !trial.this_run.notes.empty(); }));
}

std::string condition_text(const campaign::TrialResult& trial) {
  std::string text = fmt::format("{}: {}, {} clock", trial.condition, trial.policy,
                                 computer::name(trial.clock.kind));
  if (trial.clock.kind == computer::ClockKind::kCpu || trial.clock.is_scaled())
    text += fmt::format(" × {}", trial.clock.factor);
  if (trial.clock.computing > Duration{0})
    text += fmt::format(", {} ms per computing phase", 1e3 * to_seconds(trial.clock.computing));
  if (trial.real_time_factor > 0.0) {
    text += fmt::format(", real-time factor at most {}", trial.real_time_factor);
  }
  if (!trial.target.empty()) text += fmt::format(", target {}", trial.target);
  if (!trial.emulator.program.empty())
    text += fmt::format(", {} with CPU model {}", trial.emulator.program, trial.emulator.cpu_model);
  if (const std::string replay = campaign::describe_replay(trial); !replay.empty())
    text += ", time " + replay;
  for (const std::string& profile : trial.profiles) text += fmt::format(", profile {}", profile);
  return text;
}

// Seconds of ST per second of wall time, least and largest for each condition.
class Speeds {
 public:
  void add(const campaign::TrialResult& trial) {
    const double wall_s = to_seconds(trial.this_run.wall);
    if (wall_s <= 0.0) return;
    const double speed = to_seconds(trial.sync.st_at_end) / wall_s;
    const auto [it, is_new] = range_.try_emplace(trial.condition, speed, speed);
    it->second.first = std::min(it->second.first, speed);
    it->second.second = std::max(it->second.second, speed);
  }
  std::string text() const {
    std::string text;
    for (const auto& [condition, range] : range_) {
      text += fmt::format("{}{}: {:.2f}", text.empty() ? "" : "; ", condition, range.first);
      if (range.second > range.first) text += fmt::format(" to {:.2f}", range.second);
    }
    return text.empty() ? kNone : text;
  }

 private:
  std::map<std::string, std::pair<double, double>> range_;
};

struct Basis {
  Speeds speeds;
  std::size_t trials = 0, planned = 0;
  std::set<std::string> conditions, machines, suts;
  std::size_t audited = 0, passed = 0, synchronised = 0;
  std::uint64_t violations = 0, interactions = 0;
  std::optional<campaign::StopFigures> stops;

  void add(const campaign::TrialResult& trial) {
    conditions.insert(condition_text(trial));
    speeds.add(trial);
    ++trials;
    if (!trial.this_run.machine.empty()) machines.insert(trial.this_run.machine);
    for (const campaign::SutResult& sut : trial.suts) suts.insert(sut.sut);
    violations += trial.sync.causality_violations;
    interactions += trial.sync.interactions;
    if (trial.sync.stops) add(*trial.sync.stops);
    if (trial.policy == record::kConservativeBarrier) ++synchronised;
    if (!trial.audit) return;
    ++audited;
    if (trial.audit->passed) ++passed;
  }

  void add(const campaign::StopFigures& trial) {
    if (!stops) stops.emplace();
    stops->count += trial.count;
    stops->largest_overshoot = std::max(stops->largest_overshoot, trial.largest_overshoot);
  }
};

}  // namespace

Table basis_table(const campaign::CampaignResults& results) {
  Basis basis;
  for_each_trial(results, [&](const campaign::ScenarioResults&, const campaign::TrialResult& t) {
    basis.add(t);
  });
  for (const campaign::ScenarioResults& scenario : results.scenarios) {
    for (const auto& condition : scenario.conditions) basis.planned += condition.planned;
  }
  Table table;
  table.title = fmt::format("Setup and checks of {}", results.manifest.name);
  table.text_columns = 2;
  table.headings = {{{"", 1}, {"", 1}}};
  table.rows = {{"Machine", joined(basis.machines)},
                {"SUT", joined(basis.suts)},
                {"Seeds", seeds_text(results.manifest.seeds)},
                {"Trials", fmt::format("{} of {}", basis.trials, basis.planned)},
                {"Real-time factor achieved", basis.speeds.text()},
                {"Interactions", std::to_string(basis.interactions)},
                {"Causality violations", std::to_string(basis.violations)},
                {"Audits passed", fmt::format("{} of {} ({} synchronised trials)", basis.passed,
                                              basis.audited, basis.synchronised)}};
  if (basis.stops)
    table.rows.push_back(
        {"Stops of all threads", fmt::format("{}, largest overshoot {:.3f} ms", basis.stops->count,
                                             1e3 * to_seconds(basis.stops->largest_overshoot))});
  for (const std::string& text : basis.conditions) table.rows.push_back({"Condition", text});
  std::size_t files = 0;
  for (const auto& [name, value] : results.manifest.settings) {
    if (name.starts_with(campaign::kFileSetting))
      ++files;
    else if (name != "machine" && !name.starts_with("sut of "))  // above
      table.rows.push_back({name, value});
  }
  if (files > 0)
    table.rows.push_back(
        {"Files", fmt::format("{}; their digests are in {}", files, campaign::kCampaignFile)});
  table.notes = results.damaged;
  return table;
}

Table run_table(const campaign::TrialResult& trial) {
  Table table;
  table.title = fmt::format("{}, {}, seed {}: {}", trial.scenario, trial.condition, trial.seed,
                            name(trial.outcome));
  table.headings = {single_headings({"Metric", "Value", "Limit"})};
  for (const campaign::MetricValue& metric : trial.metrics) {
    table.rows.push_back(
        {with_unit(metric.label, metric.unit), decimals(metric.value),
         limit_text(metric) + (metric.value && !metric.is_met() ? ", missed" : "")});
    if (!metric.value)
      table.notes.push_back(
          fmt::format("{}: no value ({}).", metric.label, metric.missing_because));
  }
  if (!trial.reason.empty()) table.notes.push_back(trial.reason + ".");
  if (!trial.this_run.notes.empty())
    table.notes.push_back(fmt::format("Note: {}.", notes_of(trial)));
  return table;
}

Table trials_table(const campaign::CampaignResults& results) {
  Table table;
  table.headings = {single_headings(
      {"scenario", "condition", "seed", "outcome", "metric", "unit", "value", "reason", "notes"})};
  for_each_trial(
      results, [&](const campaign::ScenarioResults& scenario, const campaign::TrialResult& trial) {
        for (const campaign::MetricValue& metric : trial.metrics) {
          table.rows.push_back({scenario.scenario, trial.condition, std::to_string(trial.seed),
                                std::string(name(trial.outcome)), metric.name, metric.unit,
                                exact(metric.value), trial.reason, notes_of(trial)});
        }
      });
  return table;
}

Table summaries_table(const campaign::CampaignResults& results) {
  Table table;
  table.headings = {
      single_headings({"scenario", "condition", "metric", "unit", "planned", "n", "mean", "stddev",
                       "median", "ci95_low", "ci95_high", "paper_mean", "paper_stddev", "noted"})};
  for (const campaign::ScenarioResults& scenario : results.scenarios) {
    const PaperTable* paper = find_paper_table(scenario.paper_table);
    for (const std::string& name : scenario.metrics) {
      const campaign::MetricValue* metric = scenario.find_metric(name);
      if (metric == nullptr) continue;
      for (const campaign::ConditionResults& condition : scenario.conditions) {
        const campaign::Summary s = campaign::summarise(condition.values(name));
        const bool any = s.n > 0;
        const PaperFigure* figure =
            paper != nullptr ? paper->find(condition.condition, metric->kind, name) : nullptr;
        table.rows.push_back({scenario.scenario, condition.condition, name, metric->unit,
                              std::to_string(condition.planned), std::to_string(s.n),
                              any ? exact(s.mean) : "", exact(s.stddev), any ? exact(s.median) : "",
                              s.ci95 ? exact(s.ci95->low) : "", s.ci95 ? exact(s.ci95->high) : "",
                              figure != nullptr ? exact(figure->mean) : "",
                              figure != nullptr ? exact(figure->stddev) : "",
                              std::to_string(noted_trials(condition))});
      }
    }
  }
  return table;
}

}  // namespace tether::report
