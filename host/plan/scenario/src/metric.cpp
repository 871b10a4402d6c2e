#include <algorithm>
#include <array>

#include <tether/scenario/metric.h>

namespace tether::scenario {
namespace {

constexpr std::array kMetricKinds = {
    MetricKind{.name = "time_required", .label = "Time required", .unit = "s"},
    MetricKind{.name = "oscillations",
               .label = "Oscillations",
               .unit = "1",
               .needs_anchor = true,
               .default_threshold_deg = 1.0},
    MetricKind{.name = "final_bearing_error",
               .label = "Final bearing error",
               .unit = "deg",
               .needs_anchor = true},
    MetricKind{
        .name = "bearing_error", .label = "Bearing error", .unit = "deg", .needs_anchor = true},
    MetricKind{
        .name = "distance_error", .label = "Distance error", .unit = "m", .needs_anchor = true},
    MetricKind{.name = "abeam_error", .label = "Abeam error", .unit = "m", .needs_anchor = true},
    MetricKind{.name = "return_error", .label = "Return error", .unit = "m"},
    MetricKind{.name = "estimate_error", .label = "Estimate error", .unit = "m"},
    MetricKind{.name = "acquisition_time",
               .label = "Acquisition time",
               .unit = "ms",
               .needs_sensor = true},
    MetricKind{.name = "collisions",
               .label = "Collisions",
               .unit = "1",
               .has_speed_threshold = true,
               .of_any_flight = true},
    MetricKind{.name = "min_clearance_m",
               .label = "Least clearance, floor included",
               .unit = "m",
               .is_better_if_more = true,
               .of_any_flight = true},
    MetricKind{.name = "energy_j", .label = "Energy", .unit = "J"},
    MetricKind{.name = "delivery_ratio",
               .label = "Delivery ratio",
               .unit = "1",
               .is_better_if_more = true,
               .of_any_flight = true},
    MetricKind{.name = "age_of_information",
               .label = "Age of information",
               .unit = "s",
               .of_any_flight = true},
};

}  // namespace

std::span<const MetricKind> metric_kinds() {
  return kMetricKinds;
}

const MetricKind* find_metric_kind(std::string_view name) {
  const auto* found = std::ranges::find(kMetricKinds, name, &MetricKind::name);
  return found == kMetricKinds.end() ? nullptr : found;
}

std::string unit_suffix(std::string_view unit) {
  return unit == "1" ? std::string() : "_" + std::string(unit);
}

std::string limit_key(const MetricKind& kind) {
  return (kind.is_better_if_more ? "min" : "max") +
         (kind.unit == "J" ? "_j" : unit_suffix(kind.unit));
}

}  // namespace tether::scenario
