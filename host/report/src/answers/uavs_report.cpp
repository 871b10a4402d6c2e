#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/campaign_results.h>
#include <tether/os/child_process.h>
#include <tether/report/size_report.h>

namespace tether::report {
namespace {

std::string uavs(std::size_t count) {
  return counted(count, "UAV");
}

std::string in_percent(double share) {
  return fmt::format("{:.4g} %", 100.0 * share);
}

/// "with 1 UAV 36 of 36 flights reach the goal, with 2 UAVs 0 of 2"
std::string evidence_of(const UavsReport& report) {
  std::vector<std::string> parts;
  for (const sizing::UavLevel& level : uav_levels(report.points))
    parts.push_back(fmt::format("with {} {} of {}{}", uavs(level.uavs), level.reached,
                                level.flights, parts.empty() ? " flights reach the goal" : ""));
  return parts.empty() ? "nothing was flown" : joined_with_and(parts);
}

/// Whether it is shown that the board is too slow for that many UAVs: their program does not read
/// all images. Else the one that was added may miss the goal for a reason of its own.
bool is_shown(const UavsReport& report) {
  const auto& pace = report.pace.pace;
  return report.answer.too_many > report.question.most || !pace || pace->shares_real_board ||
         !pace->keeps_up();
}

/// Of the computing of an image, where too many share the board. Less does not tell.
constexpr double kWaitingThatTells = 0.1;

/// The flights with too many UAVs miss the goal, although no program waits for cores, or hardly.
bool is_not_for_sharing(const UavsReport& report) {
  const auto& pace = report.pace.pace;
  if (report.answer.too_many > report.question.most || !pace || pace->shares_real_board)
    return false;
  const bool has_own_core = pace->shared_board.empty();
  return has_own_core || (!pace->camera.empty() && pace->waiting < kWaitingThatTells);
}

std::string lead_of(const UavsReport& report) {
  const auto& [carried, too_many, next] = report.answer;
  if (is_not_for_sharing(report))
    return fmt::format("Goal missed with {}; that they share the board is probably not the reason",
                       uavs(too_many));
  if (!is_shown(report))
    return fmt::format("Goal missed with {}; whether sharing the board is the reason is not known",
                       uavs(too_many));
  const std::size_t least = report.question.least, most = report.question.most;
  if (!report.answer.is_decided() && too_many > most)
    return carried < least
               ? fmt::format("It is not known whether this board carries {}", uavs(least))
               : fmt::format("This board carries at least {}", uavs(carried));
  if (!report.answer.is_decided())
    return fmt::format("This board carries {} to {}", carried < least ? 0 : carried,
                       uavs(too_many - 1));
  if (carried < least) return fmt::format("This board does not carry {}", uavs(least));
  return fmt::format("This board carries {}{}", carried == most ? "at least " : "", uavs(carried));
}

}  // namespace

std::vector<sizing::UavLevel> uav_levels(const std::vector<UavsPoint>& points) {
  std::vector<sizing::UavLevel> levels;
  for (const UavsPoint& point : points)
    if (point.level.flights > 0) levels.push_back(point.level);
  return levels;
}

bool add_flight(UavsPoint& to, const campaign::TrialResult& trial) {
  const bool is_copy = std::ranges::any_of(
      to.trials, [&](const auto& earlier) { return campaign::are_copies(earlier, trial); });
  to.trials.push_back(trial);
  if (is_copy) return true;
  ++to.level.flights;
  to.level.reached += trial.outcome == campaign::Outcome::kGoalReached ? 1U : 0U;
  return false;
}

PaceOrReason pace_at_limit(const UavsReport& report) {
  const campaign::TrialResult* trial = nullptr;
  for (const UavsPoint& point : report.points) {
    if (point.trials.empty()) continue;
    trial = &point.trials.front();
    if (point.level.uavs >= report.answer.too_many) break;
  }
  return trial ? pace_or_reason(*trial) : PaceOrReason{};
}

std::size_t flights_of(const UavsReport& report) {
  std::size_t flights = 0;
  for (const UavsPoint& point : report.points) flights += point.trials.size();
  return flights;
}

bool is_answered(const UavsReport& report) {
  const bool is_unseen = std::ranges::any_of(report.points, [](const UavsPoint& point) {
    return std::ranges::any_of(point.trials, &campaign::TrialResult::has_unseen_time);
  });
  return report.answer.is_decided() && report.answer.carried >= report.question.least &&
         is_shown(report) && !is_not_for_sharing(report) && !is_unseen;
}

std::vector<Answer> uavs_answers(const UavsReport& report) {
  std::vector<const campaign::TrialResult*> trials;
  for (const UavsPoint& point : report.points)
    for (const campaign::TrialResult& trial : point.trials) trials.push_back(&trial);
  if (auto unseen = unseen_answer(report.condition, trials)) return {*std::move(unseen)};
  std::vector<Answer> answers = {
      {lead_of(report) + reservation_on(trials),
       fmt::format(" (“{}” under “{}”, {} of the flights wanted): {}; {}; {}.", report.board,
                   report.condition, in_percent(report.question.success), evidence_of(report),
                   in_percent(report.question.confidence), counted(flights_of(report), "flight"))}};
  if (report.is_interrupted) answers.back().lead.insert(0, kSoFar);
  if (const auto& pace = report.pace.pace;
      pace && !pace->shared_board.empty() && !pace->camera.empty())
    answers.push_back(
        {"What sharing costs",
         fmt::format(": with {}, an image costs {} on the board, {:.0f} % of it waiting for cores.",
                     uavs(pace->programs), short_ms(pace->median_s), 100.0 * pace->waiting)});
  const std::size_t copies = copies_in(report);
  if (!report.answer.is_decided())
    answers.push_back(
        {"Less sure than asked", report.is_interrupted ? ": the search was interrupted."
                                 : copies >= sizing::kMostCopies
                                     ? ": the seeds change too little."
                                     : fmt::format(": no more than {} were allowed.",
                                                   counted(report.most_flights, "flight"))});
  if (copies > 0)
    answers.push_back({"Not counted", fmt::format(": {}, each a copy of another one, because its "
                                                  "seed changes nothing.",
                                                  counted(copies, "flight"))});
  std::ranges::move(answers_on_flights(trials, report.pace.unknown), std::back_inserter(answers));
  return answers;
}

std::size_t copies_in(const UavsReport& report) {
  std::size_t copies = flights_of(report);
  for (const sizing::UavLevel& level : uav_levels(report.points)) copies -= level.flights;
  return copies;
}

std::vector<std::string> uavs_advice(const UavsReport& report) {
  std::vector<std::string> advice;
  const sizing::UavAnswer& answer = report.answer;
  if (!answer.is_decided() && !report.is_interrupted)
    advice.emplace_back(copies_in(report) >= sizing::kMostCopies
                            ? kVarySeeds
                            : "Fly more: `--max-trials`, with `--resume`.");
  if (answer.is_decided() && answer.carried == report.question.most)
    advice.emplace_back(
        "To find the limit, add UAVs to the scenario, or fly more of them with `--between`.");
  if (answer.is_decided() && answer.carried < report.question.least && report.question.least > 1)
    advice.push_back(fmt::format("Try fewer: `--between 1,{}`.", report.question.least));
  if (answer.too_many <= report.question.most) {
    const bool is_for_sharing = !is_not_for_sharing(report) && is_shown(report);
    if (!is_for_sharing)
      advice.push_back(fmt::format(
          "Look at what the added UAV does: `tether run {} --condition {} --set uavs={}`",
          os::shell_word(report.named), os::shell_word(report.condition), answer.too_many));
    if (const auto& pace = report.pace.pace; is_for_sharing && pace && !pace->stages.empty())
      advice.push_back(fmt::format(
          "To carry {}, speed up “{}” first: it takes {:.0f} % of the computing time.",
          answer.is_decided() && answer.carried < report.question.least ? "them" : "more",
          pace->stages.front().stage, 100.0 * pace->stages.front().share));
    advice.push_back(
        fmt::format("To see whether a faster board carries all, and how much faster: `tether "
                    "size {} --condition {} --between 0.1,2`",
                    os::shell_word(report.named), os::shell_word(report.condition)));
  }
  return advice;
}

}  // namespace tether::report
