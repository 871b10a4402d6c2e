#include "answers/sufficient.h"

#include "tables/report_format.h"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>

namespace tether::report {
namespace {

constexpr std::string_view kFactorKey = "cpu_factor";

/// What was flown with one condition at one combination of the other values, by cpu_factor.
using ByFactor = std::map<double, const ConditionVerdict*>;

bool is_of(const campaign::Setting& setting, std::initializer_list<std::string_view> keys) {
  return std::ranges::any_of(keys, [&](std::string_view key) {
    return setting.key == key || setting.key == fmt::format("condition.{}", key);
  });
}

/// One flight at each factor shows that flight only, and a world without its wind less.
std::optional<Answer> sufficient_factor(const std::string& what, const ByFactor& flown) {
  const auto next = std::ranges::find_if(
      flown, [](const auto& one) { return !is_sufficient(one.second->ruling); });
  if (next == flown.begin()) return std::nullopt;
  const auto& [factor, largest] = *std::prev(next);
  const bool is_one_flight =
      std::all_of(flown.begin(), next, [](const auto& one) { return one.second->distinct == 1; });
  const bool is_as_written = std::all_of(flown.begin(), next, [](const auto& one) {
    return one.second->left_out.empty() && one.second->doubtful_goals.empty() &&
           one.second->uncharged.empty();
  });
  return Answer{
      fmt::format(
          "{} {:g} × slower would do{}", is_one_flight ? "In one flight each, up to" : "Up to",
          factor,
          is_as_written ? "" : ", but not everything is simulated as written, or is doubtful"),
      fmt::format(": {} is {} at cpu_factor = {:g}, {}.", what, name(largest->ruling), factor,
                  next == flown.end()
                      ? "the largest that was flown"
                      : fmt::format("and {} at {:g}", name(next->second->ruling), next->first))};
}

}  // namespace

bool is_sufficient(Ruling ruling) {
  return ruling == Ruling::kFastEnough || ruling == Ruling::kFastEnoughSoFar;
}

std::string settings_beside(std::initializer_list<std::string_view> keys, const Verdict& point) {
  std::string text;
  for (const campaign::Setting& setting : point.settings)
    if (!is_of(setting, keys))
      text += fmt::format("{}{} = {}", text.empty() ? " with " : ", ", setting.key, setting.value);
  return text;
}

std::vector<Answer> sufficient_factors(const std::vector<Verdict>& points) {
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < points.front().conditions.size(); ++i) {
    std::map<std::string, ByFactor> flown;
    for (const Verdict& point : points) {
      const auto factor = std::ranges::find_if(
          point.settings, [](const auto& setting) { return is_of(setting, {kFactorKey}); });
      if (factor == point.settings.end()) return {};
      if (const auto value = number_in(factor->value))
        flown[fmt::format("“{}”{}", point.conditions[i].condition,
                          settings_beside({kFactorKey}, point))][*value] = &point.conditions[i];
    }
    // Where another key varies with the factor, nothing shows what made the difference.
    const bool varies_alone = flown.size() == 1 || std::ranges::any_of(flown, [](const auto& one) {
                                return one.second.size() > 1;
                              });
    if (!varies_alone) continue;
    for (const auto& [what, by_factor] : flown)
      if (auto answer = sufficient_factor(what, by_factor)) answers.push_back(std::move(*answer));
  }
  return answers;
}

std::string reservation_on(std::span<const campaign::TrialResult* const> trials) {
  const char* reservation = "";
  for (const campaign::TrialResult* trial : trials) {
    if (trial->outcome != campaign::Outcome::kGoalReached) continue;
    for (const Warning& warning : trial->warnings) {
      if (!warning.can_change_verdict) continue;
      if (warning.consequence != Consequence::kDoubtful) return kNotAsWritten;
      reservation = kDoubtful;
    }
  }
  return reservation;
}

std::vector<const campaign::TrialResult*> pointers_to(
    const std::vector<campaign::TrialResult>& trials) {
  std::vector<const campaign::TrialResult*> pointers;
  for (const campaign::TrialResult& trial : trials) pointers.push_back(&trial);
  return pointers;
}

const std::vector<std::string>& ConditionVerdict::doubts_of_answer() const {
  return is_sufficient(ruling) ? doubtful_goals : doubtful;
}

bool is_in_doubt(const ConditionVerdict& condition) {
  return (is_sufficient(condition.ruling) || condition.ruling == Ruling::kNotFastEnough) &&
         !condition.doubts_of_answer().empty();
}

}  // namespace tether::report
