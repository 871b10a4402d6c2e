#include "answers/board_pace.h"
#include "answers/doubts.h"
#include "answers/miss_reason.h"
#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/report/verdict.h>

// The words of an answer.
namespace tether::report {
namespace {

static_assert(kWantedSuccess == 0.9 && std::string_view(kWanted) == "9 of 10");

constexpr std::size_t kMostMissed = 3;  // that a sentence names

/// How long set-points were not sent, where their rate does not tell; empty: it does.
std::string gap_text(const Pace& pace) {
  constexpr double kMuchLonger = 3.0, kLong_s = 10.0;
  if (pace.setpoint_gap_s * pace.setpoint_hz < kMuchLonger) return "";
  return fmt::format(" (but for up to {} not at all)",
                     pace.setpoint_gap_s < kLong_s ? short_ms(pace.setpoint_gap_s)
                                                   : fmt::format("{:.0f} s", pace.setpoint_gap_s));
}

/// "the camera is read 9 times a second instead of 30, and “detect” takes 81 % of the computing
/// time"; empty: not known.
std::string pace_text(const Pace& pace) {
  std::string text;
  if (!pace.camera.empty()) {
    constexpr double kMost = 0.5;
    text = fmt::format("the camera is read {} times a second",
                       rate_text(std::min(pace.read_hz, pace.offered_hz.value_or(pace.read_hz))));
    if (pace.offered_hz && !pace.reads_nearly_every())
      text += fmt::format(" instead of {}", rate_text(*pace.offered_hz));
    if (pace.reading < kMost)
      text += fmt::format(" during {} of the flight", share_text(pace.reading));
    if (pace.offered_hz && pace.reads_nearly_every() && !pace.keeps_up())
      text += fmt::format(", but more slowly for {} of the time", share_text(pace.behind));
    if (!pace.shared_board.empty())
      text += fmt::format(
          ", an image costs {} on “{}”, {} of it waiting for the cores that {} "
          "programs share",
          short_ms(pace.median_s), pace.shared_board, share_text(pace.waiting), pace.programs);
  }
  if (pace.setpoint_hz > 0.0)
    text += fmt::format("{}set-points are sent {} times a second", text.empty() ? "" : ", ",
                        rate_text(pace.setpoint_hz)) +
            gap_text(pace);
  for (const Pace::Unqueued& queue : pace.unqueued)
    text += fmt::format("{}{} of “{}” of {} had no place in its queue", text.empty() ? "" : ", ",
                        counted(queue.count, "measurement"), queue.sensor, queue.uav);
  if (!pace.stages.empty())
    text += fmt::format("{}“{}” takes {} of the computing time", text.empty() ? "" : ", and ",
                        pace.stages.front().stage, share_text(pace.stages.front().share));
  return text;
}

/// "5 of 10 flights", "one flight, flown 10 times", "10 of 10 flights (3 different ones)"
std::string count_text(std::size_t count, const ConditionVerdict& condition) {
  if (condition.flown > 1 && condition.is_one_flight())
    return fmt::format("one flight, flown {} times,", condition.flown);
  const std::string text = fmt::format("{} of {}", count, counted(condition.flown, "flight"));
  return condition.distinct == condition.flown
             ? text
             : fmt::format("{} ({} different ones)", text, condition.distinct);
}

std::string verb(const ConditionVerdict& condition, std::size_t count, const char* one,
                 const char* many) {
  return count == 1 || condition.is_one_flight() ? one : many;
}

std::string goals_text(const ConditionVerdict& condition) {
  if (condition.planned == 1)
    return fmt::format("on “{}” the flight reaches the goal within the limits",
                       condition.condition);
  return fmt::format("on “{}” {} {} the goal within the limits", condition.condition,
                     count_text(condition.reached, condition),
                     verb(condition, condition.reached, "reaches", "reach"));
}

std::string missed_goals_text(const ConditionVerdict& condition) {
  const std::string missed = missed_text(condition.missed, condition.flown == 1);
  if (condition.planned == 1)
    return fmt::format("on “{}” the flight does not meet {}", condition.condition,
                       missed.empty() ? "the goal" : missed);
  const std::size_t count = condition.flown - condition.reached;
  return fmt::format("on “{}” {} {} the goal{}", condition.condition, count_text(count, condition),
                     verb(condition, count, "misses", "miss"),
                     missed.empty() ? "" : " (not met: " + missed + ")");
}

/// One for each MissReason::Evidence.
constexpr std::array kMissReasons = {
    " “{condition}” {text}.",
    " {text}.",
    " “{condition}” reaches it, but is not compared, since {text}: whether speed matters is not "
    "known.",
    " “{condition}” is exactly as fast and reaches it: what differs are its sensors or its "
    "simulator.",
    " No condition that is clearly faster and otherwise the same was flown, so whether speed "
    "matters "
    "is not known.",
    " “{condition}” is faster and {text}. That does not show whether speed matters.",
    " A possible reason: {text}. Whether speed matters is not known.",
    " “{condition}” is slower and {text}: speed matters, but more of it does not always help this "
    "program.",
    " The reason: {text}.",
    " Computing takes no time there, so a faster computer does not help.",
    " “{condition}” misses it too, although computing takes no time there.",
    " “{condition}” is faster and reads every image, and misses it too.",
    " “{condition}” has the same computer and sensors, and reaches it.",
    " “{condition}” is slower and {text}.",
};

std::string reason_text(const MissReason& reason) {
  return fmt::format(fmt::runtime(kMissReasons[static_cast<std::size_t>(reason.evidence)]),
                     fmt::arg("condition", reason.condition), fmt::arg("text", reason.text)) +
         (reason.is_of_other_build
              ? " Its program is another build, for another architecture: what differs between the "
                "builds can be part of the reason."
              : "");
}

std::string undecided_text(const ConditionVerdict& condition) {
  if (!condition.mixed_build.empty())
    return fmt::format(" The flights are of different builds of {}: fly all of them again.",
                       condition.mixed_build);
  if (is_within_spread(condition))
    return fmt::format(" The closest limit ({}, {}) is within the spread of the machine's times.",
                       in_a_sentence(condition.tightest->first),
                       distance_text(condition.tightest->second));
  if (condition.failed > 0) return " How often those that failed would reach it is not known.";
  if (condition.share->low >= kWantedSuccess || condition.share->high < kWantedSuccess) return "";
  return fmt::format(" So few flights show neither that {} reach it nor that fewer do.", kWanted);
}

/// Of a missed goal; empty: none was lost, or that is its reason.
std::string losses_text(const ConditionVerdict& condition) {
  if (!condition.pace || condition.pace->losses.count == 0 ||
      condition.miss->evidence == MissReason::Evidence::kPossibleCause)
    return "";
  return fmt::format(" UAV '{}' {}.", condition.pace->losses.uav, condition.pace->losses.text());
}

std::string evidence_of(const ConditionVerdict& condition) {
  const std::string pace = condition.pace ? pace_text(*condition.pace) : "";
  const std::string with_pace = pace.empty() ? "." : "; " + pace + ".";
  switch (condition.ruling) {
    case Ruling::kVoid:
      return fmt::format(
          "{} of “{}” break{} the rules of time, so nothing is known of the computer ({}).",
          counted(condition.unsound, "flight"), condition.condition,
          condition.unsound == 1 ? "s" : "", condition.reason);
    case Ruling::kSetUpFailed:
      if (condition.planned == 1)
        return condition.reason + (condition.reason.ends_with('.') ? "" : ".");
      return fmt::format("on “{}” {} failed without a result ({}).", condition.condition,
                         counted(condition.failed, "flight"), condition.reason);
    case Ruling::kUnseen: {
      std::vector<std::string> parts;
      for (const FlightsInDoubt& doubt : condition.doubts)
        if (doubt.largest.is_of_unseen_time()) parts.push_back(doubt_text(doubt, condition));
      return fmt::format("{}. What was flown on “{}” may differ from a real flight.",
                         joined_with_and(parts), condition.condition);
    }
    case Ruling::kNotFastEnough:
    case Ruling::kGoalMissed:
      return missed_goals_text(condition) + with_pace + reason_text(*condition.miss) +
             losses_text(condition);
    case Ruling::kOtherReason:
      return missed_goals_text(condition) + "." + reason_text(*condition.miss);
    case Ruling::kNotFlown:
      return fmt::format("of {} planned on “{}”, none has ended.",
                         counted(condition.planned, "flight"), condition.condition);
    case Ruling::kUndecided:
      return (condition.reached == condition.flown ? goals_text(condition)
                                                   : missed_goals_text(condition)) +
             with_pace + undecided_text(condition);
    case Ruling::kFastEnoughSoFar:
    case Ruling::kFastEnough:
      return goals_text(condition) + with_pace;
    case Ruling::kNothingToDecide:
      return fmt::format("on “{}” {} {} well, but the scenario sets no limit on them.",
                         condition.condition, count_text(condition.reached, condition),
                         verb(condition, condition.flown, "ends", "end"));
    case Ruling::kFreeRunning:
      return fmt::format(
          "“{}” is free-running (not synchronised): {} of {} seem{} to pass, which says nothing "
          "about the computer.",
          condition.condition, condition.reached, counted(condition.flown, "flight"),
          condition.flown == 1 ? "s" : "");
  }
  return "";
}

/// One for each Ruling: in tables, at the start of an answer, and at that on one flight (empty: as
/// the answer).
struct Words {
  std::string_view name, lead, lead_of_one{};
};
constexpr std::array kWords = {
    Words{"void", "Void"},
    Words{"no answer (failed)", "No answer"},
    Words{"no answer (unseen time)", "No answer"},
    Words{"not fast enough", "Not fast enough", "Not fast enough in this flight"},
    Words{"goal missed", "Goal missed"},
    Words{"goal missed, probably for another reason",
          "Goal missed; speed is probably not the reason"},
    Words{"no answer (not flown)", "No answer"},
    Words{"undecided", "Undecided"},
    Words{"fast enough so far", "Fast enough so far", "Fast enough in this flight"},
    Words{"fast enough", "Fast enough"},
    Words{"nothing to decide", "Nothing to decide"},
    Words{"no answer (free-running)", "No answer"},
};
const Words& words_of(Ruling ruling) {
  return kWords[static_cast<std::size_t>(ruling)];
}

/// A good answer that rests on less than what was asked for.
bool leaves_out(const ConditionVerdict& condition) {
  return is_sufficient(condition.ruling) &&
         (!condition.left_out.empty() || !condition.doubtful_goals.empty() ||
          !condition.uncharged.empty());
}

std::string left_out_in_lead(const ConditionVerdict& condition) {
  if (!leaves_out(condition)) return "";
  if (!condition.uncharged.empty())
    return fmt::format(", but “{}” is charged nothing", condition.uncharged.front());
  return condition.left_out.empty() ? "" : kNotAsWritten;
}

/// Empty: as that on several flights.
std::string_view lead_of_one_flight(const ConditionVerdict& condition) {
  return condition.is_one_flight() ? words_of(condition.ruling).lead_of_one : "";
}

std::string lead_of(const ConditionVerdict& condition) {
  const std::string_view of_one = lead_of_one_flight(condition);
  const std::string lead(of_one.empty() ? words_of(condition.ruling).lead : of_one);
  return (is_in_doubt(condition) ? "Doubtful whether " + in_a_sentence(lead) : lead) +
         left_out_in_lead(condition);
}

/// Of a point of a sweep, or the first of several with the same ruling: what it rests on, in
/// sentences.
std::string cause_text(const ConditionVerdict& condition, bool is_only_one) {
  if (condition.ruling == Ruling::kVoid || condition.ruling == Ruling::kSetUpFailed)
    return fmt::format(" The first reason: {}.", condition.reason);
  if (condition.ruling == Ruling::kUnseen) return " " + capital(evidence_of(condition));
  std::string missed;
  if (condition.is_missed() && is_only_one && !condition.missed.empty())
    missed = fmt::format(" Not met: {}.", missed_text(condition.missed, condition.flown == 1));
  if (condition.miss && (is_only_one || condition.ruling == Ruling::kOtherReason))
    missed += reason_text(*condition.miss);
  return missed + (condition.ruling == Ruling::kOtherReason ? "" : doubts_text(condition));
}

/// Of a sweep: how many pairs of its points differ in how often they reach the goal.
std::optional<Answer> differences_between(const std::vector<Verdict>& points) {
  std::vector<double> p_values;
  for (std::size_t i = 0; i < points.front().conditions.size(); ++i)
    for (std::size_t b = 1; b < points.size(); ++b)
      for (std::size_t a = 0; a < b; ++a)
        if (is_evidence(points[a].conditions[i]) && is_evidence(points[b].conditions[i]))
          p_values.push_back(chance_of(points[a].conditions[i], points[b].conditions[i]));
  if (p_values.empty()) return std::nullopt;
  const auto differing =
      std::ranges::count_if(campaign::holm(p_values), [](double p) { return p < kSignificant; });
  return Answer{differing > 0 ? "Differences" : "No difference is shown",
                fmt::format(": {} of {} pairs of points differ{} in how often the goal is reached "
                            "by more than chance explains (Fisher's exact test, corrected by "
                            "Holm's method).",
                            differing, p_values.size(), differing == 1 ? "s" : "")};
}

/// Of a sweep: what would do, and each ruling of a condition with the points that have it.
std::vector<Answer> sweep_answers(const std::vector<Verdict>& points) {
  std::vector<Answer> answers = sufficient_factors(points);
  struct Alike {
    const ConditionVerdict* first;
    std::vector<std::string> where{};
  };
  std::vector<Alike> rulings;
  for (std::size_t i = 0; i < points.front().conditions.size(); ++i)
    for (const Verdict& point : points) {
      const ConditionVerdict& at = point.conditions[i];
      auto known = std::ranges::find_if(rulings, [&](const Alike& one) {
        return one.first->condition == at.condition && one.first->ruling == at.ruling &&
               leaves_out(*one.first) == leaves_out(at) &&
               is_in_doubt(*one.first) == is_in_doubt(at);
      });
      if (known == rulings.end()) known = rulings.insert(rulings.end(), Alike{&at});
      known->where.push_back(
          fmt::format("{} ({} of {})", point.point, at.reached, counted(at.flown, "flight")));
    }
  std::ranges::stable_sort(rulings, {}, [](const Alike& one) { return one.first->ruling; });
  for (const auto& [first, where] : rulings) {
    const std::string ruling(name(first->ruling));
    Answer answer{(is_in_doubt(*first) ? "Doubtful whether " + ruling : capital(ruling)) +
                      left_out_in_lead(*first),
                  fmt::format(": “{}” with {}.{}", first->condition, joined_with_and(where),
                              cause_text(*first, where.size() == 1))};
    if (!leaves_out(*first)) answer.ruling = first->ruling;
    answers.push_back(std::move(answer));
  }
  if (auto differences = differences_between(points)) answers.push_back(*std::move(differences));
  return answers;
}

campaign::ConditionResults results_of(const std::string& condition,
                                      std::span<const campaign::TrialResult* const> trials) {
  campaign::ConditionResults results;
  results.condition = condition;
  results.planned = trials.size();
  for (const campaign::TrialResult* trial : trials) results.trials.push_back(*trial);
  return results;
}

}  // namespace

std::string_view name(Ruling ruling) {
  return words_of(ruling).name;
}

std::string name_of_flown(const ConditionVerdict& condition) {
  const std::string of_one(lead_of_one_flight(condition));
  return of_one.empty() ? std::string(name(condition.ruling)) : in_a_sentence(of_one);
}

std::string name(const ConditionVerdict& condition) {
  return (is_in_doubt(condition) ? "doubtful whether " : "") + name_of_flown(condition) +
         left_out_in_lead(condition);
}

std::string missed_text(const MissedLimits& missed, bool of_one) {
  std::vector<std::string> parts;
  for (const auto& [limit, flights, how] : missed) {
    if (parts.size() == kMostMissed) {
      parts.push_back(fmt::format("{} more", missed.size() - kMostMissed));
      break;
    }
    std::string part = limit + (how.empty() ? "" : ": " + how);
    if (!of_one) part += fmt::format(" ({})", counted(flights, "flight"));
    parts.push_back(std::move(part));
  }
  return joined_with_and(parts);
}

std::optional<Answer> unseen_answer(const std::string& condition,
                                    std::span<const campaign::TrialResult* const> trials) {
  const ConditionVerdict all = verdict_of(results_of(condition, trials));
  if (all.ruling != Ruling::kUnseen) return std::nullopt;
  return answer_of(all);
}

std::vector<Answer> answers_on_flights(std::span<const campaign::TrialResult* const> trials,
                                       const std::string& unknown_pace) {
  std::vector<Answer> answers;
  const ConditionVerdict all = verdict_of(results_of("", trials));
  if (!all.left_out.empty())
    answers.push_back({"Not everything is simulated as written", "." + left_out_text(all)});
  if (!all.doubtful_goals.empty())
    answers.push_back({"Something is doubtful",
                       ", which can change the answer: " + named(all.doubtful_goals) + "."});
  if (const FlightsInDoubt* busy = all.doubt(campaign::Doubt::Kind::kBusyMachine))
    answers.push_back({"Busy machine", ": " + doubt_text(*busy, all) + "."});
  if (const MissedLimits missed = missed_limits(trials); !missed.empty())
    answers.push_back({"Not met", ": " + missed_text(missed) + "."});
  if (!unknown_pace.empty())
    answers.push_back({"The computing times are not known", ": " + unknown_pace + "."});
  return answers;
}

Answer answer_of(const ConditionVerdict& condition) {
  Answer answer{lead_of(condition), ": " + evidence_of(condition) + doubts_text(condition)};
  if (!leaves_out(condition)) answer.ruling = condition.ruling;
  return answer;
}

std::vector<Answer> answers_of(const std::vector<Verdict>& points) {
  std::vector<Answer> answers;
  const auto add_slowest = [&](const ConditionVerdict& condition) {
    if (auto slowest = slowest_board(condition)) answers.push_back(*std::move(slowest));
  };
  if (!points.front().point.empty()) {
    answers = sweep_answers(points);
    add_slowest(most_urgent(points).first());
    return answers;
  }
  const Verdict& verdict = points.front();
  const auto add = [&](const ConditionVerdict& condition) {
    answers.push_back(answer_of(condition));
    add_slowest(condition);
  };
  add(verdict.first());
  for (std::size_t i = 0; i < verdict.conditions.size(); ++i)
    if (i != verdict.lead) add(verdict.conditions[i]);
  return answers;
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

std::vector<Answer> headlines_of(const std::vector<std::vector<Verdict>>& groups) {
  std::vector<std::pair<Ruling, Answer>> headlines;
  for (const std::vector<Verdict>& points : groups) {
    Answer answer = answers_of(points).front();
    answer.lead = points.front().scenario + ": " + answer.lead;
    headlines.emplace_back(most_urgent(points).first().ruling, std::move(answer));
  }
  std::ranges::stable_sort(headlines, {}, [](const auto& one) { return one.first; });
  std::vector<Answer> answers;
  if (groups.size() > 1)
    for (auto& [ruling, answer] : headlines) answers.push_back(std::move(answer));
  return answers;
}

}  // namespace tether::report
