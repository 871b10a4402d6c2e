#include "commands/size_axis.h"
#include "options/refuse_option.h"
#include "reading/file_kind.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <tether/os/child_process.h>
#include <tether/runner/trial_request.h>
#include <tether/scenario/scenario.h>
#include <tether/scenario/shipped_files.h>
#include <tether/sizing/sizing.h>

namespace tether::app {

namespace {

constexpr double kLargestFactor = 1e4;  // as in files

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

bool has_margins(const scenario::Scenario& scenario) {
  return std::ranges::any_of(scenario.metrics, [](const scenario::Metric& metric) {
    campaign::MetricValue value{metric.name, metric.kind, metric.label, metric.unit, 0.0, "", {}};
    value.max = metric.max;
    value.min = metric.min;
    return report::margin_of(value).has_value();
  });
}

/// A campaign whose conditions are the slowed ones.
class SlowdownAxis final : public SizeAxis {
 public:
  /// @param conditions the one to size; then, if it is wanted, the one without synchronisation
  SlowdownAxis(const SizeOptions& options, const scenario::Scenario& scenario,
               const std::vector<scenario::Condition>& conditions, report::SizeReport report)
      : SizeAxis(options, scenario), grid_(report.question), report_(std::move(report)) {
    folder = scenario.name;
    searched = grid_.slowdowns().size();
    scenario::CampaignScenario entry{scenario, {}, ""};
    entry.scenario.conditions.clear();
    for (const scenario::Condition& condition : conditions) {
      sized_.push_back({sizing::Sizing(grid_, has_margins(scenario)), {condition.name}, {}});
      for (const double slowdown : grid_.slowdowns()) {
        entry.scenario.conditions.push_back(condition);
        scenario::slow_down(entry.scenario.conditions.back(), slowdown);
        entry.conditions.push_back(entry.scenario.conditions.back().name);
        levels.emplace_back(scenario.name, entry.conditions.back());
      }
    }
    campaign.scenarios.push_back(std::move(entry));
  }

  sizing::Axis& search() override { return sized_.front().sizing; }
  std::string name_of(const campaign::TrialPlan& plan) const override {
    return "“" + plan.condition->name + "”";
  }
  bool add(std::size_t level, const campaign::TrialResult& trial) override {
    auto& [sizing, sized, flown] = sized_[level / searched];
    const bool is_copy = report::add_flight(sized, trial, grid_.slowdowns()[level % searched]);
    if (is_copy) {
      sizing.skip_copy();
    } else {
      sizing.add(sized.flights.back());
      flown.push_back({level, trial.seed});
    }
    return is_copy;
  }
  // The same slowdowns and seeds, so that both differ in the synchronisation only.
  std::vector<sizing::Wanted> also() const override {
    if (sized_.size() == 1) return {};
    std::vector<sizing::Wanted> same = sized_.front().flown;
    for (sizing::Wanted& wanted : same) wanted.level += searched;
    return same;
  }
  report::SizeAnswer answer(const report::SearchOutcome& outcome) override {
    static_cast<report::SearchOutcome&>(report_) = outcome;
    sized_.front().sized.answer = sized_.front().sizing.latest();
    if (sized_.size() > 1) sized_.back().sized.answer = sized_.back().sizing.answer(true);
    for (auto& [sizing, sized, flown] : sized_)
      sized.curve = report::curve_points(sizing.curve(), report_.question);
    report_.synchronised = sized_.front().sized;
    if (sized_.size() > 1 && !report_.is_interrupted) report_.unsynchronised = sized_.back().sized;
    report_.pace = report::pace_near_answer(report_);
    return report::size_answer(report_);
  }

 private:
  struct Sized {
    sizing::Sizing sizing;
    report::SizedCondition sized;
    std::vector<sizing::Wanted> flown;  // without copies
  };

  sizing::CurveGrid grid_;
  report::SizeReport report_;
  std::vector<Sized> sized_{};  // of each condition
};

}  // namespace

std::unique_ptr<SizeAxis> slowdown_axis(const SizeOptions& options) {
  const sizing::Question question = question_of(options);
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  const scenario::Scenario scenario = load_sized_scenario(options);
  const scenario::Condition own = scenario::pick_condition(scenario, options.condition);
  if (own.policy == scenario::Policy::kFreeRunning)
    refuse_option("--condition",
                  fmt::format("\"{}\" is free-running, and its flights say nothing about the "
                              "computer. Size a condition with policy = \"conservative_barrier\", "
                              "and name this one with --unsynchronised to compare both.",
                              own.name));
  if (computer_of(own, 0).clock.factor * question.most > kLargestFactor)
    refuse_option("--between",
                  fmt::format("{} times the factor of condition \"{}\" is more than {}.",
                              question.most, own.name, kLargestFactor));
  report::SizeReport report;
  report.scenario = scenario.name;
  report.question = question;
  report.most_flights = options.max_trials;
  for (const std::filesystem::path& target : options.targets)
    report.boards.push_back(board_of(shipped, target, scenario, own));
  std::vector<scenario::Condition> conditions = {own};
  if (!options.unsynchronised.empty()) {
    conditions.push_back(scenario::pick_condition(scenario, options.unsynchronised));
    require_comparable(own, conditions.back());
  }
  return std::make_unique<SlowdownAxis>(options, scenario, conditions, std::move(report));
}

}  // namespace tether::app
