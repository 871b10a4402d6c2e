#include <algorithm>

#include <fmt/format.h>

#include <tether/base/random.h>
#include <tether/base/text.h>
#include <tether/stats/sample_statistics.h>
#include <tether/timing/timing.h>

namespace tether::timing {
namespace {

constexpr int kResamples = 1000;
constexpr double kLeastShare = 1e-3;

using Samples = std::vector<double>;

double median_of(Samples values) {
  std::sort(values.begin(), values.end());
  return stats::quantile(values, 0.5);
}

/// The median of as many values, drawn from them with repetition.
double resampled_median(const Samples& values, KeyedRandom& random) {
  Samples drawn(values.size());
  for (double& value : drawn)
    value = values[static_cast<std::size_t>(random.uniform() * static_cast<double>(values.size()))];
  const auto middle = drawn.begin() + static_cast<std::ptrdiff_t>(drawn.size() / 2);
  std::nth_element(drawn.begin(), middle, drawn.end());
  return *middle;
}

/// Of a stage that took no time before, nothing can be said.
double ratio(double now, double before) {
  return before > 0.0 ? now / before : 1.0;
}

StageChange change_of(const std::string& stage, const Samples& now, const Samples& before) {
  KeyedRandom random({0, random_stream(stage, "", "change"), 0});
  Samples ratios(kResamples);
  for (double& drawn : ratios)
    drawn = ratio(resampled_median(now, random), resampled_median(before, random));
  std::sort(ratios.begin(), ratios.end());
  const std::size_t fewest = std::min(now.size(), before.size());
  return {.stage = stage,
          .change = ratio(median_of(now), median_of(before)) - 1.0,
          .low = stats::quantile(ratios, 0.025) - 1.0,
          .high = stats::quantile(ratios, 0.975) - 1.0,
          .few = fewest < kFewSamples ? fewest : 0};
}

std::string percent(double share) {
  const std::string text = fixed(share * 100.0, 0);
  if (text == "-0") return "0";
  return share > 0.0 && text != "0" ? "+" + text : text;
}

}  // namespace

Comparison compare(const Timing& now, const Timing& before) {
  const auto new_samples = samples_of(now), old_samples = samples_of(before);
  Comparison comparison;
  for (const StageRow& row : stage_rows(before)) {
    if (row.share < kLeastShare) continue;
    if (const auto found = new_samples.find(row.stage); found != new_samples.end())
      comparison.stages.push_back(change_of(row.stage, found->second, old_samples.at(row.stage)));
    else
      comparison.removed.push_back(row.stage);
  }
  for (const StageRow& row : stage_rows(now))
    if (row.share >= kLeastShare && !old_samples.contains(row.stage))
      comparison.added.push_back(row.stage);
  return comparison;
}

bool is_beyond(const Comparison& comparison, double limit) {
  return std::ranges::any_of(comparison.stages,
                             [&](const StageChange& stage) { return stage.change > limit; });
}

std::string to_text(const Comparison& comparison, const double* limit) {
  std::string out;
  for (const StageChange& stage : comparison.stages) {
    out += fmt::format("{} {} % [{}, {}]", stage.stage, percent(stage.change), percent(stage.low),
                       percent(stage.high));
    if (limit != nullptr) {
      const double margin = (1.0 + *limit) / (1.0 + stage.change);
      out += margin >= 1.0 ? fmt::format(", margin left {}x", fixed(margin, 2))
                           : fmt::format(", beyond the limit of {} %", percent(*limit));
    }
    if (stage.few > 0) out += fmt::format(" ({} of the {} samples needed)", stage.few, kFewSamples);
    out += '\n';
  }
  for (const std::string& stage : comparison.added)
    out += fmt::format("{}: new; the old timing does not have it\n", stage);
  for (const std::string& stage : comparison.removed)
    out += fmt::format("{}: missing from the new timing\n", stage);
  if (!comparison.doubt.empty()) out += comparison.doubt + '\n';
  return out;
}

}  // namespace tether::timing
