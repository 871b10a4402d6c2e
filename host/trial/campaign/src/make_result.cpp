#include "contacts.h"
#include "energy.h"
#include "program_doubts.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/text.h>
#include <tether/campaign/campaign_results.h>
#include <tether/campaign/result.h>

// A result is assembled from the scenario (what was asked for), the record (what happened) and what
// the SUTs reported at their end. `settle` decides the outcome and its reason.
namespace tether::campaign {
namespace {

/// Of the computers, each once: "front, rear"; if none is described, that of the target.
std::string names_of(const scenario::Condition& condition) {
  const auto& target = condition.computers.front().target;
  if (condition.seats.empty()) return target ? target->name : "";
  std::vector<std::string> names;
  for (const scenario::Computer& computer : condition.computers) names.push_back(computer.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

TrialResult result_of(const scenario::Scenario& scenario, const scenario::Condition& condition,
                      std::uint64_t seed) {
  TrialResult result;
  result.scenario = scenario.name;
  result.condition = condition.name;
  result.seed = seed;
  result.policy = scenario::name(condition.policy);
  result.clock = computer_of(condition, 0).clock;
  result.real_time_factor = condition.real_time_factor;
  result.target = names_of(condition);
  for (const auto& [key, value] : scenario.settings) result.settings[key] = value;
  result.emulator = emulator_of(condition);
  result.profiles = scenario::profile_names(scenario, condition);
  return result;
}

std::vector<SutResult> sut_results(const record::Record& record,
                                   const std::vector<TaskEnd>& task_ends,
                                   std::vector<Warning>& warnings, std::string& never_began) {
  std::vector<SutResult> suts;
  for (const record::SutInfo& info : record.header.suts) {
    SutResult sut{.uav = info.uav, .sut = info.sut, .clock = info.clock, .as_is = info.as_is};
    const std::size_t index = suts.size();
    const bool is_synchronised = record.header.policy == record::kConservativeBarrier;
    if (is_synchronised && record.footer && index < record.footer->et_at_end.size()) {
      sut.et_at_end = record.footer->et_at_end[index];
    }
    for (const TaskEnd& end : task_ends) {
      if (end.uav != sut.uav) continue;
      sut.finished = true;
      sut.reached_goal = end.reached_goal;
      sut.outcome = end.outcome;
      sut.details = end.details;
    }
    if (std::string why = check_program(record, info, sut, warnings); never_began.empty())
      never_began = std::move(why);
    suts.push_back(std::move(sut));
  }
  return suts;
}

/// Of a text as in ISO 8601.
std::optional<std::chrono::sys_days> day_of(const std::string& time) {
  int year = 0;
  unsigned month = 0, day = 0;
  if (std::sscanf(time.c_str(), "%4d-%2u-%2u", &year, &month, &day) != 3) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month),
                                         std::chrono::day(day)};
  return date.ok() ? std::optional<std::chrono::sys_days>(date) : std::nullopt;
}

std::optional<ReplayReport> replay_of(const record::Record& record) {
  const auto& suts = record.header.suts;
  const auto replayed =
      std::ranges::find_if(suts, [](const auto& sut) { return sut.replay.has_value(); });
  if (replayed == suts.end()) return std::nullopt;
  std::set<std::string> unknown;
  for (const auto& interaction : record.interactions)
    for (const record::StageTime& time : interaction.message.stages)
      if (time.is_unknown) unknown.insert(time.stage);
  return ReplayReport{*replayed->replay, {unknown.begin(), unknown.end()}};
}

// Where the goal is missed, that can be why, also on a computer that is too slow.
void check_losses(TrialResult& result, const timing::Pace::Losses& losses) {
  const auto own = std::ranges::find(result.suts, losses.uav, &SutResult::uav);
  if (losses.count > 0 && own != result.suts.end() && own->reached_goal)
    result.warnings.push_back(doubt_about(losses.uav, losses.text()));
}

// Empty: it was reached.
std::string why_missed(const SutResult& sut) {
  if (!sut.finished) return fmt::format("the SUT of '{}' did not finish", sut.uav);
  if (sut.reached_goal) return "";
  return fmt::format("the SUT of '{}' did not reach its goal: {}", sut.uav, sut.outcome);
}

// The metrics of an abandoned task are meaningless: a UAV that never set out ends where it began,
// and at once.
void drop_metrics_of_missed_tasks(TrialResult& result, const scenario::Scenario& scenario) {
  for (const SutResult& sut : result.suts) {
    const std::string why = why_missed(sut);
    if (why.empty()) continue;
    for (std::size_t i = 0; i < result.metrics.size(); ++i) {
      if (scenario.metrics[i].uav != sut.uav || scenario.metrics[i].of_any_flight) continue;
      result.metrics[i].value.reset();
      result.metrics[i].missing_because = why;
    }
  }
}

/// With the digits in which it differs from another value.
std::string text_of(double value, double other, const std::string& unit) {
  const std::string number = distinct_text(value, other, 6);
  return unit == "1" ? number : number + " " + unit;
}

std::string why_missed(const judge::ClauseVerdict& clause) {
  std::string by;
  if (clause.margin)
    by = *clause.margin < 0.0 ? " by " + text_of(-*clause.margin, 0.0, clause.unit)
                              : ", because its bound was reached";
  return fmt::format("clause \"{}\" is missed{}: {}", clause.name, by, clause.limited_by);
}

std::string why_missed(const TrialResult& result) {
  for (const UavEnergy& energy : result.energy)
    if (energy.is_empty()) return fmt::format("the battery of '{}' is empty", energy.uav);
  for (const SutResult& sut : result.suts) {
    if (std::string why = why_missed(sut); !why.empty()) return why;
  }
  for (const judge::ClauseVerdict& clause : result.clauses) {
    if (!clause.met) return why_missed(clause);
  }
  for (const MetricValue& metric : result.metrics) {
    if (metric.is_met()) continue;
    if (!metric.value) return fmt::format("no {}: {}", metric.name, metric.missing_because);
    const bool is_less = metric.min && *metric.value < *metric.min;
    const double limit = is_less ? *metric.min : *metric.max;
    return fmt::format("{} is {}, {} its limit of {}", metric.name,
                       text_of(*metric.value, limit, metric.unit), is_less ? "below" : "beyond",
                       text_of(limit, *metric.value, metric.unit));
  }
  return "";
}

/// Which task of its mission a program left out or missed, although its mission cannot reach its
/// goal without that; empty: none.
std::string missed_task(const mission::Mission& mission,
                        const std::vector<judge::TaskSpan>& spans) {
  for (const mission::Task& task : mission.tasks) {
    if (task.on_miss.kind == mission::OnMiss::Kind::kContinue) continue;
    const judge::TaskSpan* last = nullptr;
    for (const judge::TaskSpan& span : spans)
      if (span.task == task.name) last = &span;
    if (last == nullptr) return fmt::format("never began '{}' of its mission", task.name);
    if (last->status != "reached")
      return fmt::format("ended '{}' of its mission as \"{}\"", task.name, last->status);
  }
  return "";
}

void judge_missions(TrialResult& result, const scenario::Scenario& scenario,
                    const record::Record& record) {
  for (const scenario::UavSetup& uav : scenario.uavs) {
    if (!uav.sut.mission) continue;
    judge::Verdicts verdicts = judge::judge(*uav.sut.mission, uav.placement.name, record);
    for (judge::ClauseVerdict& clause : verdicts.clauses)
      if (scenario.uavs.size() > 1) clause.name += ", " + uav.placement.name;
    const auto own = std::ranges::find(result.suts, uav.placement.name, &SutResult::uav);
    // A program as it is does not tell what task it flies.
    if (own != result.suts.end() && own->reached_goal && !own->as_is) {
      const std::string missed = verdicts.tasks.empty()
                                     ? "began no task of its mission"
                                     : missed_task(*uav.sut.mission, verdicts.tasks);
      if (!missed.empty())
        result.warnings.push_back(doubt_about(
            uav.placement.name, "has a program that says it reached its goal, but " + missed));
    }
    result.tasks.insert(result.tasks.end(), verdicts.tasks.begin(), verdicts.tasks.end());
    result.clauses.insert(result.clauses.end(), verdicts.clauses.begin(), verdicts.clauses.end());
  }
}

std::optional<StopFigures> stop_figures(const record::Record& record) {
  const auto& suts = record.header.suts;
  const bool is_synchronised = record.header.policy == record::kConservativeBarrier;
  if (!is_synchronised || std::ranges::none_of(suts, &record::SutInfo::concurrent))
    return std::nullopt;
  return StopFigures{record.footer->stops, record.footer->largest_overshoot};
}

// A SUT that was lost before it did anything was never set up.
std::string end_of(const record::Footer& footer) {
  const bool nothing_happened = footer.interactions == 0 && footer.end == "sut_lost";
  return nothing_happened ? std::string(kEndSetupFailed) : footer.end;
}

// A crash comes first among the reasons: it often is the cause of the others.
void settle(TrialResult& result, const std::string& reason_of_end, const std::string& crash = "") {
  const bool was_cut =
      result.end == kEndTimeLimit || result.end == kEndBatteryEmpty || result.end == kEndKilled;
  const bool ran = result.end == kEndFinished || was_cut;
  if (!ran) return invalidate(result, reason_of_end.empty() ? result.end : reason_of_end);
  std::string missed = was_cut ? reason_of_end : why_missed(result);
  if (!crash.empty()) missed = crash + (missed.empty() ? "" : "; " + missed);
  const bool reached = result.end == kEndFinished && missed.empty();
  result.outcome = reached ? Outcome::kGoalReached : Outcome::kGoalMissed;
  result.reason = reached ? "every SUT reached its goal within the limits"
                          : (missed.empty() ? "the time limit was reached" : missed);
}

}  // namespace

TrialResult make_result(const scenario::Scenario& scenario, const scenario::Condition& condition,
                        const record::Record& record, const std::vector<TaskEnd>& task_ends) {
  TrialResult result = result_of(scenario, condition, record.header.seed);
  result.metrics = compute_metrics(scenario.metrics, record);
  std::string never_began;
  result.suts = sut_results(record, task_ends, result.warnings, never_began);
  result.replay = replay_of(record);
  drop_metrics_of_missed_tasks(result, scenario);
  judge_missions(result, scenario, record);
  result.energy = energy_of(record, result.tasks);
  result.pace = timing::pace_of(record);
  if (result.pace)
    for (std::size_t i = 0; i < result.pace->speed.programs.size(); ++i)
      if (const auto& target = computer_of(condition, i).target)
        result.pace->speed.programs[i].cores = target->cores;
  if (result.pace) {
    check_losses(result, result.pace->losses);
    result.pace->unclear = unclear_times(record);
  }
  result.flight_digest = flight_digest(record);
  result.versions = {{"tether", record.header.tether_version},
                     {"simulator", record.header.simulator}};
  for (const record::SutInfo& sut : record.header.suts) {
    result.versions["sut of " + sut.uav] = sut.sut;
  }
  result.this_run.machine = record.header.machine;
  if (!record.footer) {
    result.end = "record_cut";
    result.sync.interactions = record.interactions.size();
    result.sync.st_at_end = record::last_time(record);
    settle(result, "the record is " + record::describe_damage(record));
    return result;
  }
  const record::Footer& footer = *record.footer;
  result.end = never_began.empty() ? end_of(footer) : std::string(kEndSetupFailed);
  result.sync = {footer.interactions, footer.causality_violations, footer.largest_grid_error,
                 footer.st_at_end, stop_figures(record)};
  result.this_run.wall = footer.wall;
  result.this_run.largest_lag = footer.largest_lag;
  const double max_speed_m_s = scenario.max_contact_speed_m_s;
  result.contacts = contacts_of(record, max_speed_m_s);
  settle(result, (never_began.empty() ? footer.reason : never_began) + where_to_find(record),
         why_crashed(record, max_speed_m_s));
  return result;
}

std::string contradiction_in(const TrialResult& result) {
  for (const judge::ClauseVerdict& clause : result.clauses)
    if (clause.met && clause.margin && *clause.margin < 0.0)
      return fmt::format("clause \"{}\" is met by {} {}", clause.name, *clause.margin, clause.unit);
  const std::string missed = why_missed(result);
  if (result.outcome == Outcome::kGoalReached)
    return result.end == kEndFinished ? missed : "the end is \"" + result.end + "\"";
  const bool has_crashed = std::ranges::any_of(
      result.contacts, [](const UavContacts& contacts) { return contacts.hard > 0; });
  const bool could_reach = result.end == kEndFinished && missed.empty() && !has_crashed;
  return result.outcome == Outcome::kGoalMissed && could_reach ? "nothing is missed" : "";
}

record::EmulatorInfo emulator_of(const scenario::Condition& condition) {
  record::EmulatorInfo info;
  for (const scenario::Computer& computer : condition.computers) {
    if (!computer.target || !computer.target->emulator) continue;
    const os::Emulator& emulator = *computer.target->emulator;
    info = {emulator.program, emulator.cpu_model, {}};
    for (std::size_t kind = 0; kind < kWorkClasses; ++kind)
      info.costs.push_back({kWorkClassNames[kind], static_cast<double>(emulator.cost_units[kind]) /
                                                       static_cast<double>(kCostUnitsPerNs)});
  }
  return info;
}

std::string describe_replay(const TrialResult& result) {
  if (!result.replay) return "";
  const record::ReplayInfo& from = result.replay->from;
  const auto recorded = day_of(from.recorded_at), flown = day_of(result.this_run.started_at);
  const std::string age =
      recorded && flown ? fmt::format(" ({} days before)", (*flown - *recorded).count()) : "";
  std::string text = record::describe(from) + age;
  if (!result.replay->unknown_stages.empty())
    text += fmt::format("; not recorded: {}", fmt::join(result.replay->unknown_stages, ", "));
  return text;
}

void invalidate(TrialResult& result, const std::string& reason) {
  result.outcome = Outcome::kFailed;
  result.reason = reason;
  result.pace.reset();
  for (MetricValue& metric : result.metrics) {
    metric.value.reset();
    metric.missing_because = reason;
  }
  for (judge::ClauseVerdict& clause : result.clauses) {
    clause.met = false;
    clause.margin.reset();
    clause.margins.clear();
    clause.decided_at.reset();
    clause.limited_by = reason;
  }
}

TrialResult make_setup_failure(const scenario::Scenario& scenario,
                               const scenario::Condition& condition, std::uint64_t seed,
                               const std::string& reason) {
  TrialResult result = result_of(scenario, condition, seed);
  result.end = kEndSetupFailed;
  result.metrics = compute_metrics(scenario.metrics, record::Record{});
  for (MetricValue& metric : result.metrics) metric.missing_because = "the trial was not set up";
  judge_missions(result, scenario, record::Record{});
  settle(result, reason);
  return result;
}

}  // namespace tether::campaign
