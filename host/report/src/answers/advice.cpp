#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/os/child_process.h>
#include <tether/report/verdict.h>

// What to do next, in sentences.
namespace tether::report {
namespace {

/// "`tether size face_anchor --condition target`"; empty: it cannot fly this.
std::string size_command(const ConditionVerdict& condition, bool searches_faster) {
  if (!condition.sizing) return "";
  const auto& [scenario, name, target, between] = *condition.sizing;
  std::string command =
      fmt::format("tether size {} --condition {}", os::shell_word(scenario), os::shell_word(name));
  if (!target.empty()) command += " --target " + os::shell_word(target);
  if (between)
    command += fmt::format(" --between {:g},{:g}", between->first, between->second);
  else if (searches_faster && target.empty())
    command += " --between 0.1,2";
  return "`" + command + "`";
}

/// "`tether campaign face_anchor --condition target`", for a condition of a scenario's file.
std::string campaign_command(const ConditionVerdict& condition) {
  if (!condition.sizing || !condition.sizing->target.empty() || condition.sizing->between)
    return "`tether campaign SCENARIO --condition NAME`.";
  return fmt::format("`tether campaign {} --condition {}`",
                     os::shell_word(condition.sizing->scenario),
                     os::shell_word(condition.sizing->condition));
}

/// To find out whether speed matters at all.
std::string faster_advice(const ConditionVerdict& lead) {
  std::string text =
      lead.pace && lead.pace->keeps_up()
          ? "While it reads, the program keeps up with the camera, so the computer may not be the "
            "cause. "
          : "";
  text += "To see whether speed matters, fly on a faster computer";
  const std::string size = size_command(lead, true);
  return text + (size.empty() ? "." : ": " + size);
}

std::string threshold_advice(const ConditionVerdict& lead) {
  const bool is_too_slow = lead.ruling == Ruling::kNotFastEnough;
  const std::string what = is_too_slow
                               ? "how much faster the computer must be"
                               : "the headroom, that is how much slower the computer may be";
  const std::string command = size_command(lead, is_too_slow);
  if (!command.empty()) return fmt::format("To find {}: {}", what, command);
  if (lead.is_on_real_board)
    return fmt::format(
        "A real board cannot be slowed down. To find {}: write a virtual target of the board "
        "(`tether-sut calibrate`), and name it with `tether size SCENARIO --target`.",
        what);
  return fmt::format(
      "To find {}: write this flight as a condition of a scenario's file, with a limit to keep, "
      "and "
      "give that to `tether size`.",
      what);
}

bool is_one_board_for_all(const ConditionVerdict& condition) {
  return condition.pace && !condition.pace->shared_board.empty() && condition.pace->boards.empty();
}

std::string stage_advice(const Advice& advice, const ConditionVerdict& lead) {
  const bool shares = !lead.pace->shared_board.empty() || lead.pace->shares_real_board;
  return fmt::format(
      "Speed up “{}” first. {} up to {} per image, and the camera has one every {}: it is {} × too "
      "slow to read them all.",
      advice.subject,
      shares                              ? "Computing and waiting for cores take"
      : lead.pace->speed.measures_waits() ? "Computing and whatever the program waits for take"
                                          : "Computing takes",
      short_ms(lead.pace->p95_s), short_ms(1.0 / *lead.pace->offered_hz),
      fixed(1.0 / *lead.pace->headroom(), 1));
}

/// For a condition of a scenario as it is.
std::string uavs_advice(const ConditionVerdict& lead) {
  if (!is_one_board_for_all(lead) || !lead.sizing || !lead.sizing->target.empty() ||
      lead.sizing->between)
    return "";
  return fmt::format(
      "; to find how many UAVs it carries: `tether size {} --condition {} --axis uavs`",
      os::shell_word(lead.sizing->scenario), os::shell_word(lead.sizing->condition));
}

/// What a program that uses Tether's library can do, and what one that flies as it is can do.
std::string by_program(Advice::Kind kind, bool is_as_is) {
  using Kind = Advice::Kind;
  struct Row {
    Kind kind;
    const char* with_library;
    const char* as_is;
  };
  constexpr Row kRows[] = {
      {Kind::kShowWaits,
       "Wait by the client library (`sleep_for`, `sleep_until`, a read with a timeout), which "
       "Tether sees. If that is not possible, fly with `clock = \"wall\"` and `concurrent = true`, "
       "for which all time counts.",
       "Fly with all its threads and processes on one core (`all_processes = true` in [sut]), so "
       "that what they wait for from each other is seen; with OpenCV, open the "
       "camera with `cv2.CAP_V4L2`. Keep waits for a device or a server out of the flight."},
      {Kind::kUnstretch,
       "Wait by the client library (`sleep_for`, `sleep_until`, a read with a timeout), or fly on "
       "the board itself, or with a factor of 1.",
       "Fly on the board itself, or with a factor of 1."},
      {Kind::kRunConcurrent,
       "Let one thread compute at a time (in OpenCV, `cv::setNumThreads(1)`), or fly with `clock = "
       "\"wall\"` and `concurrent = true`, for which threads that compute in parallel count once.",
       "Fly with all its threads and processes on one core (`all_processes = true` in [sut]), or "
       "let one thread compute at a time (in OpenCV, `cv::setNumThreads(1)`)."},
      {Kind::kQuietMachine,
       "Fly again while nothing else runs on the machine, or with counted work (`clock = "
       "\"counted\"`), which does not depend on that.",
       "Fly again while nothing else runs on the machine."}};
  const Row& row = *std::ranges::find(kRows, kind, &Row::kind);
  return is_as_is ? row.as_is : row.with_library;
}

std::string sentence_of(const Advice& advice, const Verdict& verdict) {
  using Kind = Advice::Kind;
  const ConditionVerdict& lead = verdict.first();
  switch (advice.kind) {
    case Kind::kMendSetUp:
      return lead.planned == 1 ? "Fix this, then fly again."
                               : "Fix the cause of the failure; the campaign continues with "
                                 "`--resume`.";
    case Kind::kFlyAgain:
      return lead.planned == 1 ? "You stopped the flight: fly again."
                               : "You stopped the campaign: it continues with `--resume`.";
    case Kind::kFlyRest:
      return "The campaign is not complete: `--resume` flies the rest.";
    case Kind::kShowWaits:
    case Kind::kUnstretch:
    case Kind::kRunConcurrent:
    case Kind::kQuietMachine:
      return by_program(advice.kind, lead.has_as_is);
    case Kind::kCountDisk:
      return "Keep files out of the flight, or fly with `clock = \"wall\"`, for which all time "
             "counts.";
    case Kind::kReadAudit:
      return fmt::format(
          "Run `tether audit` on the records of “{}”. If the program stamps its own time, check "
          "that first.",
          advice.subject);
    case Kind::kRecordAgain:
      return fmt::format(
          "Measure the times of “{}” again without that, and write the file again (`tether timing "
          "--out`).",
          advice.subject);
    case Kind::kCoolBoard:
      return "Cool the board, or give it enough power (`tether target check`), and fly again.";
    case Kind::kSpeedUpStage:
      return stage_advice(advice, lead);
    case Kind::kMendDoubt:
      return "Fix what is doubtful first, if it was not meant.";
    case Kind::kMendProgram:
      return "If the program was not meant to end so, fix it and fly again.";
    case Kind::kTryFaster:
      return faster_advice(lead);
    case Kind::kFindReason:
      switch (lead.miss->evidence) {
        case MissReason::Evidence::kEquallyFastReaches:
          return fmt::format("Look for the reason in what differs from “{}”, such as the radio.",
                             advice.subject);
        case MissReason::Evidence::kOtherSensorsReach:
          return fmt::format(
              "Look for the reason in what the sensors of “{}” do otherwise: noise, rate, delay or "
              "losses.",
              advice.subject);
        case MissReason::Evidence::kKnownCause:
          return "Fix this, then fly again.";
        case MissReason::Evidence::kPossibleCause:
          return "If that was not meant, fix it and fly again. Only then ask how fast the computer "
                 "has to be.";
        default:
          return "Look for the reason in the program, the scenario and its limits.";
      }
    case Kind::kVarySeeds:
      return kVarySeeds;
    case Kind::kFindThreshold:
      return threshold_advice(lead) + uavs_advice(lead);
    case Kind::kFlyMore:
      if (lead.planned == 1 && (!lead.sizing || lead.sizing->between))
        return "One flight shows little. Fly more, with other seeds (`--seed`).";
      if (lead.planned == 1 && verdict.point.empty())
        return "One flight shows little. Fly more, with other seeds: " + campaign_command(lead);
      if (advice.flights == 0)
        return fmt::format("Fly more: the share is so near to {} that {} do not decide it.",
                           kWanted, counted(lead.flown, "flight"));
      return fmt::format(
          "Fly more: if this share continues, {} decide (`--trials`, or `trials` in the campaign's "
          "file; then `--resume`).",
          counted(advice.flights, "flight"));
    case Kind::kCompareMore:
      return "Fly both conditions more often, to see whether chance explains the difference "
             "(`--trials`, or `trials` in the campaign's file; then `--resume`).";
    case Kind::kGiveValue:
      return "Let the program report what the metric needs, or remove its limit.";
    case Kind::kSetLimit:
      return "Give a metric of the scenario a limit (such as `max_s` of `time_required`), or fly a "
             "mission with deadlines.";
    case Kind::kSynchronise:
      return "Fly a condition with `policy = \"conservative_barrier\"`.";
  }
  return "";
}

}  // namespace

std::vector<std::string> advice_of(const std::vector<Verdict>& points) {
  const Verdict& urgent = most_urgent(points);
  std::vector<std::string> sentences;
  const std::string where = urgent.point.empty() ? "" : fmt::format("{}: ", urgent.point);
  for (const Advice& advice : urgent.advice)
    sentences.push_back(where + sentence_of(advice, urgent));
  return sentences;
}

}  // namespace tether::report
