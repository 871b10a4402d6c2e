#include <algorithm>
#include <array>

#include <tether/scenario/metric.h>

namespace tether::scenario {
namespace {

constexpr std::array kMetricKinds = {
    MetricKind{.name = "time_required",
               .label = "Time required",
               .unit = "s",
               .help = "ST at which the SUT reported that it had finished"},
    MetricKind{.name = "oscillations",
               .label = "Oscillations",
               .unit = "1",
               .needs_anchor = true,
               .default_threshold_deg = 1.0,
               .help = "how often the UAV turned past the anchor by more than threshold_deg"},
    MetricKind{.name = "final_bearing_error",
               .label = "Final bearing error",
               .unit = "deg",
               .needs_anchor = true,
               .help = "magnitude of the true bearing of the anchor when the SUT finished"},
    MetricKind{.name = "bearing_error",
               .label = "Bearing error",
               .unit = "deg",
               .needs_anchor = true,
               .help = "the SUT's last estimated bearing against that of the anchor's true ROI in "
                       "the same image"},
    MetricKind{.name = "distance_error",
               .label = "Distance error",
               .unit = "m",
               .needs_anchor = true,
               .help = "the SUT's last estimated distance against the true horizontal one from the "
                       "camera to the anchor's centre"},
    MetricKind{.name = "abeam_error",
               .label = "Abeam error",
               .unit = "m",
               .needs_anchor = true,
               .help = "horizontal distance from where the SUT finished to the point of the start "
                       "line at which the anchor is abeam"},
    MetricKind{.name = "return_error",
               .label = "Return error",
               .unit = "m",
               .help = "horizontal distance from where the SUT finished to the start"},
    MetricKind{.name = "estimate_error",
               .label = "Estimate error",
               .unit = "m",
               .help = "the SUT's own estimate of its displacement against the true one"},
    MetricKind{.name = "acquisition_time",
               .label = "Acquisition time",
               .unit = "ms",
               .needs_sensor = true,
               .help = "mean time from requesting the sensor's data to receiving it"},
    MetricKind{.name = "collisions",
               .label = "Collisions",
               .unit = "1",
               .has_speed_threshold = true,
               .of_any_flight = true,
               .help = "how often the UAV hit something at more than threshold_m_s"},
    MetricKind{.name = "min_clearance_m",
               .label = "Least clearance, floor included",
               .unit = "m",
               .is_better_if_more = true,
               .of_any_flight = true,
               .help =
                   "least distance from the UAV's collision shapes to any other one, in all of the "
                   "flight, take-off and landing included"},
    MetricKind{.name = "energy_j",
               .label = "Energy",
               .unit = "J",
               .help = "what the UAV's battery lost until the SUT finished; needs 'energy'"},
    MetricKind{.name = "delivery_ratio",
               .label = "Delivery ratio",
               .unit = "1",
               .is_better_if_more = true,
               .of_any_flight = true,
               .help = "share of the UAV's messages that arrived, counted at each receiver"},
    MetricKind{.name = "age_of_information",
               .label = "Age of information",
               .unit = "s",
               .of_any_flight = true,
               .help = "mean age of the newest message that the UAV had from each other UAV, from "
                       "the first one on"},
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
