#include <optional>
#include <string>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

Metric metric(const std::string& kind, std::optional<double> limit) {
  const MetricKind& found = *find_metric_kind(kind);
  Metric metric;
  metric.name = metric.kind = kind;
  metric.unit = found.unit;
  metric.limit_line = 7;
  (found.is_better_if_more ? metric.min : metric.max) = limit;
  return metric;
}

TEST(Decidable, OneLimitThatFlightsCanKeepOrMissIsNeeded) {
  struct Case {
    std::vector<Metric> metrics;
    const char* about;  // nullptr: decidable
    int line = 7;
  };
  const Metric no_limit = metric("oscillations", {}), far = metric("time_required", 20.0);
  for (const Case& c : {Case{{}, "metric", 0},
                        {{no_limit}, "max"},
                        {{metric("energy_j", {})}, "max_j"},
                        {{far}, "max_s"},
                        {{no_limit, far}, "max_s"},
                        {{metric("final_bearing_error", 180.0)}, "max_deg"},
                        {{metric("min_clearance_m", 0.0)}, "min_m"},
                        {{metric("delivery_ratio", 1.5)}, "min"},
                        {{metric("time_required", 19.9)}, nullptr},
                        {{metric("collisions", 0.0)}, nullptr},
                        {{far, metric("delivery_ratio", 1.0)}, nullptr}}) {
    Scenario scenario;
    scenario.file = "a.toml";
    scenario.time_limit = Duration(20'000'000'000);
    scenario.metrics = c.metrics;
    if (!c.about) {
      EXPECT_NO_THROW(require_decidable(scenario));
      continue;
    }
    const Error error = bad_file_error([&] { require_decidable(scenario); });
    EXPECT_EQ(error.subject(), c.about);
    EXPECT_EQ(error.where(), (FileLocation{"a.toml", c.line}));
  }
}

TEST(Decidable, ClausesOfAMissionAreLimits) {
  Scenario scenario;
  UavSetup& uav = scenario.uavs.emplace_back();
  uav.sut.mission.emplace();
  EXPECT_THROW(require_decidable(scenario), Error);
  uav.sut.mission->clauses.emplace_back();
  EXPECT_NO_THROW(require_decidable(scenario));
}

}  // namespace
}  // namespace tether::scenario
