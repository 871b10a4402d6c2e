#include "answers/other_reasons.h"

#include "answers/sufficient.h"

#include <algorithm>
#include <vector>

#include <tether/campaign/statistics.h>

// A missed goal says "not fast enough" only as long as nothing else explains it. Two comparisons
// exclude the computer: the goal is missed on an infinitely fast one, too; or the same computer
// reaches it under another condition. Whatever is not known to be the same counts as different.
namespace tether::report {
namespace {

constexpr double kSameCost = 1.1;  // of an image, from flight to flight
constexpr double kLeastChance = 0.05;

struct Compared {
  ConditionVerdict* verdict;
  const campaign::TrialResult* flight;  ///< any with a result
};

bool is_missed(const Compared& one) {
  return one.verdict->ruling == Ruling::kNotFastEnough && one.verdict->pace;
}

bool is_instant(const Compared& one) {
  return one.verdict->pace && one.verdict->pace->speed.is_instant();
}

bool have_same_sensors(const Compared& a, const Compared& b) {
  const auto simulator = [](const Compared& one) {
    const auto found = one.flight->versions.find("simulator");
    return found == one.flight->versions.end() ? "" : found->second;
  };
  return a.flight->profiles == b.flight->profiles && simulator(a) == simulator(b);
}

/// Results do not have the radio, which differs between conditions. One UAV has none.
bool has_no_radio(const Compared& one) {
  return one.flight->suts.size() == 1;
}

bool costs_no_more(const Pace& image, const Pace& other) {
  if (image.speed.is_scripted()) return true;
  return !image.camera.empty() && image.camera == other.camera &&
         image.median_s <= kSameCost * other.median_s && image.p95_s <= kSameCost * other.p95_s;
}

/// Whether chance does not explain that one of them reaches the goal more often: Fisher's exact
/// test, which is the rank test of zeros and ones.
bool is_significant(const ConditionVerdict& a, const ConditionVerdict& b) {
  const auto flights = [](const ConditionVerdict& one) {
    std::vector<double> reached(one.flown, 0.0);
    std::fill_n(reached.begin(), one.reached, 1.0);
    return reached;
  };
  return campaign::mann_whitney(flights(a), flights(b)).p_two_sided < kLeastChance;
}

bool is_equally_fast_and_reaches(const Compared& other, const Compared& missed) {
  return is_sufficient(other.verdict->ruling) && other.verdict->pace &&
         other.verdict->pace->speed == missed.verdict->pace->speed &&
         have_same_sensors(other, missed) &&
         costs_no_more(*missed.verdict->pace, *other.verdict->pace) &&
         is_significant(*other.verdict, *missed.verdict);
}

std::optional<OtherReason> other_reason(const Compared& missed, const std::vector<Compared>& all) {
  using Evidence = OtherReason::Evidence;
  if (is_instant(missed)) return OtherReason{Evidence::kInstant};
  for (const Compared& other : all)
    if (is_equally_fast_and_reaches(other, missed))
      return OtherReason{Evidence::kEquallyFastReaches, other.verdict->condition};
  const auto is_same_but_for_speed = [&](const Compared& other) {
    return has_no_radio(missed) && has_no_radio(other) && have_same_sensors(other, missed);
  };
  const bool some_speed_suffices = std::ranges::any_of(all, [&](const Compared& other) {
    return is_same_but_for_speed(other) && is_sufficient(other.verdict->ruling);
  });
  if (some_speed_suffices) return std::nullopt;
  for (const Compared& other : all)
    if (is_missed(other) && is_instant(other) && is_same_but_for_speed(other))
      return OtherReason{Evidence::kInstantMissesToo, other.verdict->condition};
  return std::nullopt;
}

}  // namespace

void find_other_reasons(std::vector<ConditionVerdict>& conditions,
                        const campaign::ScenarioResults& scenario) {
  std::vector<Compared> all;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const auto& trials = scenario.conditions[i].trials;
    const auto flown = std::ranges::find_if(trials, [](const campaign::TrialResult& trial) {
      return trial.outcome != campaign::Outcome::kFailed;
    });
    if (flown != trials.end()) all.push_back({&conditions[i], &*flown});
  }
  std::vector<std::optional<OtherReason>> reasons;
  for (const Compared& one : all)
    reasons.push_back(is_missed(one) ? other_reason(one, all) : std::nullopt);
  // Not earlier: each is compared with the rulings as they were.
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!reasons[i]) continue;
    all[i].verdict->other_reason = std::move(reasons[i]);
    all[i].verdict->ruling = Ruling::kOtherReason;
  }
}

}  // namespace tether::report
