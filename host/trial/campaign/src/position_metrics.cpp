#include "metric_outcome.h"

#include <cmath>

#include <tether/campaign/metrics.h>
#include <tether/record/reader.h>

/// The UAV's final position against the intended one (paper, Tables IV and V).
namespace tether::campaign {
namespace {

double horizontal_m(const uav::Vec3& v) {
  return std::hypot(v.x, v.y);
}

MetricOutcome why_no_end(const scenario::Metric& metric, const record::Record& record) {
  const bool finished = find_finish(record, metric.uav) != nullptr;
  return finished ? no_ground_truth(metric) : no_finish(metric);
}

}  // namespace

std::optional<StartAndEnd> start_and_end(const record::Record& record, const std::string& uav) {
  const std::optional<SimTime> finish = finish_time(record, uav);
  if (!finish) return std::nullopt;
  const std::optional<uav::Pose> start = pose_at(record, uav, SimTime{});
  const std::optional<uav::Pose> end = pose_at(record, uav, *finish);
  if (!start || !end) return std::nullopt;
  return StartAndEnd{*start, *end};
}

// The anchor is abeam at the foot of its perpendicular on the start line, where it was at ST 0.
MetricOutcome abeam_error(const scenario::Metric& metric, const record::Record& record) {
  const record::Anchor* anchor = find_anchor(record, metric.anchor);
  if (anchor == nullptr) return no_anchor(metric);
  const auto path = start_and_end(record, metric.uav);
  if (!path) return why_no_end(metric, record);
  const double yaw_rad = uav::yaw_rad(path->start.q);
  const uav::Vec3 ahead{std::cos(yaw_rad), std::sin(yaw_rad), 0.0};
  const record::Anchor start = record::AnchorTrack(*anchor, record).at(SimTime{});
  const uav::Vec3 p_WA{start.p_WA_m[0], start.p_WA_m[1], start.p_WA_m[2]};
  const double along_m = dot(p_WA - path->start.p, ahead);
  const uav::Vec3 abeam = path->start.p + along_m * ahead;
  return {horizontal_m(path->end.p - abeam), ""};
}

MetricOutcome return_error(const scenario::Metric& metric, const record::Record& record) {
  const auto path = start_and_end(record, metric.uav);
  if (!path) return why_no_end(metric, record);
  return {horizontal_m(path->end.p - path->start.p), ""};
}

}  // namespace tether::campaign
