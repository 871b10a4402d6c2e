#include "energy.h"

#include "metric_outcome.h"

#include <gtest/gtest.h>

namespace tether::campaign {
namespace {

SimTime st(double s) {
  return SimTime(duration_from_seconds(s));
}

/// One battery message each second for 10 s: 100 W of lift, 5 W of the computer, 1 % of the charge.
record::Record flight() {
  record::Record record;
  record.header.suts.emplace_back().uav = "uav1";
  for (int i = 0; i <= 10; ++i)
    record.batteries.push_back({st(i),
                                0,
                                {.uav = "uav1",
                                 .at = st(i),
                                 .voltage_V = 12.0 - 0.1 * i,
                                 .charge = 0.9 - 0.01 * i,
                                 .lift_J = 100.0 * i,
                                 .idle_J = 5.0 * i}});
  return record;
}

scenario::Metric metric() {
  scenario::Metric metric;
  metric.uav = "uav1";
  return metric;
}

TEST(Energy, IsOfTheWholeFlightAndOfEachTask) {
  const auto energy = energy_of(flight(), {{"uav1", "a", st(2), st(5), "reached", ""},
                                           {"uav2", "b", st(2), st(5), "reached", ""}});
  ASSERT_EQ(energy.size(), 1U);
  EXPECT_DOUBLE_EQ(total_J(energy[0].spent_J), 1050.0);
  EXPECT_DOUBLE_EQ(energy[0].charge_to, 0.8);
  EXPECT_DOUBLE_EQ(*energy[0].more_flights(), 8.0);
  EXPECT_DOUBLE_EQ(energy[0].least_voltage_V, 11.0);
  ASSERT_EQ(energy[0].tasks.size(), 1U);
  EXPECT_DOUBLE_EQ(energy[0].tasks[0].spent_J[0], 300.0);
  EXPECT_DOUBLE_EQ(total_J(energy[0].tasks[0].spent_J), 315.0);
}

// What is drawn all the time is drawn no more.
TEST(Energy, IsCutOffWithChargeLeft) {
  record::Record record = flight();
  record.header.suts[0].energy.emplace().idle_W = 5.0;
  for (auto& battery : record.batteries) battery.message.current_A = 8.0;
  EXPECT_FALSE(energy_of(record, {})[0].is_empty());
  record.batteries.back().message.current_A = 0.0;
  EXPECT_TRUE(energy_of(record, {})[0].is_empty());
}

TEST(Energy, EndsWhenTheSutFinishes) {
  record::Record record = flight();
  record::Interaction finish;
  finish.uav = "uav1";
  finish.kind = record::kFinish;
  finish.request_at = finish.reply_at = same_instant(st(4));
  finish.st_at_arrival = finish.st_at_release = st(4);
  record.interactions.push_back({st(4), 0, finish});
  EXPECT_DOUBLE_EQ(total_J(energy_of(record, {})[0].spent_J), 420.0);
  EXPECT_DOUBLE_EQ(*energy_j(metric(), record).value, 420.0);
}

TEST(Energy, IsMissingWithoutABattery) {
  record::Record record;
  record.header.suts.emplace_back().uav = "uav1";
  EXPECT_TRUE(energy_of(record, {}).empty());
  EXPECT_FALSE(energy_j(metric(), record).value);
}

}  // namespace
}  // namespace tether::campaign
