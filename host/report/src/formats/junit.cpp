#include "plots/svg.h"
#include "tables/report_format.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/result.h>
#include <tether/os/machine.h>
#include <tether/report/junit.h>
#include <tether/report/report.h>
#include <tether/report/verdict.h>

namespace tether::report {
namespace {

struct Case {
  std::string trial{};  ///< "seed-0001"
  std::string name{};
  double time_s = 0.0;
  std::string kind{};     ///< "failure" or "error"; empty: passed
  std::string type{};     ///< what it is a case of
  std::string message{};  ///< of a case that did not pass
  std::string output{};   ///< one line each
};

struct Suite {
  std::string name;
  /// Now, unless it is known; without a zone, as the schema wants it.
  std::string started_at = os::utc_now().substr(0, std::string_view("1970-01-01T00:00:00").size());
  std::string machine = "unknown";
  std::vector<std::pair<std::string, std::string>> properties{};
  std::vector<Case> cases{};

  std::ptrdiff_t count(std::string_view kind) const {
    return std::ranges::count(cases, kind, &Case::kind);
  }
};

/// What makes a case of a trial no pass: an error if the trial failed, else a failure.
void fail(Case& one, const campaign::TrialResult& trial, const std::string& why) {
  one.kind = trial.outcome == campaign::Outcome::kFailed ? "error" : "failure";
  one.message = why;
}

Case outcome_case(const campaign::TrialResult& trial) {
  Case one{.name = "outcome", .time_s = to_seconds(trial.this_run.wall), .type = "outcome"};
  if (trial.outcome != campaign::Outcome::kGoalReached) fail(one, trial, trial.reason);
  if (const campaign::TrialResult* const only = &trial; trial.has_unseen_time())
    if (const auto unseen = unseen_answer(trial.condition, {&only, 1})) {
      one.kind = "error";
      one.message = unseen->lead + unseen->rest;
    }
  one.output = trial.reason + "\n";
  for (const std::string& note : trial.this_run.notes) one.output += "note: " + note + "\n";
  return one;
}

Case metric_case(const campaign::TrialResult& trial, const campaign::MetricValue& metric) {
  Case one{.name = metric.label, .type = "metric"};
  const std::string unit = metric.unit == "1" ? "" : " " + metric.unit;
  one.output =
      fmt::format("value: {}\nlimit: {}{}\n", metric.value ? exact(*metric.value) + unit : kNone,
                  limit_text(metric), metric.max || metric.min ? unit : "");
  if (metric.is_met()) return one;
  fail(one, trial,
       metric.value ? fmt::format("{}{} is beyond its limit of {}{}", *metric.value, unit,
                                  limit_text(metric), unit)
                    : "no value: " + metric.missing_because);
  return one;
}

Case clause_case(const campaign::TrialResult& trial, const judge::ClauseVerdict& clause) {
  Case one{.name = clause.name, .type = "clause"};
  const std::string margin =
      clause.margin ? fmt::format("{:.6g} {}", *clause.margin, clause.unit) : std::string(kNone);
  one.output = fmt::format("margin: {}\n", margin);
  if (clause.decided_at)
    one.output += fmt::format("decided at ST: {:.6f} s\n", to_seconds(*clause.decided_at));
  one.output += fmt::format("limited by: {}\n", clause.limited_by);
  if (!clause.met)
    fail(one, trial,
         clause.margin ? fmt::format("margin {}: {}", margin, clause.limited_by)
                       : clause.limited_by);
  return one;
}

void add_start(Suite& suite, const campaign::TrialResult& trial) {
  const std::string& started = trial.this_run.started_at;
  if (started.size() >= suite.started_at.size())
    suite.started_at = started.substr(0, suite.started_at.size());
  if (!trial.this_run.machine.empty()) suite.machine = trial.this_run.machine;
}

void add_trial(Suite& suite, const campaign::TrialResult& trial,
               const std::filesystem::path& folder) {
  std::vector<Case> cases = {outcome_case(trial)};
  for (const campaign::MetricValue& metric : trial.metrics)
    cases.push_back(metric_case(trial, metric));
  for (const judge::ClauseVerdict& clause : trial.clauses)
    cases.push_back(clause_case(trial, clause));
  const std::filesystem::path record = folder / "record.mcap";
  for (Case& one : cases) {
    one.trial = fmt::format("seed-{:04}", trial.seed);
    if (std::filesystem::exists(record)) one.output += "record: " + record.string() + "\n";
    suite.cases.push_back(std::move(one));
  }
  add_start(suite, trial);
}

std::string text_of(const Case& one, const std::string& suite) {
  std::string text = fmt::format(R"(    <testcase classname="{}.{}" name="{}" time="{:.3f}">)",
                                 escape_markup(suite), escape_markup(one.trial),
                                 escape_markup(one.name), one.time_s);
  if (!one.kind.empty())
    text += fmt::format("\n      <{0} type=\"{1}\" message=\"{2}\">{3}</{0}>\n    ", one.kind,
                        one.type, escape_markup(one.message), escape_markup(one.output));
  return text + "</testcase>\n";
}

// A case that passed has no text of its own in the schema, so the suite has that of all.
std::string output_of(const Suite& suite) {
  std::string text;
  for (const Case& one : suite.cases)
    text += fmt::format("[{} / {}]\n{}", one.trial, one.name, one.output);
  return text;
}

std::string text_of(const Suite& suite, std::size_t id) {
  double time_s = 0.0;
  for (const Case& one : suite.cases) time_s += one.time_s;
  std::string text = fmt::format(
      "  <testsuite id=\"{}\" package=\"tether\" name=\"{}\" timestamp=\"{}\" hostname=\"{}\" "
      "tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\">\n",
      id, escape_markup(suite.name), suite.started_at, escape_markup(suite.machine),
      suite.cases.size(), suite.count("failure"), suite.count("error"), time_s);
  text += "    <properties>\n";
  for (const auto& [name, value] : suite.properties)
    text += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", name, escape_markup(value));
  text += "    </properties>\n";
  for (const Case& one : suite.cases) text += text_of(one, suite.name);
  return text + fmt::format("    <system-out>{}</system-out>\n    <system-err/>\n  </testsuite>\n",
                            escape_markup(output_of(suite)));
}

std::string text_of(const std::vector<Suite>& suites) {
  std::string text(campaign::kJunitBegin);
  for (std::size_t i = 0; i < suites.size(); ++i) text += text_of(suites[i], i);
  return text + "</testsuites>\n";
}

Case error_case(const std::string& trial, const std::string& message) {
  return {.trial = trial,
          .name = "outcome",
          .kind = "error",
          .type = "outcome",
          .message = message,
          .output = message + "\n"};
}

}  // namespace

std::string to_junit(const campaign::CampaignResults& results,
                     const std::filesystem::path& folder) {
  const bool is_run = std::filesystem::exists(folder / campaign::kResultFile);
  const std::vector<Verdict> verdicts = verdicts_of(results);
  std::vector<Suite> suites;
  for (std::size_t i = 0; i < results.scenarios.size(); ++i) {
    const campaign::ScenarioResults& scenario = results.scenarios[i];
    for (std::size_t j = 0; j < scenario.conditions.size(); ++j) {
      const campaign::ConditionResults& condition = scenario.conditions[j];
      Suite suite{.name = fmt::format("{}, {}", scenario.scenario, condition.condition)};
      const Answer answer = answer_of(verdicts[i].conditions[j]);
      suite.properties.emplace_back("verdict", answer.lead + answer.rest);
      if (const auto slowest = slowest_board(verdicts[i].conditions[j]))
        suite.properties.emplace_back("slowest board", slowest->lead + slowest->rest);
      for (const std::uint64_t seed : results.manifest.seeds) {
        const auto trial = std::ranges::find(condition.trials, seed, &campaign::TrialResult::seed);
        if (trial == condition.trials.end())
          suite.cases.push_back(error_case(fmt::format("seed-{:04}", seed),
                                           "the trial has no result: it did not run to its end"));
        else
          add_trial(suite, *trial,
                    is_run ? folder
                           : folder / campaign::trial_folder(scenario.scenario, condition.condition,
                                                             seed));
      }
      suites.push_back(std::move(suite));
    }
  }
  return text_of(suites);
}

std::string to_junit(const SizeAnswer& answer, const std::filesystem::path& folder) {
  std::vector<std::string> sentences;
  for (const Answer& one : answer.answers) sentences.push_back(one.lead + one.rest);
  Suite suite{.name = "size of " + answer.scenario};
  suite.properties = {{"verdict", sentences.front()}};
  double time_s = 0.0;
  for (const campaign::TrialResult* trial : answer.trials) {
    add_start(suite, *trial);
    time_s += to_seconds(trial->this_run.wall);
  }
  const auto add = [&](const std::string& name, const char* type, bool is_passed,
                       const std::string& sentence) {
    suite.cases.push_back({.trial = answer.condition,
                           .name = name,
                           .time_s = suite.cases.empty() ? time_s : 0.0,
                           .kind = is_passed ? "" : "failure",
                           .type = type,
                           .message = is_passed ? "" : sentence,
                           .output = sentence + "\nflights: " + folder.string() + "\n"});
  };
  add("answer", "answer", answer.is_answered, fmt::format("{}", fmt::join(sentences, "\n")));
  for (const auto& [board, suffices, of_board] : answer.boards)
    add(board, "board", suffices, of_board.lead + of_board.rest);
  return text_of(std::vector<Suite>{suite});
}

std::string change_junit(const timing::Timing& now, const timing::Timing& before,
                         const timing::Comparison& comparison, double limit) {
  Suite suite{.name = "timing of " + now.scenario, .machine = now.board};
  if (now.recorded_at.size() >= suite.started_at.size())
    suite.started_at = now.recorded_at.substr(0, suite.started_at.size());
  suite.properties = {{"build", now.build_id}, {"build before", before.build_id}};
  for (const timing::StageChange& stage : comparison.stages) {
    const std::string line =
        timing::to_text({.stages = {stage}, .added = {}, .removed = {}}, &limit);
    const std::string doubt = comparison.doubt.empty() ? "" : comparison.doubt + '\n';
    const bool is_beyond = stage.change > limit;
    suite.cases.push_back({.trial = "stages",
                           .name = stage.stage,
                           .kind = is_beyond ? "failure" : "",
                           .type = "stage",
                           .message = is_beyond ? line.substr(0, line.size() - 1) : "",
                           .output = line + doubt});
  }
  const std::string others = timing::to_text(
      {.stages = {}, .added = comparison.added, .removed = comparison.removed}, &limit);
  if (!others.empty()) suite.properties.emplace_back("other stages", others);
  return text_of(std::vector<Suite>{suite});
}

std::string junit_of_error(const std::string& name, const std::string& message) {
  Suite suite{.name = name};
  suite.cases = {error_case("run", message)};
  return text_of({suite});
}

}  // namespace tether::report
