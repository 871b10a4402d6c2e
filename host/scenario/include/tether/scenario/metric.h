#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

/// What a run is judged by: numbers computed from the record, against its ground truth
/// (`campaign` computes them; here is what a scenario may ask for).
namespace tether::scenario {

/// A number to compute after a run, with the limit within which the goal counts as reached.
struct Metric {
  std::string name;            ///< unique within the scenario; by default its kind
  std::string kind;            ///< one of `metric_kinds()`
  std::string label;           ///< for tables, without unit
  std::string unit;            ///< of the value and of `max`: "s", "m", "deg", "1"
  std::string uav;             ///< whose
  std::string anchor;          ///< of those that need one, else empty
  double threshold_rad = 0.0;  ///< of those that have one
  std::optional<double> max;   ///< in `unit`; the goal is missed beyond it
  std::string sensor{};        ///< of those that need one, else empty
  int line = 0;                ///< of its `sensor`, in the scenario's file; 0: it has none
};

/// A kind of metric and what it takes.
struct MetricKind {
  std::string_view name;
  std::string_view label;
  std::string_view unit;
  bool needs_anchor = false;
  bool needs_sensor = false;
  std::optional<double> default_threshold_deg{};  ///< set: has a threshold
  std::string_view help;                          ///< one line: the definition
};

/// All kinds, in the order in which help lists them.
std::span<const MetricKind> metric_kinds();
/// nullptr where there is none of that name.
const MetricKind* find_metric_kind(std::string_view kind);

/// The unit as a suffix of keys: "max" + this is the key of a limit ("_s", "_m", "_deg", "" for
/// counts).
std::string unit_suffix(std::string_view unit);

}  // namespace tether::scenario
