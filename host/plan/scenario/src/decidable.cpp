#include <algorithm>
#include <string>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

constexpr double kHalfTurn_deg = 180.0;

bool has_limit(const Metric& metric) {
  return metric.max || metric.min;
}

// Why every flight, or none, is within the limit. Empty: flights can tell.
std::string why_no_flight_decides(const Metric& metric, const Scenario& scenario) {
  const double time_limit_s = to_seconds(scenario.time_limit);
  if (metric.kind == "time_required" && *metric.max >= time_limit_s)
    return fmt::format("every flight ends at time_limit_s = {}", time_limit_s);
  if (metric.unit == "deg" && *metric.max >= kHalfTurn_deg) return "no angle is larger";
  if (metric.min && *metric.min <= 0.0) return "no value is smaller";
  if (metric.kind == "delivery_ratio" && *metric.min > 1.0) return "no share is larger than 1";
  return "";
}

}  // namespace

void require_decidable(const Scenario& scenario) {
  const auto judges = [](const UavSetup& uav) {
    return uav.sut.mission && !uav.sut.mission->clauses.empty();
  };
  const auto decides = [&](const Metric& metric) {
    return has_limit(metric) && why_no_flight_decides(metric, scenario).empty();
  };
  if (std::ranges::any_of(scenario.uavs, judges) || std::ranges::any_of(scenario.metrics, decides))
    return;
  const std::string file = scenario.file.string();
  if (scenario.metrics.empty())
    throw Error(ErrorCode::kBadFile, {file},
                "no [[metric]] has a limit, so no flight can show whether the computer is fast "
                "enough. Add one, such as kind = \"time_required\" with max_s.")
        .about("metric");
  const auto limited = std::ranges::find_if(scenario.metrics, has_limit);
  const Metric& metric = limited == scenario.metrics.end() ? scenario.metrics.front() : *limited;
  const std::string key = limit_key(*find_metric_kind(metric.kind));
  const FileLocation where{file, metric.limit_line};
  if (limited == scenario.metrics.end())
    throw Error(ErrorCode::kBadFile, where,
                fmt::format("no [[metric]] has a limit, so no flight can show whether the computer "
                            "is fast enough. Set '{}' of \"{}\".",
                            key, metric.name))
        .about(key);
  throw Error(ErrorCode::kBadFile, where,
              fmt::format("the limit of metric \"{}\" ({} = {}) decides nothing, because {}. Set "
                          "a limit that a flight can miss, and that another one can keep.",
                          metric.name, key, metric.max ? *metric.max : *metric.min,
                          why_no_flight_decides(metric, scenario)))
      .about(key);
}

}  // namespace tether::scenario
