#include "metric_outcome.h"

#include <algorithm>
#include <map>
#include <string>

#include <fmt/format.h>

#include <tether/base/units.h>
#include <tether/campaign/metrics.h>

// What arrived of messages between UAVs.
namespace tether::campaign {

// Those that were still on their way at the end are not counted.
MetricOutcome delivery_ratio(const scenario::Metric& metric, const record::Record& record) {
  int sent = 0, delivered = 0;
  for (const auto& logged : record.radio) {
    const record::RadioMessage& message = logged.message;
    if (message.uav != metric.uav || message.outcome == record::kWaiting) continue;
    ++sent;
    delivered += message.outcome == record::kDelivered ? 1 : 0;
  }
  if (sent == 0) return missing(fmt::format("'{}' sent no message", metric.uav));
  return {static_cast<double>(delivered) / sent, ""};
}

// The time average (S. Kaul, R. Yates and M. Gruteser, "Real-time status: How often should one
// update?", INFOCOM 2012) of t minus the time at which the newest message had been sent, over the
// links to the UAV, each from its first message to the UAV's finish or the end of the record.
MetricOutcome age_of_information(const scenario::Metric& metric, const record::Record& record) {
  struct Link {
    double newest_s, reached_s;
  };
  std::map<std::string, Link> links;
  double area_s2 = 0.0, time_s = 0.0;
  const auto advance = [&](Link& link, double to_s) {
    const double span_s = std::max(to_s - link.reached_s, 0.0);
    area_s2 += span_s * (link.reached_s - link.newest_s + span_s / 2.0);
    time_s += span_s;
    link.reached_s = std::max(link.reached_s, to_s);
  };
  const double end_s =
      to_seconds(finish_time(record, metric.uav).value_or(record::last_time(record)));
  for (const auto& logged : record.radio) {
    const record::RadioMessage& message = logged.message;
    if (message.to != metric.uav || message.outcome != record::kDelivered) continue;
    const double at_s = std::min(to_seconds(message.at), end_s);
    const double sent_s = to_seconds(message.sent_at);
    const auto [link, is_new] = links.try_emplace(message.uav, Link{sent_s, at_s});
    advance(link->second, at_s);
    link->second.newest_s = std::max(link->second.newest_s, sent_s);
  }
  for (auto& [uav, link] : links) advance(link, end_s);
  if (time_s <= 0.0) return missing(fmt::format("'{}' was sent no message", metric.uav));
  return {area_s2 / time_s, ""};
}

}  // namespace tether::campaign
