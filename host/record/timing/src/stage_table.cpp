#include <algorithm>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/stats/sample_statistics.h>
#include <tether/timing/timing.h>

namespace tether::timing {
namespace {

constexpr double kNsPerSecond = 1e9;

}  // namespace

std::string in_ms(double seconds) {
  return fixed(seconds * 1e3, 3);
}

std::vector<StageRow> stage_rows(const Timing& timing) {
  std::vector<StageRow> rows;
  double all_s = 0.0;
  for (auto& [stage, times_ns] : samples_of(timing)) {
    std::sort(times_ns.begin(), times_ns.end());
    const auto quantile = [&, &sorted = times_ns](double share) {
      return stats::quantile(sorted, share) / kNsPerSecond;
    };
    const double sum_s =
        stats::mean(times_ns) * static_cast<double>(times_ns.size()) / kNsPerSecond;
    rows.push_back({.stage = stage,
                    .count = times_ns.size(),
                    .median_s = quantile(0.5),
                    .p95_s = quantile(0.95),
                    .p99_s = quantile(0.99),
                    .worst_s = quantile(1.0),
                    .share = sum_s});
    all_s += sum_s;
  }
  for (StageRow& row : rows) row.share = all_s > 0.0 ? row.share / all_s : 0.0;
  std::stable_sort(rows.begin(), rows.end(),
                   [](const StageRow& a, const StageRow& b) { return a.share > b.share; });
  return rows;
}

std::vector<std::string> warnings(const std::vector<StageRow>& rows) {
  std::vector<std::string> lines;
  for (const StageRow& row : rows)
    if (row.count < kFewSamples)
      lines.push_back(
          fmt::format("stage \"{}\": {} of the {} samples that its quantiles need. "
                      "Record more runs",
                      row.stage, row.count, kFewSamples));
  return lines;
}

std::string to_text(const std::vector<StageRow>& rows, std::size_t columns) {
  std::vector<std::vector<std::string>> lines = {
      {"stage", "", "count", "median ms", "95 % ms", "99 % ms", "worst ms", "share %"}};
  for (const StageRow& row : rows)
    lines.push_back({row.stage, "", std::to_string(row.count), in_ms(row.median_s),
                     in_ms(row.p95_s), in_ms(row.p99_s), in_ms(row.worst_s),
                     fixed(row.share * 100.0, 1)});
  return text_table(lines, columns);
}

}  // namespace tether::timing
