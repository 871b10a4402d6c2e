#include "answers/doubts.h"

#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <tether/base/text.h>

namespace tether::report {
namespace {

/// One for each campaign::Doubt::Kind: of a UAV or a machine.
constexpr std::array kDoubts = {
    "the program of {subject} waited up to about {seconds} s on something that Tether does not "
    "see",
    "threads of the program of {subject} computed in parallel ({amount:.1f} × the wall time), but "
    "their times are added",
    "the program of {subject} waited {seconds} s for the disk, or for a process that it started "
    "by vfork, which its clock does not count",
    "the program of {subject} waited {seconds} s, which the clock's factor stretches although "
    "no computer changes it",
    "the program of {subject} waited {percent:.1f} % of its time on something that Tether does not "
    "see",
    "the machine{subject} was busy or uneven: its times may be off by about {percent:.0f} %",
};

}  // namespace

std::string named(const std::vector<std::string>& lines) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> parts;
  for (const std::string& line : lines) {
    if (parts.size() == kMost) {
      parts.push_back(fmt::format("{} more", lines.size() - kMost));
      break;
    }
    parts.push_back(line.substr(0, std::min(line.find("; "), line.find(". "))));
  }
  return joined_with_and(parts);
}

std::string doubt_text(const FlightsInDoubt& doubt, const ConditionVerdict& condition) {
  const campaign::Doubt& largest = doubt.largest;
  const std::size_t ended = condition.flown + condition.failed;
  const bool is_of_uav = largest.kind != campaign::Doubt::Kind::kBusyMachine;
  const bool needs_at_most = is_of_uav && largest.kind != campaign::Doubt::Kind::kUnseenWait;
  const std::string where = ended > 1
                                ? fmt::format("{} in {} of {}", needs_at_most ? ", at most," : ",",
                                              doubt.flights, counted(ended, "flight"))
                                : "";
  const std::string subject = is_of_uav || largest.subject.empty()
                                  ? largest.subject
                                  : fmt::format(" “{}”", largest.subject);
  const std::string when = largest.recorded_in.empty()
                               ? ""
                               : fmt::format("when “{}” was recorded, ", largest.recorded_in);
  return when +
         fmt::format(
             fmt::runtime(kDoubts[static_cast<std::size_t>(largest.kind)]),
             fmt::arg("subject", subject), fmt::arg("amount", largest.amount),
             fmt::arg("seconds", largest.amount < 100.0 ? fmt::format("{:.2g}", largest.amount)
                                                        : fmt::format("{:.0f}", largest.amount)),
             fmt::arg("percent", 100.0 * largest.amount)) +
         where;
}

namespace {

/// Of flights that begin alike, and are no copies.
std::string why_different(const ConditionVerdict& condition) {
  const Speed speed = condition.pace ? condition.pace->speed : Speed{};
  const bool repeats =
      !speed.programs.empty() &&
      std::ranges::all_of(speed.programs, [](const auto& one) { return one.clock.repeats(); });
  return repeats ? " They all begin alike, and no time is measured: they differ in noise, or "
                   "because the program itself does not repeat."
                 : " They all begin alike, and differ only in noise and measured times.";
}

}  // namespace

std::string left_out_text(const ConditionVerdict& condition) {
  return fmt::format(" Not simulated as written, which can change the answer: {}.",
                     named(condition.left_out));
}

std::string doubts_text(const ConditionVerdict& condition) {
  std::string text;
  if (!condition.varied.empty() && !condition.is_one_flight())
    text += fmt::format(" The flights differ in {}.", joined_with_and(condition.varied));
  else if (condition.distinct > 1)
    text += why_different(condition);
  if (!condition.left_out.empty()) text += left_out_text(condition);
  const bool is_named =
      condition.miss && condition.miss->evidence == MissReason::Evidence::kPossibleCause;
  if (const auto& doubtful = condition.doubts_of_answer(); !doubtful.empty() && !is_named)
    text += fmt::format(" Doubtful, which can change the answer: {}.", named(doubtful));
  constexpr double kFar = 0.9;
  if (is_sufficient(condition.ruling) && condition.closest && condition.closest->second > kFar)
    text += fmt::format(
        " Even the closest limit is far ({}: {}): check that a slow computer can miss it.",
        in_a_sentence(condition.closest->first), distance_text(condition.closest->second));
  for (const FlightsInDoubt& doubt : condition.doubts)
    if (doubt.largest.is_of_unseen_time()
            ? condition.ruling != Ruling::kUnseen
            : condition.flown > 0 && (doubt.largest.kind == campaign::Doubt::Kind::kBusyMachine ||
                                      is_within_spread(condition, doubt)))
      text += " " + capital(doubt_text(doubt, condition)) + ".";
  if (condition.failed > 0 && condition.flown > 0)
    text += fmt::format(
        " {} failed and {} not counted{}.", counted(condition.failed, "flight"),
        condition.failed == 1 ? "is" : "are",
        condition.unsound > 0 || condition.reason.empty() ? "" : ": " + condition.reason);
  const std::size_t missing =
      condition.planned - std::min(condition.planned, condition.flown + condition.failed);
  if (missing > 0 && condition.flown + condition.failed > 0)
    text +=
        fmt::format(" {} ha{} no result.", counted(missing, "flight"), missing == 1 ? "s" : "ve");
  if (condition.pace && condition.pace->speed.stretches_unseen_waits())
    text += " The factor of the wall clock also stretches what the program waits.";
  if (condition.throttled > 0)
    text += fmt::format(" The board was throttled in {}: it could be faster than this.",
                        counted(condition.throttled, "flight"));
  if (condition.crashed > 0)
    text += fmt::format(" A UAV crashed in {}.", counted(condition.crashed, "flight"));
  if (!condition.unknown_pace.empty())
    text += fmt::format(" The computing times are not known: {}.", condition.unknown_pace);
  return text;
}

}  // namespace tether::report
