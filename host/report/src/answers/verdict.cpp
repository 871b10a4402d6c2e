#include "answers/board_pace.h"
#include "answers/miss_reason.h"
#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/campaign_results.h>
#include <tether/report/size_report.h>
#include <tether/report/verdict.h>
#include <tether/sizing/sizing.h>

namespace tether::report {
namespace {

constexpr std::size_t kMostFlights = 1000;

bool is_free_running(const campaign::TrialResult& trial) {
  return trial.policy == record::kFreeRunning;
}

/// Of a flight that was cut, the record is not complete, and an audit of it says nothing.
bool is_unsound(const campaign::TrialResult& trial) {
  const bool has_ended =
      trial.end == campaign::kEndFinished || trial.end == campaign::kEndTimeLimit ||
      trial.end == campaign::kEndBatteryEmpty || trial.end == campaign::kEndKilled;
  return (has_ended && trial.audit && !trial.audit->passed) || trial.sync.causality_violations > 0;
}

/// One more would be beyond it, and nothing is known of how near that was.
bool is_count_at_limit(const campaign::MetricValue& metric) {
  const std::optional<double>& limit = metric.max ? metric.max : metric.min;
  return metric.unit == "1" && metric.value && limit && *metric.value == *limit && *limit != 0.0;
}

bool has_limit(const campaign::TrialResult& trial) {
  return !trial.clauses.empty() || std::ranges::any_of(trial.metrics, [](const auto& metric) {
    return metric.max || metric.min;
  });
}

void add(std::vector<FlightsInDoubt>& doubts, const campaign::Doubt& doubt) {
  auto known = std::ranges::find_if(
      doubts, [&](const FlightsInDoubt& one) { return one.largest.kind >= doubt.kind; });
  if (known == doubts.end() || known->largest.kind != doubt.kind)
    known = doubts.insert(known, {doubt, 0});
  ++known->flights;
  if (doubt.amount > known->largest.amount) known->largest = doubt;
}

void count(ConditionVerdict& verdict, const campaign::TrialResult& trial) {
  if (is_unsound(trial)) {
    if (verdict.unsound++ == 0)
      verdict.reason = trial.audit && !trial.audit->passed ? trial.audit->summary : trial.reason;
  }
  for (const campaign::Doubt& doubt : trial.this_run.doubts) add(verdict.doubts, doubt);
  if (trial.outcome == campaign::Outcome::kFailed) {
    verdict.was_interrupted |= trial.end == campaign::kEndInterrupted;
    if (verdict.failed++ == 0 && verdict.unsound == 0) verdict.reason = trial.reason;
    return;
  }
  ++verdict.flown;
  for (const Warning& warning : trial.warnings) {
    if (!warning.can_change_verdict) continue;
    const bool is_doubtful = warning.consequence == Consequence::kDoubtful;
    const std::string line = warning.subject + " " + warning.message;
    const auto add_to = [&](std::vector<std::string>& lines) {
      if (std::ranges::count(lines, line) == 0) lines.push_back(line);
    };
    add_to(is_doubtful ? verdict.doubtful : verdict.left_out);
    if (is_doubtful && trial.outcome == campaign::Outcome::kGoalReached)
      add_to(verdict.doubtful_goals);
  }
  if (trial.replay)
    for (const std::string& stage : trial.replay->unknown_stages)
      if (std::ranges::count(verdict.uncharged, stage) == 0) verdict.uncharged.push_back(stage);
  if (trial.outcome == campaign::Outcome::kGoalReached) ++verdict.reached;
  if (!missed_without_value(trial).empty()) ++verdict.without_value;
  if (has_crash(trial)) ++verdict.crashed;
  if (std::ranges::any_of(trial.suts, [](const campaign::SutResult& sut) {
        return sut.as_is && sut.finished && !sut.reached_goal;
      }))
    ++verdict.gave_up;
  if (trial.this_run.target && trial.this_run.target->is_spoiled) ++verdict.throttled;
  std::optional<std::pair<std::string, double>> worst;
  const auto compare = [&](const std::string& label, std::optional<double> margin) {
    if (margin && (!worst || *margin < worst->second)) worst = {label, *margin};
  };
  for (const campaign::MetricValue& metric : trial.metrics)
    compare(metric.label, is_count_at_limit(metric) ? 0.0 : margin_of(metric));
  for (const judge::ClauseVerdict& clause : trial.clauses)
    compare(fmt::format("“{}”", clause.name), margin_of(clause));
  if (!worst) return;
  if (!verdict.closest || worst->second < verdict.closest->second) verdict.closest = worst;
  // A flight that missed what has no margin, such as a crash, is not near to any limit. Nor is one
  // that a clause ended there: how far it would have gone beyond is not known.
  const auto is_missed_alone = [](const judge::ClauseVerdict& one) {
    return !one.met && !one.margin;
  };
  const bool is_by_margins =
      trial.outcome == campaign::Outcome::kGoalReached ||
      (worst->second < 0.0 && !has_crash(trial) && trial.end != campaign::kEndKilled &&
       std::ranges::none_of(trial.clauses, is_missed_alone));
  if (!is_by_margins) return;
  if (!verdict.tightest || std::abs(worst->second) < std::abs(verdict.tightest->second))
    verdict.tightest = worst;
  verdict.margins.push_back(worst->second);
}

/// What it shows that so many of the distinct flights reach the goal.
Ruling shown_by(std::size_t reached, const ConditionVerdict& verdict) {
  // Those that failed could all have missed it.
  if (exact_interval(reached, verdict.distinct + verdict.failed).low >= kWantedSuccess)
    return Ruling::kFastEnough;
  if (reached == verdict.distinct && verdict.failed == 0) return Ruling::kFastEnoughSoFar;
  const bool is_missed =
      exact_interval(reached, verdict.distinct).high < kWantedSuccess || verdict.is_one_flight();
  // A board that was throttled could do better.
  return is_missed && verdict.throttled == 0 ? Ruling::kGoalMissed : Ruling::kUndecided;
}

Ruling ruling_of(const ConditionVerdict& verdict, const campaign::ConditionResults& results) {
  const auto& trials = results.trials;
  if (verdict.unsound > 0) return Ruling::kVoid;
  if (verdict.flown == 0) return verdict.failed > 0 ? Ruling::kSetUpFailed : Ruling::kNotFlown;
  if (std::ranges::any_of(trials, is_free_running)) return Ruling::kFreeRunning;
  if (std::ranges::any_of(verdict.doubts, [](const FlightsInDoubt& doubt) {
        return doubt.largest.is_of_unseen_time();
      }))
    return Ruling::kUnseen;
  const bool all = verdict.reached == verdict.flown;
  if (all && std::ranges::none_of(trials, has_limit)) return Ruling::kNothingToDecide;
  if (is_within_spread(verdict) || !verdict.mixed_build.empty()) return Ruling::kUndecided;
  return shown_by(verdict.distinct_reached, verdict);
}

/// What has not the same value in all of them.
std::vector<std::string> varied_in(const std::vector<const campaign::TrialResult*>& flights) {
  std::vector<std::string> varied;
  for (const campaign::TrialResult* flight : flights) {
    const auto& own = flight->varied;
    const auto& firsts = flights.front()->varied;
    for (std::size_t i = 0; i < own.size(); ++i)
      if ((i >= firsts.size() || own[i] != firsts[i]) &&
          std::ranges::count(varied, own[i].what) == 0)
        varied.push_back(own[i].what);
  }
  return varied;
}

/// What of a UAV's program was built again between these flights; empty: nothing.
std::string mixed_build(const std::vector<const campaign::TrialResult*>& flights) {
  std::map<std::string, const Speed::Program*> firsts;  // of each UAV
  for (const campaign::TrialResult* flight : flights) {
    if (!flight->pace) continue;
    for (const Speed::Program& program : flight->pace->speed.programs) {
      const Speed::Program& first = *firsts.emplace(program.uav, &program).first->second;
      // What follows are arguments and files, which a program may write itself.
      const auto id = [](const Speed::Program& of) {
        return of.build.substr(0, of.build.find('\n'));
      };
      if (id(program) != id(first)) return "the program";
      const auto [own, other] = std::ranges::mismatch(program.libraries, first.libraries);
      if (own != program.libraries.end()) return own->substr(0, own->rfind(' '));
      if (other != first.libraries.end()) return other->substr(0, other->rfind(' '));
    }
  }
  return "";
}

}  // namespace

bool is_within_spread(const ConditionVerdict& verdict, const FlightsInDoubt& doubt) {
  if (doubt.largest.is_of_unseen_time() || verdict.distinct == 0) return false;
  // What took t can take (1 + amount) t, or the other way round: 90 % more of a fifth of a limit is
  // within it.
  const double amount = doubt.largest.amount;
  std::size_t may_miss = 0, may_reach = 0;
  for (const double margin : verdict.margins)
    if (margin >= 0.0)
      may_miss += (1.0 - margin) * (1.0 + amount) > 1.0 ? 1U : 0U;
    else
      may_reach += -margin < amount ? 1U : 0U;
  const std::size_t reached = verdict.distinct_reached;
  const Ruling shown = shown_by(reached, verdict);
  return shown_by(reached - std::min(reached, may_miss), verdict) != shown ||
         shown_by(std::min(verdict.distinct, reached + may_reach), verdict) != shown;
}

bool is_within_spread(const ConditionVerdict& verdict) {
  return std::ranges::any_of(verdict.doubts, [&](const FlightsInDoubt& doubt) {
    return is_within_spread(verdict, doubt);
  });
}

ConditionVerdict verdict_of(const campaign::ConditionResults& results) {
  ConditionVerdict verdict{.condition = results.condition, .planned = results.planned};
  if (!results.trials.empty()) {
    const campaign::ThisRun& first = results.trials.front().this_run;
    verdict.sizing = first.sizing;
    verdict.is_on_real_board = first.target && !first.target->address.empty();
    verdict.has_as_is =
        std::ranges::any_of(results.trials.front().suts, &campaign::SutResult::as_is);
  }
  std::vector<const campaign::TrialResult*> flown;
  for (const campaign::TrialResult& trial : results.trials) {
    count(verdict, trial);
    if (trial.outcome != campaign::Outcome::kFailed) flown.push_back(&trial);
  }
  verdict.missed = missed_limits(flown);
  verdict.mixed_build = mixed_build(flown);
  verdict.varied = varied_in(flown);
  const auto distinct = campaign::distinct_flights(results.trials);
  verdict.distinct = distinct.size();
  verdict.distinct_reached = static_cast<std::size_t>(std::ranges::count(
      distinct, campaign::Outcome::kGoalReached, &campaign::TrialResult::outcome));
  if (verdict.flown > 0) verdict.share = exact_interval(verdict.distinct_reached, verdict.distinct);
  verdict.ruling = ruling_of(verdict, results);
  return verdict;
}

namespace {

/// How many flights would decide, if their share stays what it is. 0: very many.
std::size_t flights_to_decide(const ConditionVerdict& verdict) {
  const double share =
      static_cast<double>(verdict.distinct_reached) / static_cast<double>(verdict.distinct);
  for (std::size_t flown = verdict.distinct + 1; flown <= kMostFlights; ++flown) {
    const auto reached = static_cast<std::size_t>(std::lround(share * static_cast<double>(flown)));
    const campaign::Interval interval = exact_interval(reached, flown);
    if (interval.low >= kWantedSuccess || interval.high < kWantedSuccess) return flown;
  }
  return 0;
}

std::vector<Advice> advice_on(const ConditionVerdict& lead) {
  using Kind = Advice::Kind;
  std::vector<Advice> advice;
  const bool is_too_slow = lead.pace && lead.pace->is_too_slow_for_camera();
  if (lead.failed > 0 && lead.unsound == 0)
    advice.push_back({lead.was_interrupted ? Kind::kFlyAgain : Kind::kMendSetUp});
  else if (lead.unsound == 0 && lead.planned > lead.flown + lead.failed)
    advice.push_back({Kind::kFlyRest});
  if (lead.throttled > 0) advice.push_back({Kind::kCoolBoard, lead.condition});
  if (!lead.doubtful.empty() && lead.ruling >= Ruling::kUndecided)
    advice.push_back({Kind::kMendDoubt});
  switch (lead.ruling) {
    case Ruling::kVoid:
      advice.push_back({Kind::kReadAudit, lead.condition});
      break;
    case Ruling::kNotFlown:
      break;
    case Ruling::kSetUpFailed:
    case Ruling::kUnseen:
      for (const auto& [doubt, kind] :
           {std::pair{campaign::Doubt::Kind::kUnseenWait, Kind::kShowWaits},
            {campaign::Doubt::Kind::kDiskWait, Kind::kCountDisk},
            {campaign::Doubt::Kind::kStretchedWait, Kind::kUnstretch}})
        if (lead.doubt(doubt) != nullptr) advice.push_back({kind});
      if (lead.doubt(campaign::Doubt::Kind::kParallelThreads) != nullptr)
        advice.push_back({Kind::kRunConcurrent});
      for (const FlightsInDoubt& doubt : lead.doubts)
        if (const std::string& file = doubt.largest.recorded_in;
            doubt.largest.is_of_unseen_time() && !file.empty())
          return advice.push_back({Kind::kRecordAgain, file}), advice;
      break;
    case Ruling::kNotFastEnough:
      if (is_too_slow) advice.push_back({Kind::kSpeedUpStage, lead.pace->stages.front().stage});
      advice.push_back({Kind::kFindThreshold, lead.condition});
      break;
    case Ruling::kGoalMissed:
      if (lead.without_value == lead.flown - lead.reached)
        advice.push_back({Kind::kGiveValue});
      else if (lead.pace && lead.pace->speed.stretches_unseen_waits())
        advice.push_back({Kind::kUnstretch});
      else if (lead.miss->evidence == MissReason::Evidence::kBothSidesReach ||
               lead.miss->evidence == MissReason::Evidence::kOtherSensorsReach)
        advice.push_back({Kind::kFindReason, lead.miss->condition});
      else if (lead.miss->evidence == MissReason::Evidence::kPossibleCause)
        advice.push_back({Kind::kFindReason});
      else if (lead.miss->reached > 0)
        advice.push_back({Kind::kCompareMore, lead.condition});
      else {
        if (lead.gave_up > 0) advice.push_back({Kind::kMendProgram});
        advice.push_back({Kind::kTryFaster, lead.condition});
      }
      break;
    case Ruling::kOtherReason:
      advice.push_back({Kind::kFindReason, lead.miss->condition});
      break;
    case Ruling::kUndecided:
    case Ruling::kFastEnoughSoFar:
      if (!lead.mixed_build.empty()) break;  // all have to be flown again
      if (is_within_spread(lead)) {
        const FlightsInDoubt* const busy = lead.doubt(campaign::Doubt::Kind::kBusyMachine);
        const std::string file = busy == nullptr ? "" : busy->largest.recorded_in;
        advice.push_back({busy == nullptr ? Kind::kShowWaits
                          : file.empty()  ? Kind::kQuietMachine
                                          : Kind::kRecordAgain,
                          file});
      }
      if (lead.flown > 1 && lead.is_one_flight())
        advice.push_back({Kind::kVarySeeds});
      else if (!is_within_spread(lead) && lead.failed == 0)
        advice.push_back({Kind::kFlyMore, lead.condition, flights_to_decide(lead)});
      // Whether speed is the reason of those that missed the goal is not known.
      advice.push_back(
          {lead.reached < lead.flown ? Kind::kTryFaster : Kind::kFindThreshold, lead.condition});
      break;
    case Ruling::kFastEnough:
      advice.push_back({Kind::kFindThreshold, lead.condition});
      break;
    case Ruling::kNothingToDecide:
      advice.push_back({Kind::kSetLimit});
      break;
    case Ruling::kFreeRunning:
      advice.push_back({Kind::kSynchronise});
      break;
  }
  return advice;
}

/// Of the first of the trials that have one; its boards are those of all trials.
/// @param unknown why that of the first one is not known; only if none is.
std::optional<Pace> pace_of_condition(const campaign::ConditionResults& condition,
                                      std::string& unknown) {
  std::vector<const campaign::TrialResult*> trials;
  for (const campaign::TrialResult& trial : condition.trials)
    if (trial.outcome != campaign::Outcome::kFailed) trials.push_back(&trial);
  std::ranges::stable_sort(trials, {}, [](const campaign::TrialResult* trial) {
    return trial->outcome != campaign::Outcome::kGoalMissed;
  });
  std::optional<Pace> first;
  std::vector<std::vector<BoardPace>> boards;
  for (const campaign::TrialResult* trial : trials) {
    auto [pace, reason] = pace_or_reason(*trial);
    if (unknown.empty()) unknown = reason;
    if (!pace) continue;
    boards.push_back(pace->boards);
    if (!first) first = std::move(pace);
    if (first->boards.empty()) break;
  }
  if (!first) return std::nullopt;
  unknown.clear();
  if (boards.size() > 1) first->boards = over_flights(boards);
  return first;
}

/// The verdict without reasons for missed goals, lead and advice.
Verdict unexplained(const campaign::ScenarioResults& scenario,
                    const std::vector<std::optional<Pace>>& paces) {
  Verdict verdict{.scenario = scenario.swept_from.empty() ? scenario.scenario : scenario.swept_from,
                  .conditions = {}};
  verdict.settings = scenario.settings;
  for (const campaign::Setting& setting : scenario.settings)
    verdict.point +=
        fmt::format("{}{} = {}", verdict.point.empty() ? "" : ", ", setting.key, setting.value);
  for (const campaign::ConditionResults& condition : scenario.conditions) {
    verdict.conditions.push_back(verdict_of(condition));
    const std::size_t i = verdict.conditions.size() - 1;
    if (i < paces.size()) verdict.conditions.back().pace = paces[i];
  }
  return verdict;
}

/// Adds what they are without. Points of a sweep that differ in their speed only are compared as
/// conditions of one scenario are.
std::vector<Verdict> rule(std::vector<Verdict> verdicts,
                          const std::vector<const campaign::ScenarioResults*>& scenarios) {
  std::map<std::pair<std::string, std::string>, std::vector<ToExplain>> comparable;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    Verdict& verdict = verdicts[i];
    for (std::size_t j = 0; j < verdict.conditions.size(); ++j) {
      ConditionVerdict& condition = verdict.conditions[j];
      const std::string with = verdict.point.empty() ? "" : " with " + verdict.point;
      comparable[{verdict.scenario, settings_beside({"cpu_factor", "computing_ms"}, verdict)}]
          .push_back({&condition, &scenarios[i]->conditions[j], condition.condition + with});
    }
  }
  // A sweep makes many comparisons, of which some succeed by chance.
  std::map<std::string, std::size_t> compared;
  for (const Verdict& verdict : verdicts)
    compared[verdict.scenario] +=
        static_cast<std::size_t>(std::ranges::count_if(verdict.conditions, is_evidence));
  for (const auto& [of, conditions] : comparable)
    explain_misses(conditions, compared[of.first] * (compared[of.first] - 1) / 2);
  for (Verdict& verdict : verdicts) {
    // Of equal rulings, the condition whose program is the slowest.
    const auto lead =
        std::ranges::min_element(verdict.conditions, {}, [](const ConditionVerdict& condition) {
          return std::pair(condition.ruling, condition.pace ? -condition.pace->p95_s : 0.0);
        });
    verdict.lead = static_cast<std::size_t>(lead - verdict.conditions.begin());
    verdict.advice = advice_on(*lead);
  }
  return verdicts;
}

}  // namespace

