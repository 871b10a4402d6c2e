#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/record/reader.h>
#include <tether/scenario/metric.h>

/// Metrics of a run, computed from its record alone: from ground truth (paper, Section V), and the
/// errors of the SUT's own estimates (Tables II and V). Pure functions.
namespace tether::campaign {

struct MetricValue {
  std::string name;
  std::string kind;
  std::string label;
  std::string unit;             ///< of `value` and `max`
  std::optional<double> value;  ///< none: see `missing_because`
  std::string missing_because;  ///< one line; empty if there is a value
  std::optional<double> max;
  std::optional<double> min{};  ///< of kinds of which more is better

  /// Whether there is a value within its limits.
  bool is_met() const { return value && (!max || *value <= *max) && (!min || *value >= *min); }
  /// As its kind says.
  bool is_better_if_more() const;

  friend bool operator==(const MetricValue&, const MetricValue&) = default;
};

/// One value per metric, in their order. A metric that cannot be computed from the record has no
/// value, but a reason.
std::vector<MetricValue> compute_metrics(std::span<const scenario::Metric> metrics,
                                         const record::Record& record);

/// The horizontal angle from the UAV's heading to the anchor's centre, both in W's x-y plane:
/// positive to the left, in (−π, π] [rad].
double true_bearing_rad(const record::GroundTruth& uav, const record::Anchor& anchor);

/// How often a UAV turned too far (paper, Table III): an overshoot is counted if the bearing was
/// beyond the threshold on one side, passes through zero, and is beyond the threshold on the other
/// side. Passing the anchor by less than the threshold, jitter around zero, and turning through ±π
/// (the anchor behind the UAV) do not count.
/// @param bearings_rad in (−π, π], in order of time, less than half a turn apart.
/// @pre threshold_rad ≥ 0.
int count_overshoots(std::span<const double> bearings_rad, double threshold_rad);

/// ST at which the SUT of `uav` asked to finish; none if it did not. Under the barrier that is the
/// request's own timestamp; in free running, the ST of its arrival (docs/design.md section 2, rule
/// 8).
std::optional<SimTime> finish_time(const record::Record& record, const std::string& uav);

}  // namespace tether::campaign
