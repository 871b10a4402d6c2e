#include "metric_outcome.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <tether/base/units.h>
#include <tether/campaign/metrics.h>
#include <tether/record/reader.h>
#include <tether/uav/math.h>

// The metrics of time and bearing, what all metrics share, and the table of all kinds.
namespace tether::campaign {
namespace {

// Bearings of the anchor from the UAV, up to the moment when its SUT finished (or the run ended).
std::vector<double> bearings_until_finish(const scenario::Metric& metric,
                                          const record::Record& record,
                                          const record::Anchor& anchor) {
  const std::optional<SimTime> finish = finish_time(record, metric.uav);
  const record::AnchorTrack track(anchor, record);
  std::vector<double> bearings_rad;
  for (const auto& logged : record.ground_truth) {
    const record::GroundTruth& truth = logged.message;
    if (truth.uav != metric.uav || (finish && truth.at > *finish)) continue;
    bearings_rad.push_back(true_bearing_rad(truth, track.at(truth.at)));
  }
  return bearings_rad;
}

template <class Evaluate>
MetricOutcome with_bearings(const scenario::Metric& metric, const record::Record& record,
                            const Evaluate& evaluate) {
  const record::Anchor* anchor = find_anchor(record, metric.anchor);
  if (anchor == nullptr) return no_anchor(metric);
  const std::vector<double> bearings_rad = bearings_until_finish(metric, record, *anchor);
  if (bearings_rad.empty()) return no_ground_truth(metric);
  return {evaluate(bearings_rad), ""};
}

// ST per second of wall time, as achieved: at most the limit, less where the simulator was too
// slow.
double pace(const record::Record& record) {
  const bool is_known = record.footer && record.footer->wall > Duration(0);
  if (!is_known) return record.header.real_time_factor;
  return to_seconds(record.footer->st_at_end) / to_seconds(record.footer->wall);
}

// How long the SUT waited for its data: under the barrier by its own clock, which is synchronised
// with ST; without the barrier by the wall clock, at the pace of ST. That is the coordinator's part
// and the link's, which the SUT reports with its next request.
Duration waited(const record::Interaction& read, const record::Interaction* next,
                const record::Record& record) {
  if (record.header.policy != record::kFreeRunning) return read.reply_at - read.request_at;
  const Duration link = next ? next->previous_link_time.value_or(Duration(0)) : Duration(0);
  const Duration wall = read.wall_at_release - read.wall_at_arrival + link;
  return duration_from_seconds(pace(record) * to_seconds(wall));
}

std::vector<const record::Interaction*> interactions_of(const std::string& uav,
                                                        const record::Record& record) {
  std::vector<const record::Interaction*> own;
  for (const auto& logged : record.interactions) {
    if (logged.message.uav == uav) own.push_back(&logged.message);
  }
  return own;
}

struct Kind {
  std::string_view name;
  MetricOutcome (*compute)(const scenario::Metric&, const record::Record&);
};

#define TETHER_KIND(function, ...) Kind{#function, function},
constexpr std::array kKinds = {TETHER_METRICS(TETHER_KIND)};
#undef TETHER_KIND

MetricOutcome compute(const scenario::Metric& metric, const record::Record& record) {
  const auto* kind = std::ranges::find(kKinds, metric.kind, &Kind::name);
  if (kind != kKinds.end()) return kind->compute(metric, record);
  return missing(fmt::format("there is no metric of the kind '{}'", metric.kind));
}

}  // namespace

MetricOutcome time_required(const scenario::Metric& metric, const record::Record& record) {
  const std::optional<SimTime> finish = finish_time(record, metric.uav);
  return finish ? MetricOutcome{to_seconds(*finish), ""} : no_finish(metric);
}

MetricOutcome oscillations(const scenario::Metric& metric, const record::Record& record) {
  return with_bearings(metric, record, [&](const std::vector<double>& bearings_rad) {
    return static_cast<double>(count_overshoots(bearings_rad, metric.threshold_rad));
  });
}

MetricOutcome final_bearing_error(const scenario::Metric& metric, const record::Record& record) {
  if (!finish_time(record, metric.uav)) return no_finish(metric);
  return with_bearings(metric, record, [](const std::vector<double>& bearings_rad) {
    return deg_from_rad(std::abs(bearings_rad.back()));
  });
}

// Without the first read, which turns the sensor on: Algorithm 1 does that before it takes the
// time.
MetricOutcome acquisition_time(const scenario::Metric& metric, const record::Record& record) {
  const auto own = interactions_of(metric.uav, record);
  Duration sum{0};
  int reads = -1;
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (own[i]->kind != record::kSensor || own[i]->sensor != metric.sensor) continue;
    if (++reads > 0) sum += waited(*own[i], i + 1 < own.size() ? own[i + 1] : nullptr, record);
  }
  if (reads > 0) return {1e3 * to_seconds(sum) / reads, ""};
  return missing(
      fmt::format("the SUT of '{}' did not read '{}' more than once", metric.uav, metric.sensor));
}

