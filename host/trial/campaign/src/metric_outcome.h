#pragma once

#include <optional>
#include <string>

#include <tether/record/reader.h>
#include <tether/scenario/metric.h>
#include <tether/uav/math.h>

/// Shared by the sources that compute metrics.
namespace tether::campaign {

/// A value in the unit of its kind, or the reason why there is none.
struct MetricOutcome {
  std::optional<double> value;
  std::string missing_because;
};

MetricOutcome missing(std::string because);
MetricOutcome no_finish(const scenario::Metric& metric);
MetricOutcome no_anchor(const scenario::Metric& metric);
MetricOutcome no_ground_truth(const scenario::Metric& metric);

/// nullptr if there is none of that name.
const record::Anchor* find_anchor(const record::Record& record, const std::string& name);
/// The request with which the SUT of `uav` finished; nullptr: it did not.
const record::Logged<record::Interaction>* find_finish(const record::Record& record,
                                                       const std::string& uav);

/// Where a UAV was when its SUT started and finished, in W.
struct StartAndEnd {
  uav::Pose start;
  uav::Pose end;
};
/// None if the SUT did not finish, or ground truth lacks one of the two.
std::optional<StartAndEnd> start_and_end(const record::Record& record, const std::string& uav);

// Kinds (scenario::metric_kinds()). Of the UAV's path:
MetricOutcome abeam_error(const scenario::Metric& metric, const record::Record& record);
MetricOutcome return_error(const scenario::Metric& metric, const record::Record& record);
// Of what it touched:
MetricOutcome collisions(const scenario::Metric& metric, const record::Record& record);
MetricOutcome energy_spent(const scenario::Metric& metric, const record::Record& record);
MetricOutcome min_clearance(const scenario::Metric& metric, const record::Record& record);
// Of the radio:
MetricOutcome delivery_ratio(const scenario::Metric& metric, const record::Record& record);
MetricOutcome age_of_information(const scenario::Metric& metric, const record::Record& record);
// Of the SUT's own estimates:
MetricOutcome bearing_error(const scenario::Metric& metric, const record::Record& record);
MetricOutcome distance_error(const scenario::Metric& metric, const record::Record& record);
MetricOutcome estimate_error(const scenario::Metric& metric, const record::Record& record);

}  // namespace tether::campaign
