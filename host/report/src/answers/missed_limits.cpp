#include "tables/report_format.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include <tether/report/verdict.h>

// Which limits flights missed, and how.
namespace tether::report {
namespace {

/// "time required ≤ 5 s"
std::string limited(const campaign::MetricValue& metric) {
  const std::string label = in_a_sentence(metric.label);
  if (!metric.max && !metric.min) return label;
  return fmt::format("{} {}{}", label, metric.max ? "≤ " + exact(*metric.max) : limit_text(metric),
                     metric.unit == "1" ? "" : " " + metric.unit);
}

/// "hit 'room'", "uav2 hit 'room'": the hardest of all.
std::string crash_text(const campaign::TrialResult& trial) {
  const record::Contact* hardest = nullptr;
  for (const campaign::UavContacts& own : trial.contacts)
    if (own.hard > 0 && own.hardest && (!hardest || own.hardest->speed_m_s > hardest->speed_m_s))
      hardest = &*own.hardest;
  if (hardest == nullptr) return "";
  return fmt::format("{}hit '{}'", trial.suts.size() > 1 ? hardest->uav + " " : "", hardest->with);
}

/// Of several programs, those that it found at work: "uav2 was still flying".
std::string unfinished_text(const campaign::TrialResult& trial) {
  std::vector<std::string> uavs;
  for (const campaign::SutResult& sut : trial.suts)
    if (!sut.finished) uavs.push_back(sut.uav);
  if (trial.suts.size() < 2 || uavs.empty()) return "";
  return fmt::format("the program{} of {} had not ended", uavs.size() > 1 ? "s" : "",
                     joined_with_and(uavs));
}

/// What of the flight missed its limit. Empty: at most metrics without a value.
MissedLimits missed_in(const campaign::TrialResult& trial) {
  MissedLimits missed;
  const auto add = [&](std::string limit, const std::string& how = "") {
    missed.push_back({std::move(limit), 1, how});
  };
  // A UAV without a battery falls.
  if (trial.end == campaign::kEndBatteryEmpty ||
      std::ranges::any_of(trial.energy, &campaign::UavEnergy::is_empty))
    add("“battery not empty”");
  if (has_crash(trial)) add("“no crash”", crash_text(trial));
  if (trial.end == campaign::kEndTimeLimit) add("the time limit", unfinished_text(trial));
  // What ended the flight is why others could not be judged.
  const bool has_ended_it = trial.end == campaign::kEndKilled;
  const auto add_clauses = [&](bool judged) {
    for (const judge::ClauseVerdict& clause : trial.clauses)
      if (!clause.met && clause.margin.has_value() == judged) add(fmt::format("“{}”", clause.name));
  };
  add_clauses(true);
  if (!has_ended_it || missed.empty()) add_clauses(false);
  for (const campaign::MetricValue& metric : trial.metrics)
    if (metric.value && !metric.is_met()) add(limited(metric));
  // Of one that did not end, something else says how the flight ended.
  const bool is_all = missed.empty();
  for (const campaign::SutResult& sut : trial.suts)
    if (!sut.reached_goal && (sut.finished || is_all))
      add(trial.suts.size() > 1 ? fmt::format("the own goal of {}'s program", sut.uav)
                                : "the program's own goal",
          sut.outcome);
  return missed;
}

/// The metric without a value for which alone the flight missed its goal; nullptr: there is none.
const campaign::MetricValue* missed_for_no_value(const campaign::TrialResult& trial) {
  if (trial.outcome != campaign::Outcome::kGoalMissed || !missed_in(trial).empty()) return nullptr;
  const auto found = std::ranges::find_if_not(trial.metrics, &campaign::MetricValue::is_met);
  return found == trial.metrics.end() ? nullptr : &*found;
}

}  // namespace

std::string missed_without_value(const campaign::TrialResult& trial) {
  const campaign::MetricValue* const metric = missed_for_no_value(trial);
  return metric == nullptr ? ""
                           : fmt::format("{} has no value: {}", in_a_sentence(metric->label),
                                         metric->missing_because);
}

MissedLimits missed_limits(std::span<const campaign::TrialResult* const> trials) {
  MissedLimits all;
  for (const campaign::TrialResult* trial : trials) {
    if (trial->outcome != campaign::Outcome::kGoalMissed) continue;
    MissedLimits limits = missed_in(*trial);
    if (const campaign::MetricValue* const metric = missed_for_no_value(*trial))
      limits = {{fmt::format("{} (no value: {})", limited(*metric), metric->missing_because), 1}};
    for (MissedLimit& one : limits) {
      const auto known = std::ranges::find(all, one.limit, &MissedLimit::limit);
      if (known == all.end())
        all.push_back(std::move(one));
      else
        ++known->flights;
    }
  }
  std::ranges::stable_sort(all, std::greater<>{}, &MissedLimit::flights);
  return all;
}

}  // namespace tether::report
