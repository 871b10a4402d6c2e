#include "answers/board_pace.h"
#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <tether/base/text_table.h>
#include <tether/os/shell_word.h>
#include <tether/report/verdict.h>

// The words of a verdict.
namespace tether::report {
namespace {

constexpr std::size_t kMostMissed = 3;  // that a sentence names
constexpr double kLeastShare = 0.001;   // of a stage in tables

std::string capital(std::string_view text) {
  std::string with(text);
  if (!with.empty() && with[0] >= 'a' && with[0] <= 'z') with[0] = static_cast<char>(with[0] - 32);
  return with;
}

/// "9", "0.4"
std::string rate(double hz) {
  return fixed(hz, hz < 9.95 ? 1 : 0);
}

std::string headroom_text(const Pace& pace) {
  const std::optional<double> headroom = pace.headroom();
  return headroom ? fmt::format("{:.2g} ×", *headroom) : kNone;
}

std::string flights(std::size_t count) {
  return fmt::format("{} flight{}", count, count == 1 ? "" : "s");
}

/// "the camera is read 9 times a second instead of 30, and “detect” takes 81 % of the computing
/// time"; empty: not known.
std::string pace_text(const Pace& pace) {
  std::string text;
  if (!pace.camera.empty()) {
    text = fmt::format("the camera is read {} times a second", rate(pace.read_hz));
    if (pace.offered_hz && !pace.keeps_up())
      text += fmt::format(" instead of {}", rate(*pace.offered_hz));
    if (!pace.shared_board.empty())
      text += fmt::format(
          ", an image costs {} on “{}”, {} of it waiting for the cores that {} "
          "programs share",
          short_ms(pace.median_s), pace.shared_board, share_text(pace.waiting), pace.programs);
  }
  if (!pace.stages.empty())
    text += fmt::format("{}“{}” takes {} of the computing time", text.empty() ? "" : ", and ",
                        pace.stages.front().stage, share_text(pace.stages.front().share));
  return text;
}

std::string goals_text(const ConditionVerdict& condition) {
  return fmt::format("on “{}” {} of {} reach{} the goal within the limits", condition.condition,
                     condition.reached, flights(condition.flown),
                     condition.reached == 1 ? "es" : "");
}

std::string missed_goals_text(const ConditionVerdict& condition) {
  const std::size_t missed = condition.flown - condition.reached;
  std::string text = condition.flown == 1
                         ? fmt::format("on “{}” the flight misses the goal", condition.condition)
                         : fmt::format("on “{}” {} of {} miss{} the goal", condition.condition,
                                       missed, flights(condition.flown), missed == 1 ? "es" : "");
  if (condition.missed.empty()) return text;
  return text + " (missed: " + missed_text(condition.missed, condition.flown == 1) + ")";
}

/// Why the computer is not the reason.
std::string other_reason_text(const OtherReason& reason) {
  switch (reason.evidence) {
    case OtherReason::Evidence::kInstant:
      return " Computing takes no time there, so a faster computer does not help.";
    case OtherReason::Evidence::kInstantMissesToo:
      return fmt::format(" “{}” misses it too, although computing takes no time there.",
                         reason.condition);
    case OtherReason::Evidence::kEquallyFastReaches:
      break;
  }
  return fmt::format(" “{}” has the same computer and sensors, and reaches it.", reason.condition);
}

/// What limits the evidence.
std::string doubts_text(const ConditionVerdict& condition) {
  std::string text;
  if (condition.failed > 0 && condition.flown > 0)
    text += fmt::format(" {} failed and {} not counted.", flights(condition.failed),
                        condition.failed == 1 ? "is" : "are");
  const std::size_t missing =
      condition.planned - std::min(condition.planned, condition.flown + condition.failed);
  if (missing > 0 && condition.flown + condition.failed > 0)
    text += fmt::format(" {} ha{} no result.", flights(missing), missing == 1 ? "s" : "ve");
  if (condition.throttled > 0)
    text += fmt::format(" The board was throttled in {}: it could be faster than this.",
                        flights(condition.throttled));
  if (condition.crashed > 0)
    text += fmt::format(" A UAV crashed in {}.", flights(condition.crashed));
  if (!condition.unreadable.empty())
    text += fmt::format(" The computing times are not known: {}.", condition.unreadable);
  return text;
}

/// Which share of flights is wanted: "9 of 10".
constexpr const char* kWanted = "9 of 10";
static_assert(kWantedSuccess == 0.9);

std::string evidence_of(const ConditionVerdict& condition) {
  const std::string pace = condition.pace ? pace_text(*condition.pace) : "";
  const std::string with_pace = pace.empty() ? "." : "; " + pace + ".";
  switch (condition.ruling) {
    case Ruling::kVoid:
      return fmt::format(
          "{} of “{}” break{} the rules of time, so nothing is known of the computer ({}).",
          flights(condition.unsound), condition.condition, condition.unsound == 1 ? "s" : "",
          condition.reason);
    case Ruling::kSetUpFailed:
      return fmt::format("on “{}” {} failed without a result ({}).", condition.condition,
                         flights(condition.failed), condition.reason);
    case Ruling::kNotFastEnough:
      return missed_goals_text(condition) + with_pace;
    case Ruling::kOtherReason:
      return missed_goals_text(condition) + with_pace + other_reason_text(*condition.other_reason);
    case Ruling::kUndecided:
      if (condition.flown == 0)
        return fmt::format("no flight on “{}” has a result.", condition.condition);
      return missed_goals_text(condition) + with_pace +
             fmt::format(" So few flights show neither that {} reach it nor that fewer do.",
                         kWanted);
    case Ruling::kFastEnoughSoFar:
    case Ruling::kFastEnough:
      if (condition.planned == 1)
        return fmt::format("on “{}” the flight reaches the goal within the limits",
                           condition.condition) +
               with_pace;
      return goals_text(condition) + with_pace;
    case Ruling::kNothingToDecide:
      return fmt::format("on “{}” {} of {} end{} well, but the scenario sets no limit on them.",
                         condition.condition, condition.reached, flights(condition.flown),
                         condition.flown == 1 ? "s" : "");
    case Ruling::kFreeRunning:
      return fmt::format(
          "“{}” is free-running (not synchronised): {} of {} seem{} to pass, which says nothing "
          "about the computer.",
          condition.condition, condition.reached, flights(condition.flown),
          condition.flown == 1 ? "s" : "");
  }
  return "";
}

std::string lead_of(const ConditionVerdict& condition) {
  const bool is_single = condition.planned == 1;
  switch (condition.ruling) {
    case Ruling::kVoid:
      return "Void";
    case Ruling::kSetUpFailed:
      return "No answer";
    case Ruling::kNotFastEnough:
      return is_single ? "Not fast enough in this flight" : "Not fast enough";
    case Ruling::kOtherReason:
      return is_single ? "Goal missed in this flight for another reason than speed"
                       : "Goal missed for another reason than speed";
    case Ruling::kFastEnoughSoFar:
      return is_single ? "Fast enough in this flight" : "Fast enough so far";
    case Ruling::kFreeRunning:
      return "No answer";
    case Ruling::kUndecided:
    case Ruling::kFastEnough:
    case Ruling::kNothingToDecide:
      break;
  }
  return capital(name(condition.ruling));
}

const ConditionVerdict& lead_of(const Verdict& verdict) {
  return verdict.conditions[verdict.lead];
}

/// Of a sweep: the point whose answer comes first.
const Verdict& most_urgent(const std::vector<Verdict>& points) {
  return *std::ranges::min_element(points, {},
                                   [](const Verdict& point) { return lead_of(point).ruling; });
}

/// Of a sweep: what would do, and each ruling of a condition with the points that have it.
std::vector<Answer> sweep_answers(const std::vector<Verdict>& points) {
  std::vector<Answer> answers = sufficient_factors(points);
  for (std::size_t i = 0; i < points.front().conditions.size(); ++i) {
    std::vector<std::pair<Ruling, std::vector<std::string>>> rulings;
    for (const Verdict& point : points) {
      const ConditionVerdict& at = point.conditions[i];
      auto known = std::ranges::find(rulings, at.ruling, [](const auto& one) { return one.first; });
      if (known == rulings.end()) known = rulings.insert(rulings.end(), {at.ruling, {}});
      known->second.push_back(
          fmt::format("{} ({} of {})", point.point, at.reached, flights(at.flown)));
    }
    for (const auto& [ruling, where] : rulings)
      answers.push_back({capital(name(ruling)),
                         fmt::format(": “{}” with {}.", points.front().conditions[i].condition,
                                     joined_with_and(where))});
  }
  return answers;
}

bool is_one_board_for_all(const ConditionVerdict& condition) {
  return condition.pace && !condition.pace->shared_board.empty() && condition.pace->boards.empty();
}

std::string stage_advice(const Advice& advice, const ConditionVerdict& lead) {
  std::string text = fmt::format("Speed up “{}” first.", advice.subject);
  if (!lead.pace) return text;
  const std::optional<double> headroom = lead.pace->headroom();
  if (headroom && *headroom < 1.0)
    text += fmt::format(
        " {} up to {} per image, and the camera has one every {}: it is {} × too slow to read them "
        "all.",
        lead.pace->shared_board.empty() && !lead.pace->shares_real_board
            ? "Computing takes"
            : "Computing and waiting for cores take",
        short_ms(lead.pace->p95_s), short_ms(1.0 / *lead.pace->offered_hz),
        fixed(1.0 / *headroom, 1));
  return text;
}

/// For a condition of a scenario as it is.
std::string uavs_advice(const ConditionVerdict& lead) {
  const std::vector<std::string>& words = lead.size_arguments;
  constexpr std::size_t kOwnCondition = 3;  // SCENARIO --condition NAME
  if (!is_one_board_for_all(lead) || words.size() != kOwnCondition) return "";
  return fmt::format("; to find how many UAVs it carries: `tether size {} {} {} --axis uavs`",
                     os::shell_word(words[0]), words[1], os::shell_word(words[2]));
}

std::string sentence_of(const Advice& advice, const Verdict& verdict) {
  using Kind = Advice::Kind;
  const ConditionVerdict& lead = lead_of(verdict);
  switch (advice.kind) {
    case Kind::kMendSetUp:
      return "Fix the cause of the failure, then fly again; a campaign continues with `--resume`.";
    case Kind::kReadAudit:
      return fmt::format(
          "Run `tether audit` on the records of “{}”. If the program stamps its own time, check "
          "that first.",
          advice.subject);
    case Kind::kCoolBoard:
      return "Cool the board, or give it enough power (`tether target check`), and fly again.";
    case Kind::kSpeedUpStage:
      return stage_advice(advice, lead);
    case Kind::kTryFaster:
      return faster_advice(lead);
    case Kind::kFindReason:
      return lead.other_reason->evidence == OtherReason::Evidence::kEquallyFastReaches
                 ? fmt::format("Look for the reason in what differs from “{}”, such as the radio.",
                               advice.subject)
                 : "Look for the reason in the program, the scenario and its limits.";
    case Kind::kFindThreshold:
      return threshold_advice(lead) + uavs_advice(lead);
    case Kind::kFlyMore:
      if (lead.planned == 1)
        return "One flight shows little. Fly a campaign of several seeds: `tether campaign`.";
      if (advice.flights == 0)
        return fmt::format("Fly more: the share is so near to {} that {} do not decide it.",
                           kWanted, flights(lead.flown));
      return fmt::format(
          "Fly more: if this share continues, {} decide (`trials` in the campaign's file, then "
          "`--resume`).",
          flights(advice.flights));
    case Kind::kSetLimit:
      return "Give a metric of the scenario a limit (such as `max_s` of `time_required`), or fly a "
             "mission with deadlines.";
    case Kind::kSynchronise:
      return "Fly a condition with `policy = \"conservative_barrier\"`.";
  }
  return "";
}

Table empty_stages_table() {
  Table table;
  table.title = "Where the computing time goes";
  table.headings = {
      single_headings({"Condition", "Stage", "Times", "Median (ms)", "95 % (ms)", "Share"})};
  table.text_columns = 2;
  return table;
}

void add_stages(Table& table, const std::string& where, const Pace& pace) {
  for (const timing::StageRow& row : pace.stages)
    if (row.share >= kLeastShare)
      table.rows.push_back({where, row.stage, std::to_string(row.count),
                            fixed(1e3 * row.median_s, 3), fixed(1e3 * row.p95_s, 3),
                            fmt::format("{:.1f} %", 100.0 * row.share)});
  std::string note = fmt::format("{}: seed {}. Stages below 0.1 % are left out.", where, pace.seed);
  if (!pace.camera.empty())
    note += fmt::format(
        " Per image of “{}”: {}{}, in 95 % of them at most {}; read {} times a second{}.",
        pace.camera, short_ms(pace.median_s),
        pace.shares_real_board      ? " of computing and waiting for cores"
        : pace.shared_board.empty() ? " of computing"
                                    : fmt::format(", {} of it waiting for the cores of “{}”",
                                                  share_text(pace.waiting), pace.shared_board),
        short_ms(pace.p95_s), rate(pace.read_hz),
        pace.offered_hz ? fmt::format(", offered {} times", rate(*pace.offered_hz)) : "");
  table.notes.push_back(note);
}

}  // namespace

std::string_view name(Ruling ruling) {
  switch (ruling) {
    case Ruling::kVoid:
      return "void";
    case Ruling::kSetUpFailed:
      return "set-up failed";
    case Ruling::kNotFastEnough:
      return "not fast enough";
    case Ruling::kOtherReason:
      return "goal missed for another reason";
    case Ruling::kUndecided:
      return "undecided";
    case Ruling::kFastEnoughSoFar:
      return "fast enough so far";
    case Ruling::kFastEnough:
      return "fast enough";
    case Ruling::kNothingToDecide:
      return "nothing to decide";
    case Ruling::kFreeRunning:
      break;
  }
  return "no answer (free-running)";
}

std::string missed_text(const MissedLimits& missed, bool of_one) {
  std::vector<std::string> parts;
  for (const auto& [limit, count] : missed) {
    if (parts.size() == kMostMissed) {
      parts.push_back(fmt::format("{} more", missed.size() - kMostMissed));
      break;
    }
    parts.push_back(of_one ? limit : fmt::format("{} ({})", limit, flights(count)));
  }
  return joined_with_and(parts);
}

std::vector<Answer> answers_on_flights(std::span<const campaign::TrialResult* const> trials,
                                       const std::string& unreadable) {
  std::vector<Answer> answers;
  if (const MissedLimits missed = missed_limits(trials); !missed.empty())
    answers.push_back({"Missed", ": " + missed_text(missed) + "."});
  if (!unreadable.empty())
    answers.push_back({"The computing times are not known", ": " + unreadable + "."});
  return answers;
}

Answer answer_of(const ConditionVerdict& condition) {
  return {lead_of(condition), ": " + evidence_of(condition) + doubts_text(condition)};
}

std::vector<Answer> answers_of(const std::vector<Verdict>& points) {
  std::vector<Answer> answers;
  const auto add_slowest = [&](const ConditionVerdict& condition) {
    if (auto slowest = slowest_board(condition)) answers.push_back(*std::move(slowest));
  };
  if (!points.front().point.empty()) {
    answers = sweep_answers(points);
    add_slowest(lead_of(most_urgent(points)));
    return answers;
  }
  const Verdict& verdict = points.front();
  const auto add = [&](const ConditionVerdict& condition) {
    answers.push_back(answer_of(condition));
    add_slowest(condition);
  };
  add(lead_of(verdict));
  answers.front().rest += sufficient_condition(verdict);
  for (std::size_t i = 0; i < verdict.conditions.size(); ++i)
    if (i != verdict.lead) add(verdict.conditions[i]);
  return answers;
}

std::vector<std::string> advice_of(const std::vector<Verdict>& points) {
  const Verdict& urgent = most_urgent(points);
  std::vector<std::string> sentences;
  const std::string where = urgent.point.empty() ? "" : fmt::format("{}: ", urgent.point);
  for (const Advice& advice : urgent.advice)
    sentences.push_back(where + sentence_of(advice, urgent));
  return sentences;
}

Table rulings_table(const std::vector<Verdict>& points) {
  const bool is_sweep = !points.front().point.empty();
  Table table;
  table.title = fmt::format("What was compared in {}", points.front().scenario);
  table.text_columns = is_sweep ? 3 : 2;
  std::vector<std::string> headings = {"Condition",     "Fast enough?",       "Goal reached",
                                       "95 % interval", "Headroom per image", "Closest limit"};
  if (is_sweep) headings.insert(headings.begin(), "With");
  table.headings = {single_headings(headings)};
  for (const Verdict& point : points) {
    for (const ConditionVerdict& one : point.conditions) {
      const bool says_nothing = one.ruling == Ruling::kFreeRunning;
      std::vector<std::string> row = {
          one.condition,
          std::string(name(one.ruling)),
          fmt::format("{} of {}", one.reached, one.flown),
          one.share && !says_nothing
              ? fmt::format("{:.0f} to {:.0f} %", 100.0 * one.share->low, 100.0 * one.share->high)
              : kNone,
          one.pace ? headroom_text(*one.pace) : kNone,
          one.closest ? fmt::format("{}: {} {}", one.closest->first,
                                    share_text(std::abs(one.closest->second)),
                                    one.closest->second < 0.0 ? "beyond" : "left")
                      : kNone};
      if (is_sweep) row.insert(row.begin(), point.point);
      table.rows.push_back(std::move(row));
    }
  }
  table.notes = {
      fmt::format("Fast enough: {} flights or more reach the goal within the limits, by the exact "
                  "interval (Clopper and Pearson). So far: all did, but they are too few to be "
                  "sure.",
                  kWanted),
      "Headroom per image: how many times slower the program could compute and still read every "
      "image of the camera, in 95 % of them; below 1, it skips images, which many tasks tolerate. "
      "The "
      "headroom of the whole task: tether size."};
  return table;
}

Table stages_table(const std::vector<Verdict>& points) {
  Table table = empty_stages_table();
  for (const Verdict& point : points) {
    for (const ConditionVerdict& one : point.conditions) {
      const std::string where =
          point.point.empty() ? one.condition : point.point + ", " + one.condition;
      if (one.pace) add_stages(table, where, *one.pace);
    }
  }
  return table;
}

Table stages_table(const std::string& condition, const Pace& pace) {
  Table table = empty_stages_table();
  add_stages(table, condition, pace);
  return table;
}

std::vector<std::vector<Verdict>> by_scenario(std::vector<Verdict> verdicts) {
  std::vector<std::vector<Verdict>> groups;
  for (Verdict& verdict : verdicts) {
    const bool continues = !verdict.point.empty() && !groups.empty() &&
                           !groups.back().front().point.empty() &&
                           groups.back().front().scenario == verdict.scenario;
    if (!continues) groups.emplace_back();
    groups.back().push_back(std::move(verdict));
  }
  return groups;
}

}  // namespace tether::report
