#include "sensors/sensor_key.h"

#include <fmt/format.h>

namespace tether::scenario {

std::vector<SensorKey> keys_of(std::type_identity<sim::ScanModel>) {
  using sim::ScanModel;
  constexpr toml::Range kSweep_ms{.min = 0.0, .max = 1000.0};
  const auto read_rays = [](const toml::Table& table, std::string_view key) {
    const auto rays = table.integers(key, 1);
    if (rays.size() != 2)
      table.fail(key, fmt::format("must be [columns, rows], but has {} elements", rays.size()));
    constexpr auto kMost = static_cast<std::int64_t>(uav::kMaxScanRays);
    if (rays[0] > kMost || rays[1] > kMost || rays[0] * rays[1] > kMost)
      table.fail(key, fmt::format("must be at most {} rays", kMost));
    return std::pair{static_cast<int>(rays[0]), static_cast<int>(rays[1])};
  };
  return {
      row<ScanModel>("rays", read_rays,
                     [](ScanModel& scan, const std::pair<int, int>& rays) {
                       scan.rays.columns = rays.first;
                       scan.rays.rows = rays.second;
                     }),
      row<ScanModel>("sweep_ms", number(kSweep_ms, 1e-3),
                     [](ScanModel& scan, double sweep_s) { scan.rays.sweep_s = sweep_s; }),
      row<ScanModel>("min_m", number(kDistance_m),
                     [](ScanModel& scan, double min_m) { scan.rays.min_m = min_m; }),
      row<ScanModel>("max_m", number(kFarthest_m),
                     [](ScanModel& scan, double max_m) { scan.rays.max_m = max_m; }),
      row<ScanModel>("resolution_m", number(kDistance_m), &ScanModel::resolution_m),
      row<ScanModel>("dropout_probability", number(kProbability), &ScanModel::dropout_probability),
      row<ScanModel>("noise_m", noise, &ScanModel::noise),
  };
}

// The rays of the next scan follow those of this one.
void complete(sim::ScanModel& scan, const Finished& sensor) {
  sensor.check_limits(scan.rays.min_m, scan.rays.max_m);
  const auto* periodic = std::get_if<uav::PeriodicTiming>(&sensor.timing);
  if (periodic == nullptr || scan.rays.sweep_s <= to_seconds(periodic->period)) return;
  sensor.refuse({"sweep_ms", "timing"},
                fmt::format("has sweep_ms = {:.6g}. It must be at most the period, {:.6g}.",
                            scan.rays.sweep_s * 1e3, to_seconds(periodic->period) * 1e3));
}

}  // namespace tether::scenario
