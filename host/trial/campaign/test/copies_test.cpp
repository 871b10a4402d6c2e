#include <cmath>

#include <gtest/gtest.h>

#include <tether/campaign/campaign_results.h>

namespace tether::campaign {
namespace {

record::Record flight_to(double x_m) {
  record::Record record;
  record.ground_truth.emplace_back().message.uav = "uav1";
  record.ground_truth.back().message.p_WB_m[0] = x_m;
  return record;
}

TEST(Copies, HaveTheSameTrueStatesToTheLastBit) {
  const std::string digest = flight_digest(flight_to(1.0));
  EXPECT_EQ(digest.size(), 16u);
  EXPECT_EQ(flight_digest(flight_to(1.0)), digest);
  EXPECT_NE(flight_digest(flight_to(std::nextafter(1.0, 2.0))), digest);
  record::Record other = flight_to(1.0);
  other.ground_truth[0].message.uav = "uav2";
  EXPECT_NE(flight_digest(other), digest);
  EXPECT_EQ(flight_digest({}), "");
}

TEST(Copies, AreCountedOnce) {
  TrialResult flight;
  flight.flight_digest = "0123456789abcdef";
  flight.outcome = Outcome::kGoalReached;
  MetricValue& metric = flight.metrics.emplace_back();
  metric.name = "m";
  metric.value = 2.0;
  ConditionResults results{"c", {flight, flight, flight, flight, flight}, 5};
  results.trials[1].seed = 2;
  results.trials[1].this_run.wall = Duration(1);
  results.trials[2].flight_digest = "another";
  results.trials[3].metrics[0].value = 3.0;  // the program estimated something else
  results.trials[4].outcome = Outcome::kFailed;
  EXPECT_EQ(distinct_flights(results.trials),
            (std::vector<const TrialResult*>{&results.trials[0], &results.trials[2],
                                             &results.trials[3]}));
  EXPECT_EQ(results.values("m"), (std::vector<double>{2.0, 2.0, 3.0}));
  for (TrialResult& trial : results.trials) trial.flight_digest.clear();
  EXPECT_EQ(distinct_flights(results.trials).size(), 4u) << "not known to be copies";
}

}  // namespace
}  // namespace tether::campaign
