#include <algorithm>
#include <array>

#include <tether/scenario/metric.h>

namespace tether::scenario {
namespace {

constexpr std::array kKinds = {
    MetricKind{"time_required", "Time required", "s", false, std::nullopt,
               "ST at which the SUT said that it had finished"},
    MetricKind{"oscillations", "Oscillations", "1", true, 1.0,
               "how often the UAV turned past the anchor by more than threshold_deg"},
    MetricKind{"final_bearing_error", "Final bearing error", "deg", true, std::nullopt,
               "magnitude of the true bearing of the anchor when the SUT finished"},
};

}  // namespace

std::span<const MetricKind> metric_kinds() {
  return kKinds;
}

const MetricKind* find_metric_kind(std::string_view kind) {
  const auto found = std::find_if(kKinds.begin(), kKinds.end(),
                                  [&](const MetricKind& k) { return k.name == kind; });
  return found == kKinds.end() ? nullptr : &*found;
}

std::string unit_suffix(std::string_view unit) {
  return unit == "1" ? std::string() : "_" + std::string(unit);
}

}  // namespace tether::scenario
