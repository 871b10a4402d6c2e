#include "commands/commands.h"
#include "commands/size_flights.h"
#include "commands/size_uavs.h"
#include "options/junit_option.h"
#include "options/refuse_option.h"
#include "options/trial_options.h"
#include "reading/file_kind.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/program.h>
#include <tether/report/junit.h>
#include <tether/report/size_report.h>
#include <tether/runner/target_choice.h>
#include <tether/scenario/shipped_files.h>
#include <tether/scenario/slowness.h>

/// `tether size`: checks the question, flies until it is answered, and writes the answer.
namespace tether::app {

namespace {

constexpr double kLargestFactor = 1e4;  // as in files

void require_share(const std::string& option, double share) {
  if (share > 0.0 && share < 1.0) return;
  refuse_option(option,
                fmt::format("{} is not between 0 and 1. {}", share,
                            share == 1.0 ? "No number of flights shows that for certain; use a "
                                           "share such as 0.95."
                                         : "Use a share such as 0.9."));
}

sizing::Question question_of(const SizeOptions& options) {
  const std::vector<double> between = options.between.value_or(std::vector<double>{1.0, 40.0});
  const sizing::Question question{.success = options.success,
                                  .confidence = options.confidence,
                                  .interval = options.interval.value_or(1.3),
                                  .least = between.at(0),
                                  .most = between.at(1)};
  if (!(question.interval >= 1.05))
    refuse_option("--interval",
                  fmt::format("{} is less than 1.05. It is the upper bound of the answer "
                              "divided by its lower bound, such as 1.3.",
                              question.interval));
  if (!(question.least > 0.0 && question.least < question.most))
    refuse_option("--between",
                  fmt::format("{},{} is not a range of slowdowns. The first must be above 0 "
                              "and less than the second, as in 1,40.",
                              question.least, question.most));
  if (question.most < question.interval * question.least)
    refuse_option("--between",
                  fmt::format("{},{} is narrower than --interval {}. Use a wider range, "
                              "or a smaller --interval.",
                              question.least, question.most, question.interval));
  require_enough_trials(options, 1.0 - question.confidence);
  return question;
}

report::Board board_of(const scenario::ShippedFiles& shipped, const std::filesystem::path& given,
                       const scenario::Scenario& scenario, const scenario::Condition& condition) {
  if (std::holds_alternative<scenario::SshAddress>(runner::parse_target_choice(given.string())))
    refuse_option(
        "--target",
        fmt::format("{} is a real board, which cannot be slowed down. Calibrate a virtual "
                    "target against it (tether-sut calibrate --write-target FILE), and "
                    "give that file.",
                    given.string()));
  const std::filesystem::path file = shipped.find(scenario::ShippedKind::kTarget, given);
  require_kind(file, FileKind::kTarget);
  const auto [factor, bounds] =
      scenario::slowness(scenario::load_target(file), scenario, condition);
  report::Board board{.name = file.filename().string(), .slowdown = factor};
  if (bounds) {
    board.low = bounds->first;
    board.high = bounds->second;
  }
  return board;
}

/// What --unsynchronised names: a condition that differs in nothing but its policy.
void require_comparable(const scenario::Condition& own, const scenario::Condition& other) {
  const bool is_free = other.policy == scenario::Policy::kFreeRunning &&
                       own.policy == scenario::Policy::kConservativeBarrier;
  if (!is_free)
    refuse_option("--unsynchronised",
                  fmt::format("\"{}\" must have policy = \"free_running\", and \"{}\" "
                              "policy = \"conservative_barrier\".",
                              other.name, own.name));
  if (computer_of(own, 0).clock != computer_of(other, 0).clock)
    refuse_option("--unsynchronised",
                  fmt::format("\"{}\" and \"{}\" must have the same clock and factor.", other.name,
                              own.name));
}

struct Plan {
  report::SizeReport report;
  SizeFlights::Setup flights;
};

/// Reads and checks everything that does not need the output folder.
Plan make_plan(const SizeOptions& options) {
  Plan plan;
  plan.report.question = question_of(options);
  plan.report.most_flights = options.max_trials;
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  scenario::Scenario scenario = load_sized_scenario(options);
  const scenario::Condition own = scenario::pick_condition(scenario, options.condition);
  if (own.policy == scenario::Policy::kFreeRunning)
    refuse_option("--condition",
                  fmt::format("\"{}\" is free-running, and its flights say nothing about the "
                              "computer. Size a condition with policy = \"conservative_barrier\", "
                              "and name this one with --unsynchronised to compare both.",
                              own.name));
  if (computer_of(own, 0).clock.factor * plan.report.question.most > kLargestFactor)
    refuse_option("--between",
                  fmt::format("{} times the factor of condition \"{}\" is more than {}.",
                              plan.report.question.most, own.name, kLargestFactor));
  for (const std::filesystem::path& target : options.targets)
    plan.report.boards.push_back(board_of(shipped, target, scenario, own));
  plan.report.scenario = scenario.name;
  plan.report.description = scenario.description;
  plan.flights.conditions = {own};
  if (!options.unsynchronised.empty()) {
    plan.flights.conditions.push_back(scenario::pick_condition(scenario, options.unsynchronised));
    require_comparable(own, plan.flights.conditions.back());
  }
  plan.flights.scenario = std::move(scenario);
  return plan;
}

int code_of(const report::SizeReport& report) {
  if (report::has_unseen_time(report)) return exit_code(ErrorCode::kSetup);
  const bool is_good =
      report.boards.empty()
          ? report::is_answered(report)
          : std::ranges::all_of(report.boards, [&](const report::Board& board) {
              return report::verdict(board, report) == report::BoardVerdict::kSuffices;
            });
  return is_good ? 0 : 1;
}

int find_size(const SizeOptions& options, const std::stop_token& stop) {
  Plan plan = make_plan(options);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out/size") / plan.report.scenario : options.out;
  const sizing::CurveGrid grid(plan.report.question);
  SizeFlights flights(options, plan.flights, grid, out, stop);
  report::SizeReport& report = plan.report;
  if (const auto end = flights.fly(report); end != SizeTrials::End::kAnswered)
    return flights.say_why(end);
  report.pace = report::pace_near_answer(report);
  write_answer(
      {report::size_answers(report), report::size_advice(report), report::size_json(report),
       report::size_plot(report), report::size_page(report), report::to_junit(report, out)},
      out, options.junit);
  return code_of(report);
}

int size(const SizeOptions& options, const std::stop_token& stop) {
  return with_junit(options.junit, options.scenario.string(), [&] {
    require_share("--success", options.success);
    require_share("--confidence", options.confidence);
    return options.axis == "uavs" ? find_uavs(options, stop) : find_size(options, stop);
  });
}

Options size_rows(SizeOptions& o) {
  return concatenated(
      {{scenario_argument(o.scenario),
        {"--axis",
         "What to vary: how slow the computer may be, or how many UAVs it carries. With uavs, "
         "--target, --interval and --unsynchronised are rejected",
         &o.axis, one_of({"slowdown", "uavs"})},
        condition_option(o.condition),
        {"--target TARGET",
         "Virtual target to evaluate, several times if you like: name of a shipped target, or a "
         "file (TOML)",
         &o.targets},
        {"--success SHARE", "Share of flights that must reach the goal, above 0 and below 1",
         &o.success},
        {"--confidence SHARE", "Confidence of the answer's interval, above 0 and below 1",
         &o.confidence},
        {"--interval FACTOR",
         "Stop when its upper bound is at most so many times the lower one [1.3]", &o.interval},
        {"--between LEAST,MOST",
         "Slowdowns [1,40], or numbers of UAVs [1, all], to fly: LEAST,MOST",
         &o.between,
         {.has_commas = true, .count = 2}},
        {"--max-trials", "Maximum number of flights", &o.max_trials, range(1, 10000)},
        {"--unsynchronised NAME",
         "Condition without synchronisation to compare: fly it with the same slowdowns and seeds, "
         "which doubles the flights",
         &o.unsynchronised},
        {"--out FOLDER",
         "Folder for the flights, report.html, size.svg and size.json [out/size/SCENARIO; for "
         "UAVs, SCENARIO-uavs]",
         &o.out},
        resume_option(o.resume),
        {"--force", "Remove the earlier flights in the folder", &o.force}},
       engine_options(o.engine),
       {junit_option(o.junit), simulator_option(o.simulator)},
       reading_options(o.reading)});
}

}  // namespace

Command size_command() {
  return make_command(
      "size", "Find the slowest sufficient computer, or how many UAVs it carries", size_rows,
      R"(Exit codes: 0 every --target is sufficient, or none is given, some computer of --between is, and
the answer is as narrow as --interval asks (of UAVs: decided), 1 otherwise, 2 wrong use or a bad
file, 3 interrupted, or flights failed.

Examples:
  tether size face_anchor --condition target
  tether size face_anchor --target six_times_slower --jobs 2
  tether size face_anchor --success 0.95 --interval 1.2 --max-trials 600
  tether size face_anchor --condition target --unsynchronised "target, no sync"
  tether size four_on_one_board --axis uavs)",
      size);
}

}  // namespace tether::app
