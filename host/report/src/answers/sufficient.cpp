#include "answers/sufficient.h"

#include "tables/report_format.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <tether/base/text_table.h>
#include <tether/os/shell_word.h>

namespace tether::report {
namespace {

/// What was flown with one condition at one combination of the other values, by cpu_factor.
using ByFactor = std::map<double, Ruling>;

bool is_factor(const scenario::Setting& setting) {
  return setting.key == "cpu_factor" || setting.key == "condition.cpu_factor";
}

/// " with rate_hz = 10"; empty: cpu_factor is the only value.
std::string other_settings(const Verdict& point) {
  std::string text;
  for (const scenario::Setting& setting : point.settings)
    if (!is_factor(setting))
      text += fmt::format("{}{} = {}", text.empty() ? " with " : ", ", setting.key, setting.value);
  return text;
}

std::optional<Answer> sufficient_factor(const std::string& what, const ByFactor& flown) {
  const auto next =
      std::ranges::find_if(flown, [](const auto& one) { return !is_sufficient(one.second); });
  if (next == flown.begin()) return std::nullopt;
  const auto [factor, ruling] = *std::prev(next);
  return Answer{fmt::format("Up to {:g} × slower would do", factor),
                fmt::format(": {} is {} at cpu_factor = {:g}, {}.", what, name(ruling), factor,
                            next == flown.end()
                                ? "the largest that was flown"
                                : fmt::format("and {} at {:g}", name(next->second), next->first))};
}

/// "`tether size face_anchor --condition target`"; empty: it cannot fly this.
std::string size_command(const ConditionVerdict& condition, bool searches_faster) {
  if (condition.size_arguments.empty()) return "";
  std::string command = "tether size";
  for (const std::string& word : condition.size_arguments) command += " " + os::shell_word(word);
  const auto names = [&](const char* option) {
    return std::ranges::count(condition.size_arguments, option) > 0;
  };
  if (searches_faster && !names("--target") && !names("--between")) command += " --between 0.1,2";
  return "`" + command + "`";
}

}  // namespace

bool is_sufficient(Ruling ruling) {
  return ruling == Ruling::kFastEnough || ruling == Ruling::kFastEnoughSoFar;
}

std::string sufficient_condition(const Verdict& verdict) {
  const ConditionVerdict& lead = verdict.conditions[verdict.lead];
  if (lead.ruling != Ruling::kNotFastEnough) return "";
  const auto computing_s = [](const ConditionVerdict& one) {
    return one.pace ? one.pace->median_s : 0.0;
  };
  const ConditionVerdict* slowest = nullptr;
  for (const ConditionVerdict& one : verdict.conditions)
    if (is_sufficient(one.ruling) &&
        (slowest == nullptr || computing_s(one) > computing_s(*slowest)))
      slowest = &one;
  if (slowest == nullptr) return "";
  std::string text = fmt::format(" “{}” is {}", slowest->condition, name(slowest->ruling));
  if (computing_s(*slowest) > 0.0 && computing_s(lead) > computing_s(*slowest))
    text += fmt::format(": an image costs {} instead of {}, {} × less",
                        short_ms(computing_s(*slowest)), short_ms(computing_s(lead)),
                        fixed(computing_s(lead) / computing_s(*slowest), 1));
  return text + ".";
}

std::vector<Answer> sufficient_factors(const std::vector<Verdict>& points) {
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < points.front().conditions.size(); ++i) {
    std::map<std::string, ByFactor> flown;
    for (const Verdict& point : points) {
      const auto factor = std::ranges::find_if(point.settings, is_factor);
      if (factor == point.settings.end()) return {};
      if (const auto value = number_in(factor->value))
        flown[fmt::format("“{}”{}", point.conditions[i].condition, other_settings(point))][*value] =
            point.conditions[i].ruling;
    }
    for (const auto& [what, by_factor] : flown)
      if (auto answer = sufficient_factor(what, by_factor)) answers.push_back(std::move(*answer));
  }
  return answers;
}

std::string faster_advice(const ConditionVerdict& lead) {
  const std::string command = size_command(lead, true);
  return "The program reads every image, so the computer may not be the cause. To see whether a "
         "faster one would do" +
         (command.empty() ? ", fly on one." : ": " + command);
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
      "`tether size` finds {}, for a scenario's own conditions on virtual targets. Add the one "
      "that was flown here to the scenario.",
      what);
}

}  // namespace tether::report
