#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <tether/base/units.h>
#include <tether/experiment/metrics.h>

namespace tether::experiment {
namespace {

struct Outcome {
  std::optional<double> value;
  std::string missing_because;
};

double yaw_rad(const double q_WB[4]) {
  const double w = q_WB[0], x = q_WB[1], y = q_WB[2], z = q_WB[3];
  return std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
}

const record::Anchor* find_anchor(const record::Record& record, const std::string& name) {
  for (const record::Anchor& anchor : record.header.anchors) {
    if (anchor.name == name) return &anchor;
  }
  return nullptr;
}

Outcome no_finish(const scenario::Metric& metric) {
  return {std::nullopt, fmt::format("the SUT of '{}' did not finish", metric.uav)};
}

// Bearings of the anchor from the UAV, up to the moment when its SUT finished (or the run ended).
std::vector<double> bearings_until_finish(const scenario::Metric& metric,
                                          const record::Record& record,
                                          const record::Anchor& anchor) {
  const std::optional<SimTime> finish = finish_time(record, metric.uav);
  std::vector<double> bearings_rad;
  for (const auto& logged : record.ground_truth) {
    const record::GroundTruth& truth = logged.message;
    if (truth.uav != metric.uav || (finish && truth.at > *finish)) continue;
    bearings_rad.push_back(true_bearing_rad(truth, anchor));
  }
  return bearings_rad;
}

Outcome with_bearings(const scenario::Metric& metric, const record::Record& record,
                      double (*evaluate)(const scenario::Metric&, const std::vector<double>&)) {
  const record::Anchor* anchor = find_anchor(record, metric.anchor);
  if (anchor == nullptr) {
    return {std::nullopt, fmt::format("the record has no anchor '{}'", metric.anchor)};
  }
  const std::vector<double> bearings_rad = bearings_until_finish(metric, record, *anchor);
  if (bearings_rad.empty()) {
    return {std::nullopt, fmt::format("the record has no ground truth of '{}'", metric.uav)};
  }
  return {evaluate(metric, bearings_rad), ""};
}

Outcome time_required(const scenario::Metric& metric, const record::Record& record) {
  const std::optional<SimTime> finish = finish_time(record, metric.uav);
  return finish ? Outcome{to_seconds(*finish), ""} : no_finish(metric);
}

Outcome oscillations(const scenario::Metric& metric, const record::Record& record) {
  return with_bearings(metric, record,
                       [](const scenario::Metric& m, const std::vector<double>& bearings_rad) {
                         return double{1} * count_overshoots(bearings_rad, m.threshold_rad);
                       });
}

Outcome final_bearing_error(const scenario::Metric& metric, const record::Record& record) {
  if (!finish_time(record, metric.uav)) return no_finish(metric);
  return with_bearings(metric, record,
                       [](const scenario::Metric&, const std::vector<double>& bearings_rad) {
                         return deg_from_rad(std::abs(bearings_rad.back()));
                       });
}

struct Kind {
  std::string_view name;
  Outcome (*compute)(const scenario::Metric&, const record::Record&);
};

// One entry for each of scenario::metric_kinds().
constexpr std::array kKinds = {
    Kind{"time_required", time_required},
    Kind{"oscillations", oscillations},
    Kind{"final_bearing_error", final_bearing_error},
};

Outcome compute(const scenario::Metric& metric, const record::Record& record) {
  for (const Kind& kind : kKinds) {
    if (kind.name == metric.kind) return kind.compute(metric, record);
  }
  return {std::nullopt, fmt::format("there is no metric of the kind '{}'", metric.kind)};
}

}  // namespace

double true_bearing_rad(const record::GroundTruth& uav, const record::Anchor& anchor) {
  const double dx_m = anchor.p_WA_m[0] - uav.p_WB_m[0];
  const double dy_m = anchor.p_WA_m[1] - uav.p_WB_m[1];
  return wrap_angle_rad(std::atan2(dy_m, dx_m) - yaw_rad(uav.q_WB));
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
  for (const auto& logged : record.interactions) {
    const record::Interaction& interaction = logged.message;
    if (interaction.kind != record::kFinish || interaction.uav != uav) continue;
    const bool free_running = record.header.policy == record::kFreeRunning;
    return free_running ? interaction.st_at_arrival : same_instant(interaction.request_at);
  }
  return std::nullopt;
}

std::vector<MetricValue> compute_metrics(std::span<const scenario::Metric> metrics,
                                         const record::Record& record) {
  std::vector<MetricValue> values;
  for (const scenario::Metric& metric : metrics) {
    Outcome outcome = compute(metric, record);
    if (outcome.value && !std::isfinite(*outcome.value)) {
      outcome = {std::nullopt, "the ground truth is not finite"};
    }
    values.push_back({metric.name, metric.kind, metric.label, metric.unit, outcome.value,
                      outcome.missing_because, metric.max});
  }
  return values;
}

}  // namespace tether::experiment
