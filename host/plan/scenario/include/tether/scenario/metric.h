#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

/// How a run is evaluated: numbers computed from the record, against its ground truth. `campaign`
/// computes them; here are the kinds that a scenario may request.
namespace tether::scenario {

/// A number to compute after a run, with the limit up to which the goal counts as reached.
struct Metric {
  std::string name;             ///< unique within the scenario; by default its kind
  std::string kind;             ///< one of `metric_kinds()`
  std::string label;            ///< for tables, without unit
  std::string unit;             ///< of the value and of `max`: "s", "m", "deg", "1"
  std::string uav;              ///< name
  std::string anchor;           ///< empty if the kind needs none
  double threshold_rad = 0.0;   ///< 0 if the kind has none
  std::optional<double> max;    ///< in `unit`; the goal is missed beyond it
  std::string sensor{};         ///< empty if the kind needs none
  int line = 0;                 ///< of its `sensor`, in the scenario's file; 0 if it has none
  std::optional<double> min{};  ///< in `unit`; the goal is missed below it
  double threshold_m_s = 0.0;   ///< 0 if the kind has none
  bool of_any_flight = false;   ///< as its kind
  int limit_line = 0;           ///< of its limit or, without one, of its kind
};

/// A kind of metric (docs/guide/scenario.md defines it) and the keys that it supports.
struct MetricKind {
  std::string_view name;
  std::string_view label;
  std::string_view unit;
  bool needs_anchor = false;
  bool needs_sensor = false;
  std::optional<double> default_threshold_deg{};  ///< set: has a threshold
  bool has_speed_threshold = false;
  bool is_better_if_more = false;  ///< its limit is a minimum
  bool of_any_flight = false;      ///< it has a value even if the SUT missed its goal
};

// All kinds: a row is the function of `campaign` that computes it, which has the name of the kind,
// and the other members of MetricKind.
#define TETHER_METRICS(ROW)                                                                     \
  ROW(time_required, .label = "Time required", .unit = "s")                                     \
  ROW(oscillations, .label = "Oscillations", .unit = "1", .needs_anchor = true,                 \
      .default_threshold_deg = 1.0)                                                             \
  ROW(final_bearing_error, .label = "Final bearing error", .unit = "deg", .needs_anchor = true) \
  ROW(bearing_error, .label = "Bearing error", .unit = "deg", .needs_anchor = true)             \
  ROW(distance_error, .label = "Distance error", .unit = "m", .needs_anchor = true)             \
  ROW(abeam_error, .label = "Abeam error", .unit = "m", .needs_anchor = true)                   \
  ROW(return_error, .label = "Return error", .unit = "m")                                       \
  ROW(estimate_error, .label = "Estimate error", .unit = "m")                                   \
  ROW(acquisition_time, .label = "Acquisition time", .unit = "ms", .needs_sensor = true)        \
  ROW(collisions, .label = "Collisions", .unit = "1", .has_speed_threshold = true,              \
      .of_any_flight = true)                                                                    \
  ROW(min_clearance_m, .label = "Least clearance, floor included", .unit = "m",                 \
      .is_better_if_more = true, .of_any_flight = true)                                         \
  ROW(energy_j, .label = "Energy", .unit = "J")                                                 \
  ROW(delivery_ratio, .label = "Delivery ratio", .unit = "1", .is_better_if_more = true,        \
      .of_any_flight = true)                                                                    \
  ROW(age_of_information, .label = "Age of information", .unit = "s", .of_any_flight = true)

/// What a scenario sets of each.
std::span<const MetricKind> metric_kinds();

/// nullptr if there is none of that name.
const MetricKind* find_metric_kind(std::string_view name);

/// The unit as a suffix of keys: "max" (or "min") + this is the key of a limit ("_s", "_m", "_deg",
/// "" for counts).
std::string unit_suffix(std::string_view unit);
/// The key of the kind's limit: "max_s", "min", …
std::string limit_key(const MetricKind& kind);

}  // namespace tether::scenario
