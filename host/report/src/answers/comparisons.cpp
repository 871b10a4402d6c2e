#include "answers/comparisons.h"

#include "tables/report_format.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tether/report/verdict.h>

// Numbers are rounded by the width of their confidence interval.
namespace tether::report {
namespace {

// Decimals that show the interval's half width with one digit, or two where the first is below 5.
int decimals_for(const campaign::MeanDifference& means) {
  const double scale = means.ci95 && means.ci95->high > means.ci95->low
                           ? 0.5 * (means.ci95->high - means.ci95->low)
                           : std::abs(means.difference) / 10.0;
  if (!(scale > 0.0)) return 1;
  const int exponent = static_cast<int>(std::floor(std::log10(scale)));
  const bool begins_low = scale < 5.0 * std::pow(10.0, exponent);
  return std::clamp(-exponent + (begins_low ? 1 : 0), 0, 6);
}

std::string number(double value, int places) {
  const std::string text = fmt::format("{:.{}f}", value, places);
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  if (is_zero && text.starts_with('-')) return text.substr(1);
  return text.starts_with('-') ? "−" + text.substr(1) : text;
}

std::string amount(double value, int places, const std::string& unit) {
  return number(value, places) + (unit == "1" ? "" : " " + unit);
}

std::string interval_text(const std::optional<campaign::Interval>& interval, int places,
                          bool negated) {
  if (!interval) return "too few trials for an interval";
  const double low = negated ? -interval->high : interval->low;
  const double high = negated ? -interval->low : interval->high;
  return fmt::format("95 % interval {} to {}", number(low, places), number(high, places));
}

bool contains_zero(const std::optional<campaign::Interval>& interval) {
  return interval && interval->low <= 0.0 && interval->high >= 0.0;
}

bool is_significant(const Comparison& comparison) {
  return comparison.ranks.p_two_sided < kSignificant && !contains_zero(comparison.means.ci95);
}

std::string difference_text(const Comparison& c, const std::string& label) {
  const int places = decimals_for(c.means);
  const bool smaller = c.means.difference < 0.0;
  return fmt::format("{} ({} by {}, {})", in_a_sentence(label), smaller ? "smaller" : "larger",
                     amount(std::abs(c.means.difference), places, c.unit),
                     interval_text(c.means.ci95, places, smaller));
}

void add_comparisons(std::vector<std::string>& sentences, const campaign::ScenarioResults& scenario,
                     const std::vector<Comparison>& comparisons, const std::string& first,
                     const std::string& other) {
  std::vector<std::string> differences, alike;
  for (const Comparison& c : comparisons) {
    const bool is_meant = c.a == other && c.b == first;
    if (!is_meant) continue;
    const std::string& label = scenario.find_metric(c.metric)->label;
    if (is_significant(c)) {
      differences.push_back(difference_text(c, label));
    } else {
      alike.push_back(in_a_sentence(label));
    }
  }
  if (!differences.empty())
    sentences.push_back(fmt::format("“{}” differs significantly from “{}” in {}.", other, first,
                                    joined_with_and(differences)));
  if (!alike.empty())
    sentences.push_back(fmt::format("“{}” does not differ significantly from “{}” in {}.", other,
                                    first, joined_with_and(alike)));
}

// Problems.

void add_trial_problems(std::vector<std::string>& lines, const std::string& where,
                        const campaign::TrialResult& trial) {
  const std::string which = fmt::format("{}, seed {}", where, trial.seed);
  if (trial.outcome == campaign::Outcome::kFailed) {
    lines.push_back(fmt::format("{}: failed, excluded from all means: {}", which, trial.reason));
    return;
  }
  if (has_crash(trial)) lines.push_back(fmt::format("{}: {}", which, trial.reason));
  for (const campaign::MetricValue& metric : trial.metrics) {
    // Of a missed task, there is nothing to measure.
    if (!metric.value &&
        (trial.outcome == campaign::Outcome::kGoalReached || !missed_without_value(trial).empty()))
      lines.push_back(fmt::format("{}: no value of {}: {}", which, in_a_sentence(metric.label),
                                  metric.missing_because));
  }
  if (trial.audit && !trial.audit->passed)
    lines.push_back(fmt::format("{}: audit: {}", which, trial.audit->summary));
  if (trial.sync.causality_violations > 0)
    lines.push_back(
        fmt::format("{}: {} causality violations", which, trial.sync.causality_violations));
  if (trial.this_run.target)
    for (const std::string& warning : trial.this_run.target->warnings)
      lines.push_back(fmt::format("{}: {}", which, warning));
  for (const std::string& note : trial.this_run.notes)
    lines.push_back(fmt::format("{}: {}", which, note));
}

void add_missing_seeds(std::vector<std::string>& lines, const std::string& where,
                       const std::vector<std::uint64_t>& seeds,
                       const campaign::ConditionResults& condition) {
  std::vector<std::string> missing;
  for (const std::uint64_t seed : seeds) {
    if (std::ranges::find(condition.trials, seed, &campaign::TrialResult::seed) ==
        condition.trials.end())
      missing.push_back(std::to_string(seed));
  }
  if (!missing.empty())
    lines.push_back(fmt::format("{}: no readable result for seed{} {} (not run yet, or damaged)",
                                where, missing.size() > 1 ? "s" : "", joined_with_and(missing)));
}

}  // namespace

std::vector<std::string> difference_sentences(const campaign::ScenarioResults& scenario) {
  std::vector<std::string> sentences;
  if (scenario.conditions.empty()) return sentences;
  const std::vector<Comparison> comparisons = compare_conditions(scenario);
  const std::string& first = scenario.conditions.front().condition;
  for (const campaign::ConditionResults& other : scenario.conditions)
    add_comparisons(sentences, scenario, comparisons, first, other.condition);
  return sentences;
}

std::string optimism_sentence(const Comparison& comparison, const campaign::MetricValue& metric) {
  const double hidden = comparison.means.difference;
  const int places = decimals_for(comparison.means);
  const bool smaller = hidden > 0.0;
  const bool better = smaller != metric.is_better_if_more();
  const std::string label = in_a_sentence(metric.label);
  if (hidden == 0.0 || contains_zero(comparison.means.ci95))
    return fmt::format(
        "Without synchronisation, “{}” does not differ significantly in {}: {} ({}).", comparison.a,
        label, amount(hidden, places, metric.unit),
        interval_text(comparison.means.ci95, places, false));
  const std::string size = amount(std::abs(hidden), places, metric.unit);
  const std::string range = interval_text(comparison.means.ci95, places, !smaller);
  const std::string start = fmt::format("Without synchronisation, “{}” appears ", comparison.a);
  if (metric.unit == "s" || metric.unit == "ms")
    return start + fmt::format("{} {} than it is ({}; {}).", size, better ? "faster" : "slower",
                               label, range);
  return start + fmt::format("{} than it is: {} {} by {} ({}).", better ? "better" : "worse", label,
                             smaller ? "smaller" : "larger", size, range);
}

std::vector<std::string> problems(const campaign::CampaignResults& results) {
  std::vector<std::string> lines;
  for (const campaign::ScenarioResults& scenario : results.scenarios) {
    for (const campaign::ConditionResults& condition : scenario.conditions) {
      const std::string where = fmt::format("{}, {}", scenario.scenario, condition.condition);
      for (const campaign::TrialResult& trial : condition.trials)
        add_trial_problems(lines, where, trial);
      add_missing_seeds(lines, where, results.manifest.seeds, condition);
    }
  }
  lines.insert(lines.end(), results.damaged.begin(), results.damaged.end());
  return lines;
}

}  // namespace tether::report
