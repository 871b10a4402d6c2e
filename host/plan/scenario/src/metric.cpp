#include <algorithm>
#include <array>

#include <tether/scenario/metric.h>

namespace tether::scenario {
namespace {

#define TETHER_KIND(function, ...) MetricKind{.name = #function, __VA_ARGS__},
constexpr std::array kMetricKinds = {TETHER_METRICS(TETHER_KIND)};
#undef TETHER_KIND

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
