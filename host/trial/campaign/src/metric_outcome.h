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

// One function for each kind of metric.
#define TETHER_DECLARE(function, ...) \
  MetricOutcome function(const scenario::Metric& metric, const record::Record& record);
TETHER_METRICS(TETHER_DECLARE)
#undef TETHER_DECLARE

}  // namespace tether::campaign
