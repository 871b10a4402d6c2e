#include "tables/read_metric.h"

#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <tether/base/units.h>

namespace tether::scenario {
namespace {

std::vector<std::string> uav_names(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const UavSetup& uav : scenario.uavs) names.push_back(uav.placement.name);
  return names;
}

// The one that is named, or the only one there is.
std::string choose(const toml::Table& table, std::string_view key,
                   const std::vector<std::string>& candidates) {
  if (!table.has(key) && candidates.size() == 1) return candidates.front();
  const std::vector<std::string_view> allowed(candidates.begin(), candidates.end());
  return candidates[table.choice(key, allowed)];
}

const MetricKind& read_metric_kind(const toml::Table& table) {
  std::vector<std::string_view> names;
  for (const MetricKind& kind : metric_kinds()) names.push_back(kind.name);
  return metric_kinds()[table.choice("kind", names)];
}

void reject_unsupported(const toml::Table& table, const MetricKind& kind) {
  const std::pair<std::string_view, bool> supported[] = {
      {"anchor", kind.needs_anchor},
      {"sensor", kind.needs_sensor},
      {"threshold_deg", kind.default_threshold_deg.has_value()},
      {"threshold_m_s", kind.has_speed_threshold}};
  for (const auto& [key, is_supported] : supported) {
    if (is_supported || !table.has(key)) continue;
    table.fail(key, fmt::format("is not supported by metric kind \"{}\".", kind.name));
  }
  const std::string limit = limit_key(kind);
  for (const std::string& key : table.keys()) {
    const bool is_limit = key.starts_with("max") || key.starts_with("min");
    if (!is_limit || key == limit) continue;
    table.fail(key, fmt::format("is not the limit of metric kind \"{}\". Did you mean '{}'?",
                                kind.name, limit));
  }
}

Metric read_metric(const toml::Table& table, const Scenario& scenario) {
  constexpr toml::Range kLimit{.min = 0.0, .max = 1e9};
  constexpr toml::Range kThreshold_deg{.min = 0.0, .max = 180.0};
  constexpr toml::Range kThreshold_m_s{.min = 0.0, .max = 1e9};
  const MetricKind& kind = read_metric_kind(table);
  reject_unsupported(table, kind);
  Metric metric;
  metric.kind = kind.name;
  metric.unit = kind.unit;
  metric.uav = choose(table, "uav", uav_names(scenario));
  const bool is_alone = scenario.uavs.size() == 1;
  metric.name = table.has("name") ? table.identifier("name")
                : is_alone        ? metric.kind
                                  : metric.kind + "_" + metric.uav;
  metric.label = table.text_or(
      "label", is_alone ? std::string(kind.label) : fmt::format("{}, {}", kind.label, metric.uav));
  if (kind.needs_anchor && scenario.anchors.empty())
    table.fail("kind",
               fmt::format("is \"{}\", which needs an anchor. Name one in 'anchors'.", kind.name));
  if (kind.needs_anchor) metric.anchor = choose(table, "anchor", scenario.anchors);
  if (kind.needs_sensor) {
    metric.sensor = table.text("sensor");
    metric.line = table.where("sensor").line;
  }
  const double threshold_deg = kind.default_threshold_deg.value_or(0.0);
  metric.threshold_rad =
      rad_from_deg(table.number_or("threshold_deg", kThreshold_deg, threshold_deg));
  if (kind.has_speed_threshold) {
    const double allowed_m_s = scenario.max_contact_speed_m_s;
    metric.threshold_m_s =
        table.number_or("threshold_m_s", kThreshold_m_s,
                        std::isfinite(allowed_m_s) ? allowed_m_s : kHardContact_m_s);
  }
  metric.of_any_flight = kind.of_any_flight;
  const std::string limit = limit_key(kind);
  metric.limit_line = table.where(table.has(limit) ? limit : "kind").line;
  if (table.has(limit)) {
    const double value = table.number(limit, kLimit);
    (kind.is_better_if_more ? metric.min : metric.max) = value;
    if ((kind.is_better_if_more && value == 0.0) ||
        (kind.unit == "deg" && value >= kThreshold_deg.max))
      table.fail(limit,
                 fmt::format("is {:g}, which nothing can miss. Give a limit that a bad flight "
                             "misses, or remove the key.",
                             value));
  }
  return metric;
}

}  // namespace

void read_metrics(const toml::Table& root, Scenario& scenario) {
  std::set<std::string> names;
  for (const toml::Table& table :
       root.tables_or_none("metric", {"name", "kind", "label", "uav", "anchor", "sensor",
                                      "threshold_deg", "max", "threshold_m_s", "max_s", "max_ms",
                                      "max_m", "max_deg", "max_j", "min_m", "min"})) {
    scenario.metrics.push_back(read_metric(table, scenario));
    const std::string& name = scenario.metrics.back().name;
    if (!names.insert(name).second) {
      table.fail(table.has("name") ? "name" : "kind",
                 fmt::format("makes a second metric \"{}\". Give it another 'name'.", name));
    }
  }
}

}  // namespace tether::scenario
