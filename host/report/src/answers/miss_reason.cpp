#include "answers/miss_reason.h"

#include "answers/compared.h"
#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <vector>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/campaign/campaign_results.h>
#include <tether/energy/meter.h>
#include <tether/report/size_report.h>

// Speed is the reason of a missed goal only where the flights show it: a condition that differs in
// speed only is faster and reaches the goal, or computing alone takes longer than a limit on the
// program's reaction, which contains it. Other comparisons and some events show that it is probably
// not the reason. Otherwise it is not known.
namespace tether::report {
namespace {

using Evidence = MissReason::Evidence;

constexpr SimTime kBeforeAnyProgram{std::chrono::milliseconds(50)};
constexpr double kEmpty = 0.01;  // share of the battery's capacity

// What happened in a flight.

/// The clause on a task that the program never began, although all tasks before it reached their
/// goals, and nothing else was missed; nullptr: there is none.
const judge::ClauseVerdict* of_forgotten_task(const campaign::TrialResult& flight) {
  const auto has_failed = [](const judge::TaskSpan& task) { return task.status != "reached"; };
  const auto is_missed = [](const judge::ClauseVerdict& one) { return !one.met && one.margin; };
  const auto is_beyond = [](const campaign::MetricValue& one) {
    return one.value && !one.is_met();
  };
  if (flight.end != campaign::kEndFinished || std::ranges::any_of(flight.tasks, has_failed) ||
      std::ranges::any_of(flight.clauses, is_missed) ||
      std::ranges::any_of(flight.metrics, is_beyond))
    return nullptr;
  const auto found = std::ranges::find_if(
      flight.clauses, [](const judge::ClauseVerdict& one) { return !one.met && !one.from; });
  return found == flight.clauses.end() ? nullptr : &*found;
}

/// A missed limit on reaction times, or ages of data, that no program could meet; empty: there is
/// none.
std::string limit_without_program(const campaign::TrialResult& flight) {
  for (const judge::ClauseVerdict& clause : flight.clauses)
    if (!clause.met && clause.limit && clause.least_without_computing >= clause.limit)
      return fmt::format(
          "“{}” allows {:.4g} {}, and at least {:.4g} {} pass without computing: "
          "until the program has a measurement, while it waits, and until its command has an "
          "effect",
          clause.name, *clause.limit, clause.unit, *clause.least_without_computing, clause.unit);
  return "";
}

/// What has nothing to do with the speed of a computer; empty: not known.
std::string known_cause(const campaign::TrialResult& flight, const std::optional<Pace>&) {
  for (const campaign::UavContacts& own : flight.contacts)
    if (own.hard > 0 && own.hardest && own.hardest->at <= kBeforeAnyProgram)
      return fmt::format("{} hits “{}” at ST {:.3f} s, before a program can act", own.uav,
                         own.hardest->with, to_seconds(own.hardest->at));
  for (const campaign::UavEnergy& energy : flight.energy)
    if (energy.is_empty() && energy.charge_from < kEmpty)
      return fmt::format("the battery of {} is at {:.2g} % at the start", energy.uav,
                         100.0 * energy.charge_from);
    else if (energy.cut_off_at <= kBeforeAnyProgram)
      return fmt::format(
          "the battery of {} gives no power from ST {:.3f} s on, before a program can act: its "
          "voltage is too low, or it is asked for more than it has",
          energy.uav, to_seconds(energy.cut_off_at));
  for (const judge::ClauseVerdict& clause : flight.clauses)
    if (!clause.met && clause.margin && clause.decided_at && !clause.least_without_computing &&
        *clause.decided_at <= kBeforeAnyProgram)
      return fmt::format("“{}” is missed at ST {:.3f} s, before a program can act", clause.name,
                         to_seconds(*clause.decided_at));
  return limit_without_program(flight);
}

/// What can be the reason, if the program depends on it; empty: there is nothing. Whether a task
/// runs, the program decides, and may do so by the time that is left.
std::string possible_cause(const campaign::TrialResult& flight, const std::optional<Pace>& pace) {
  for (const Warning& warning : flight.warnings)
    if (warning.consequence == Consequence::kDoubtful)
      return warning.subject + " " + warning.message;
  for (const campaign::UavEnergy& own : flight.energy) {
    const double computing_J = own.spent_J[static_cast<std::size_t>(energy::Cause::kComputing)] +
                               own.spent_J[static_cast<std::size_t>(energy::Cause::kIdle)];
    const double share = computing_J / std::max(campaign::total_J(own.spent_J), 1e-9);
    if (own.is_empty())
      return fmt::format(
          "the battery of {} is empty at the end, and the computer took {:.2g} % of "
          "its energy",
          own.uav, 100.0 * share);
  }
  if (const judge::ClauseVerdict* clause = of_forgotten_task(flight)) return clause->limited_by;
  for (const judge::ClauseVerdict& clause : flight.clauses)
    if (!clause.met && !clause.quantity.empty() && clause.quantiles.empty())
      return fmt::format("“{}” has nothing to judge: {}", clause.name, clause.limited_by);
  if (pace && !pace->unclear.empty()) return pace->unclear;
  if (pace && pace->losses.count > 0)
    return fmt::format("UAV '{}' {}", pace->losses.uav, pace->losses.text());
  if (pace && pace->messages > 0 && pace->messages_arrived == 0)
    return fmt::format("none of {} messages arrives", pace->messages);
  return "";
}

/// A missed limit on the reaction to a measurement that computing alone is beyond, until its
/// command; empty: there is none.
std::string limit_below_computing(const campaign::TrialResult& flight,
                                  const std::optional<Pace>& pace) {
  if (!pace || pace->speed.measures_waits()) return "";
  for (const judge::ClauseVerdict& clause : flight.clauses) {
    // Without computing, it would be within the limit.
    const bool is_of_computing = !clause.met && clause.limit && clause.median_of_computing &&
                                 clause.least_without_computing < clause.limit &&
                                 clause.median_of_computing > clause.limit;
    if (!is_of_computing) continue;
    const double unit_s = clause.unit == "ms" ? 1e-3 : 1.0;
    return fmt::format(
        "From a measurement to its command, computing takes {}, longer than “{}” allows",
        short_ms(unit_s * *clause.median_of_computing), clause.name);
  }
  return "";
}

/// What computing would be if it were any: it takes as long under another condition, whose
/// computers are much faster or slower. Empty: there is no such condition.
std::string unscaled_computing(const Compared& missed, const std::vector<Compared>& all) {
  constexpr double kSameTimes = 1.25, kOtherSpeed = 2.0;
  for (const Compared& other : all) {
    const auto slowdown = slowdown_of(missed, other);
    if (!slowdown || std::max(*slowdown, 1.0 / *slowdown) <= kOtherSpeed) continue;
    const auto costs = costs_of(*missed.pace(), *other.pace());
    if (costs && costs->own_s <= kSameTimes * costs->other_s &&
        costs->other_s <= kSameTimes * costs->own_s)
      return fmt::format(
          "{} {}, and {} on “{}”, which is {:.2g} × {}: the program probably waits for its clock, "
          "which no computer changes",
          costs->what, short_ms(costs->own_s), short_ms(costs->other_s), other.label,
          std::max(*slowdown, 1.0 / *slowdown), *slowdown > 1.0 ? "faster" : "slower");
  }
  return "";
}

/// That a signal or a debugger stopped the program, on a clock that goes on meanwhile; empty: it
/// did not.
std::string stopped(const campaign::TrialResult& flight, const std::optional<Pace>& pace) {
  if (!pace || !pace->speed.measures_waits()) return "";
  const std::string& note = flight.this_run.stopped_program;
  return note.empty() ? "" : note + ", and its clock went on";
}

/// That the time limit ended a flight which had missed nothing else yet; empty: it is not so.
std::string cut_short(const campaign::TrialResult& flight, const std::optional<Pace>&) {
  if (flight.end != campaign::kEndTimeLimit) return "";
  const auto is_missed = [](const judge::ClauseVerdict& one) {
    return !one.met && one.margin && *one.margin < 0.0;
  };
  const campaign::MetricValue* later = nullptr;
  for (const campaign::MetricValue& metric : flight.metrics) {
    if (metric.value && !metric.is_met()) return "";
    if (metric.name == "time_required" && metric.max > to_seconds(flight.sync.st_at_end))
      later = &metric;
  }
  if (later == nullptr || std::ranges::any_of(flight.clauses, is_missed)) return "";
  return fmt::format(
      "the time limit ended the flight at {:.4g} s, before {} of at most {:g} s "
      "could be missed",
      to_seconds(flight.sync.st_at_end), in_a_sentence(later->label), *later->max);
}

/// What is so in each flight that missed the goal, as of the first one; empty: there is nothing.
template <class Find>
std::string in_each(const Compared& missed, const Find& find) {
  std::string first;
  for (const campaign::TrialResult* flight : missed.flights) {
    if (flight->outcome != campaign::Outcome::kGoalMissed) continue;
    const std::string found = find(*flight, missed.pace());
    if (found.empty()) return "";
    if (first.empty()) first = found;
  }
  return first;
}

// The reason.

/// "is fast enough so far: an image costs 24 ms instead of 145 ms, 5.9 × less"
std::string comparison_text(const Compared& other, const Compared& missed) {
  const ConditionVerdict& verdict = *other.verdict;
  const auto costs = costs_of(*missed.pace(), *other.pace());
  // A flight that ended early can have other medians.
  std::string cost_text;
  if (costs && costs->own_s > kSameCost * costs->other_s)
    cost_text = fmt::format(
        "{} {} instead of {}{}", costs->what, short_ms(costs->other_s), short_ms(costs->own_s),
        costs->other_s > 0.0 ? fmt::format(", {} × less", fixed(costs->own_s / costs->other_s, 1))
                             : "");
  else
    cost_text = fmt::format("its computer is {:.3g} × faster", *slowdown_of(missed, other));
  const double own_hz = missed.pace()->setpoint_hz, other_hz = other.pace()->setpoint_hz;
  if (own_hz > 0.0 && other_hz > kSameCost * own_hz)
    cost_text += fmt::format(", and set-points are sent {:.2g} times a second instead of {:.2g}",
                             other_hz, own_hz);
  return (is_sufficient(verdict.ruling)
              ? fmt::format("{} {}", is_in_doubt(verdict) ? "seems" : "is", name_of_flown(verdict))
              : fmt::format("reaches it in {} of {}", verdict.reached,
                            counted(verdict.flown, "flight"))) +
         ": " + cost_text;
}

/// @pre differ_in_speed_only
MissReason compared(Evidence evidence, const Compared& other, const Compared& missed,
                    std::string text = "") {
  const auto& own = missed.pace()->speed.programs;
  const bool is_of_other_build =
      !std::ranges::equal(own, other.pace()->speed.programs, std::not_fn(is_of_other_architecture));
  return {evidence, other.label, std::move(text), is_of_other_build, other.verdict->reached};
}

/// A possible cause that each faster condition has, as `own` if that is one; empty: there is none.
std::string cause_of_faster(const std::vector<const Compared*>& faster, const std::string& own) {
  std::string cause = own;
  for (const Compared* other : faster) {
    const std::string found = in_each(*other, possible_cause);
    if (found.empty()) return "";
    if (cause.empty()) cause = fmt::format("of “{}”, which is faster, {}", other->label, found);
  }
  return cause;
}

MissReason reason_of(const Compared& missed, const std::vector<Compared>& all,
                     std::size_t comparisons) {
  for (const auto& find : {stopped, cut_short})
    if (const std::string cause = in_each(missed, find); !cause.empty())
      return {Evidence::kPossibleCause, "", cause};
  std::vector<const Compared*> faster;
  for (const Compared& other : all)
    if (is_evidence(*other.verdict) && is_faster(other, missed) &&
        (other.verdict->is_missed() || !has_times_of_another_kind(other, missed)))
      faster.push_back(&other);
  // The slowest first: the least that would do.
  std::ranges::stable_sort(faster, {},
                           [&](const Compared* other) { return *slowdown_of(missed, *other); });
  const auto reaches_instead = [&](const Compared& other) {
    return is_sufficient(other.verdict->ruling) &&
           reaches_more_often(*other.verdict, *missed.verdict, comparisons);
  };
  for (const Compared& slower : all) {
    if (!is_evidence(*slower.verdict) || !is_faster(missed, slower) || !reaches_instead(slower))
      continue;
    const auto other =
        std::ranges::find_if(faster, [&](const Compared* one) { return reaches_instead(*one); });
    if (other == faster.end())
      return {Evidence::kSlowerReaches, slower.label,
              fmt::format("is {}", name_of_flown(*slower.verdict))};
    return {Evidence::kBothSidesReach, slower.label,
            fmt::format("“{}” is faster, and both reach it", (*other)->label)};
  }
  const bool is_comparable = missed.pace() && !missed.pace()->speed.stretches_unseen_waits();
  for (const Compared* other : faster)
    if (is_comparable && reaches_more_often(*other->verdict, *missed.verdict, comparisons))
      return compared(Evidence::kFasterReaches, *other, missed, comparison_text(*other, missed));
  if (const std::string cause = in_each(missed, known_cause); !cause.empty())
    return {Evidence::kKnownCause, "", cause};
  if (is_instant(missed)) return {Evidence::kInstant};
  for (const Compared& other : all)
    if (is_equally_fast_and_reaches(other, missed, comparisons))
      return {Evidence::kEquallyFastReaches, other.label};
  const bool misses_faster = std::ranges::any_of(
      faster, [](const Compared* other) { return other->verdict->is_missed(); });
  if (const std::string limit = in_each(missed, limit_below_computing);
      !limit.empty() && !misses_faster && missed.pace()->unclear.empty()) {
    const std::string unscaled = unscaled_computing(missed, all);
    return {unscaled.empty() ? Evidence::kMissesOwnPace : Evidence::kKnownCause, "",
            unscaled.empty() ? limit : unscaled};
  }
  const bool some_speed_suffices = std::ranges::any_of(all, [&](const Compared& other) {
    return differ_in_speed_only(other, missed) && is_sufficient(other.verdict->ruling);
  });
  // What the faster ones may have missed it for, and no speed changes, comes before how near each
  // came.
  const std::string cause = in_each(missed, possible_cause);
  const std::string cause_of_all = cause_of_faster(faster, cause);
  for (const Compared* other : faster) {
    if (some_speed_suffices || !other->verdict->is_missed()) continue;
    if (!cause_of_all.empty() && !is_instant(*other))
      return {Evidence::kPossibleCause, "", cause_of_all};
    if (const std::string limit = met_by(*other->verdict, *missed.verdict); !limit.empty())
      return compared(Evidence::kFasterUndecided, *other, missed,
                      "misses it, too, but meets " + limit);
    if (is_instant(*other)) return compared(Evidence::kInstantMissesToo, *other, missed);
    if (const std::string limit = nearer_to(*other, missed); !limit.empty())
      return compared(Evidence::kFasterUndecided, *other, missed,
                      "misses it, too, but by less: " + limit);
    if (other->pace()->keeps_up() && is_much_faster(*other, missed))
      return compared(Evidence::kFasterMissesToo, *other, missed);
  }
  if (!faster.empty())
    return compared(Evidence::kFasterUndecided, *faster.front(), missed,
                    comparison_text(*faster.front(), missed));
  if (!cause.empty()) return {Evidence::kPossibleCause, "", cause};
  MissReason reason;
  for (const Compared& other : all) {
    if (!is_evidence(*other.verdict) || !reaches_instead(other)) continue;
    const std::string why = why_not_compared(other, missed);
    if (why.empty()) continue;
    if (is_equally_fast_with_other_sensors(other, missed))
      return {Evidence::kOtherSensorsReach, other.label};
    if (reason.text.empty()) reason = {Evidence::kNotComparable, other.label, why};
  }
  return reason;
}

Ruling ruling_on(Evidence evidence) {
  if (evidence <= Evidence::kMissesOwnPace) return Ruling::kNotFastEnough;
  return evidence <= Evidence::kBothSidesReach ? Ruling::kGoalMissed : Ruling::kOtherReason;
}

}  // namespace

bool is_evidence(const ConditionVerdict& one) {
  return one.ruling > Ruling::kUnseen && one.ruling < Ruling::kFreeRunning && one.flown > 0 &&
         one.uncharged.empty();
}

double chance_of(const ConditionVerdict& a, const ConditionVerdict& b) {
  const auto is_certain = [](const ConditionVerdict& one) {
    return one.is_one_flight() && one.flown > 1;
  };
  if (is_certain(a) && is_certain(b)) return a.distinct_reached == b.distinct_reached ? 1.0 : 0.0;
  return campaign::fisher_exact({a.distinct_reached, a.distinct}, {b.distinct_reached, b.distinct});
}

void explain_misses(std::span<const ToExplain> conditions, std::size_t comparisons) {
  std::vector<Compared> all;
  for (const ToExplain& one : conditions)
    if (auto flights = campaign::distinct_flights(one.results->trials); !flights.empty())
      all.push_back({one.verdict, std::move(flights), one.label});
  for (const Compared& one : all)
    if (one.verdict->is_missed()) one.verdict->miss = reason_of(one, all, comparisons);
  // Not earlier: each is compared with the rulings as they were.
  for (const Compared& one : all)
    if (one.verdict->miss) one.verdict->ruling = ruling_on(one.verdict->miss->evidence);
}

}  // namespace tether::report