const Verdict& most_urgent(const std::vector<Verdict>& verdicts) {
  return *std::ranges::min_element(verdicts, {},
                                   [](const Verdict& one) { return one.first().ruling; });
}

const FlightsInDoubt* ConditionVerdict::doubt(campaign::Doubt::Kind kind) const {
  const auto found = std::ranges::find_if(
      doubts, [&](const FlightsInDoubt& one) { return one.largest.kind == kind; });
  return found == doubts.end() ? nullptr : &*found;
}

campaign::Interval exact_interval(std::size_t reached, std::size_t flown) {
  const sizing::Share share = sizing::exact_share(reached, flown, 0.95);
  return {share.low, share.high};
}

Verdict verdict_of(const campaign::ScenarioResults& scenario,
                   const std::vector<std::optional<Pace>>& paces) {
  return rule({unexplained(scenario, paces)}, std::vector{&scenario}).front();
}

PaceOrReason pace_or_reason(const campaign::TrialResult& trial) {
  if (trial.pace || is_free_running(trial)) return {trial.pace, ""};
  return {
      std::nullopt,
      fmt::format(
          "the result of seed {} does not have them, because it is of an earlier version "
          "of Tether, its program reports no stages, or the flight ended before it did anything",
          trial.seed)};
}

std::vector<Verdict> verdicts_of(const campaign::CampaignResults& results) {
  std::vector<Verdict> verdicts;
  std::vector<const campaign::ScenarioResults*> scenarios;
  for (const campaign::ScenarioResults& scenario : results.scenarios) {
    std::vector<std::optional<Pace>> paces;
    std::vector<std::string> unknown;
    for (const campaign::ConditionResults& condition : scenario.conditions)
      paces.push_back(pace_of_condition(condition, unknown.emplace_back()));
    verdicts.push_back(unexplained(scenario, paces));
    scenarios.push_back(&scenario);
    for (std::size_t i = 0; i < unknown.size(); ++i)
      verdicts.back().conditions[i].unknown_pace = unknown[i];
  }
  return rule(std::move(verdicts), scenarios);
}

}  // namespace tether::report
