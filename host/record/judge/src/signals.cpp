#include "signals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <tether/base/units.h>
#include <tether/uav/math.h>

namespace tether::judge {
namespace {

using record::GroundTruth;

uav::Quat attitude(const GroundTruth& truth) {
  const double(&q)[4] = truth.q_WB;
  return {q[0], q[1], q[2], q[3]};
}

// One function for each quantity: its value at an instant. `reference` is the anchor that the
// quantity is about, or where the UAV began.
using Value = std::optional<double> (*)(const GroundTruth& truth, const record::Anchor& reference);

uav::Vec3 to_anchor(const GroundTruth& truth, const record::Anchor& anchor) {
  return {anchor.p_WA_m[0] - truth.p_WB_m[0], anchor.p_WA_m[1] - truth.p_WB_m[1], 0.0};
}

std::optional<double> bearing_error(const GroundTruth& truth, const record::Anchor& anchor) {
  const uav::Vec3 way = to_anchor(truth, anchor);
  return std::abs(wrap_angle_rad(std::atan2(way.y, way.x) - uav::yaw_rad(attitude(truth))));
}
std::optional<double> separation(const GroundTruth& truth, const record::Anchor& anchor) {
  const uav::Vec3 way = to_anchor(truth, anchor);
  return std::hypot(way.x, way.y, anchor.p_WA_m[2] - truth.p_WB_m[2]);
}
std::optional<double> distance(const GroundTruth& truth, const record::Anchor& anchor) {
  const uav::Vec3 way = to_anchor(truth, anchor);
  return std::hypot(way.x, way.y);
}
template <std::size_t Axis>
std::optional<double> position(const GroundTruth& truth, const record::Anchor&) {
  return truth.p_WB_m[Axis];
}
std::optional<double> speed(const GroundTruth& truth, const record::Anchor&) {
  return std::hypot(truth.v_WB_m_s[0], truth.v_WB_m_s[1], truth.v_WB_m_s[2]);
}
std::optional<double> yaw_rate(const GroundTruth& truth, const record::Anchor&) {
  const double(&w)[3] = truth.w_WB_B_rad_s;
  return std::abs(rotate(attitude(truth), {w[0], w[1], w[2]}).z);
}
std::optional<double> clearance(const GroundTruth& truth, const record::Anchor&) {
  return truth.clearance_m;
}

/// Of a point from the line between two corners.
double distance_m(const mission::Corner& a, const mission::Corner& b, double x_m, double y_m) {
  const double along_x = b.x_m - a.x_m, along_y = b.y_m - a.y_m;
  const double length2 = along_x * along_x + along_y * along_y;
  const double way = along_x * (x_m - a.x_m) + along_y * (y_m - a.y_m);
  const double share = length2 > 0.0 ? std::clamp(way / length2, 0.0, 1.0) : 0.0;
  return std::hypot(a.x_m + share * along_x - x_m, a.y_m + share * along_y - y_m);
}

// Inside is where a ray to the east crosses an odd number of edges.
double inside(const GroundTruth& truth, const std::vector<mission::Corner>& fence) {
  const double x_m = truth.p_WB_m[0], y_m = truth.p_WB_m[1];
  double nearest_m = std::numeric_limits<double>::infinity();
  bool is_inside = false;
  for (std::size_t i = 0; i < fence.size(); ++i) {
    const mission::Corner &a = fence[i], &b = fence[(i + 1) % fence.size()];
    nearest_m = std::min(nearest_m, distance_m(a, b, x_m, y_m));
    if ((a.y_m > y_m) == (b.y_m > y_m)) continue;
    is_inside ^= x_m < a.x_m + (y_m - a.y_m) / (b.y_m - a.y_m) * (b.x_m - a.x_m);
  }
  return is_inside ? nearest_m : -nearest_m;
}

struct Source {
  std::string_view quantity;
  Value value;
};
// One entry for each of mission::quantities() that is not of events, fences, the battery or the
// radio.
constexpr std::array kSources = {
    Source{"bearing_error", bearing_error},
    Source{"distance", distance},
    Source{"separation", separation},
    Source{"from_start", distance},
    Source{"x", position<0>},
    Source{"y", position<1>},
    Source{"altitude", position<2>},
    Source{"speed", speed},
    Source{"yaw_rate", yaw_rate},
    Source{"clearance", clearance},
};

}  // namespace

std::optional<Reference> Reference::of(const mission::Condition& condition,
                                       const GroundTruth& start, const record::Record& record) {
  if (condition.quantity->subject != mission::Subject::kAnchor) {
    record::Anchor here;
    std::ranges::copy(start.p_WB_m, here.p_WA_m);
    Reference reference(here, record);
    reference.fence_ = condition.fence;
    return reference;
  }
  const auto& anchors = record.header.anchors;
  const auto anchor = std::ranges::find(anchors, condition.of, &record::Anchor::name);
  return anchor == anchors.end() ? std::nullopt : std::optional(Reference(*anchor, record));
}

std::optional<double> value_of(const mission::Quantity& quantity, const GroundTruth& truth,
                               const Reference& reference) {
  if (quantity.subject == mission::Subject::kFence) return inside(truth, reference.fence());
  const auto* source = std::ranges::find(kSources, quantity.name, &Source::quantity);
  const auto value = source->value(truth, reference.at(truth.at));
  return value && std::isfinite(*value) ? value : std::nullopt;
}

Signals::Signals(const std::string& uav, const record::Record& record)
    : uav_(uav), record_(record) {
  for (const auto& logged : record.ground_truth) {
    const bool is_new = trace_.at.empty() || logged.message.at > trace_.at.back();
    if (logged.message.uav != uav || !is_new) continue;
    truths_.push_back(&logged.message);
    trace_.at.push_back(logged.message.at);
  }
}

// The record has it at each ground truth, or not at all.
std::optional<std::size_t> Signals::of_battery(const mission::Quantity& quantity) {
  std::vector<double> signal;
  for (const auto& [at, order, battery] : record_.batteries) {
    if (battery.uav != uav_) continue;
    const double value = quantity.name == "energy_j" ? battery.spent_j() : battery.charge;
    if (!std::isfinite(value) || signal.size() == trace_.at.size() ||
        battery.at != trace_.at[signal.size()])
      return std::nullopt;
    signal.push_back(value);
  }
  if (signal.size() != trace_.at.size()) return std::nullopt;
  trace_.signals.push_back(std::move(signal));
  return trace_.signals.size() - 1;
}

// The record has the messages in the order of `at`.
std::size_t Signals::of_radio(const mission::Quantity& quantity) {
  std::vector<double> signal;
  const bool is_age = quantity.name == "information_age";
  std::size_t next = 0;
  double ended = 0.0, delivered = 0.0;
  SimTime newest{};
  bool has_arrived_here = false;
  std::size_t& known_from = known_from_[trace_.signals.size()];
  for (const SimTime at : trace_.at) {
    for (; next < record_.radio.size() && record_.radio[next].message.at <= at; ++next) {
      const record::RadioMessage& message = record_.radio[next].message;
      const bool has_arrived = message.outcome == record::kDelivered;
      if (message.to == uav_ && has_arrived) {
        newest = std::max(newest, message.sent_at);
        has_arrived_here = true;
      }
      if (message.uav != uav_ || message.outcome == record::kWaiting) continue;
      ended += 1.0;
      delivered += has_arrived ? 1.0 : 0.0;
    }
    const double ratio = ended > 0.0 ? delivered / ended : 1.0;
    signal.push_back(is_age ? to_seconds(at - newest) : ratio);
    if (!(is_age ? has_arrived_here : ended > 0.0)) known_from = signal.size();
  }
  trace_.signals.push_back(std::move(signal));
  return trace_.signals.size() - 1;
}

std::optional<std::size_t> Signals::find(const mission::Condition& condition) {
  const auto [known, is_new] = known_.try_emplace({condition.quantity->name, condition.of});
  if (!is_new) return known->second;
  if (condition.quantity->needs_battery()) return known->second = of_battery(*condition.quantity);
  if (condition.quantity->is_of_radio()) return known->second = of_radio(*condition.quantity);
  if (truths_.empty()) return std::nullopt;
  const auto reference = Reference::of(condition, *truths_.front(), record_);
  if (!reference) return std::nullopt;
  std::vector<double> signal;
  for (const GroundTruth* truth : truths_) {
    const auto value = value_of(*condition.quantity, *truth, *reference);
    if (!value) return std::nullopt;
    signal.push_back(*value);
  }
  known->second = trace_.signals.size();
  trace_.signals.push_back(std::move(signal));
  return known->second;
}

}  // namespace tether::judge