MetricOutcome missing(std::string because) {
  return {std::nullopt, std::move(because)};
}
MetricOutcome no_finish(const scenario::Metric& metric) {
  return missing(fmt::format("the SUT of '{}' did not finish", metric.uav));
}
MetricOutcome no_anchor(const scenario::Metric& metric) {
  return missing(fmt::format("the record has no anchor '{}'", metric.anchor));
}
MetricOutcome no_ground_truth(const scenario::Metric& metric) {
  return missing(fmt::format("the record has no ground truth of '{}' at that time", metric.uav));
}

const record::Anchor* find_anchor(const record::Record& record, const std::string& name) {
  const auto found = std::ranges::find(record.header.anchors, name, &record::Anchor::name);
  return found == record.header.anchors.end() ? nullptr : &*found;
}

const record::Logged<record::Interaction>* find_finish(const record::Record& record,
                                                       const std::string& uav) {
  for (const auto& logged : record.interactions) {
    if (logged.message.kind == record::kFinish && logged.message.uav == uav) return &logged;
  }
  return nullptr;
}

double true_bearing_rad(const record::GroundTruth& uav, const record::Anchor& anchor) {
  const double dx_m = anchor.p_WA_m[0] - uav.p_WB_m[0];
  const double dy_m = anchor.p_WA_m[1] - uav.p_WB_m[1];
  const double(&q)[4] = uav.q_WB;
  return wrap_angle_rad(std::atan2(dy_m, dx_m) - uav::yaw_rad({q[0], q[1], q[2], q[3]}));
}

int count_overshoots(std::span<const double> bearings_rad, double threshold_rad) {
  int overshoots = 0;
  int side = 0;  // on which the bearing was last beyond the threshold; 0: on none yet
  double previous_rad = bearings_rad.empty() ? 0.0 : bearings_rad.front();
  for (const double bearing_rad : bearings_rad) {
    const bool through_the_back = std::abs(bearing_rad - previous_rad) > std::numbers::pi;
    if (through_the_back) side = -side;
    previous_rad = bearing_rad;
    if (std::abs(bearing_rad) <= threshold_rad) continue;
    const int now = bearing_rad > 0.0 ? 1 : -1;
    if (side != 0 && now != side) ++overshoots;
    side = now;
  }
  return overshoots;
}

std::optional<SimTime> finish_time(const record::Record& record, const std::string& uav) {
  const auto* finish = find_finish(record, uav);
  if (finish == nullptr) return std::nullopt;
  const bool free_running = record.header.policy == record::kFreeRunning;
  return free_running ? finish->message.st_at_arrival : same_instant(finish->message.request_at);
}

bool MetricValue::is_better_if_more() const {
  const scenario::MetricKind* known = scenario::find_metric_kind(kind);
  return known && known->is_better_if_more;
}

std::vector<MetricValue> compute_metrics(std::span<const scenario::Metric> metrics,
                                         const record::Record& record) {
  std::vector<MetricValue> values;
  for (const scenario::Metric& metric : metrics) {
    MetricOutcome outcome = compute(metric, record);
    if (outcome.value && !std::isfinite(*outcome.value)) {
      outcome = missing("the value from the record is not finite");
    }
    values.push_back({metric.name, metric.kind, metric.label, metric.unit, outcome.value,
                      outcome.missing_because, metric.max, metric.min});
  }
  return values;
}

}  // namespace tether::campaign
