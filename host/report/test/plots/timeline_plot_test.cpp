#include "sample_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/plots.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string whole(const record::Record& record) {
  return timeline_plot({&record, "uav1", "target", 1}, Extent::kWhole).value().script;
}

TEST(TimelinePlot, HoldsEtFromEachRequestToItsReply) {
  const std::string script = whole(sample_record(3));
  EXPECT_THAT(script, HasSubstr("$et << END\n0 0\n0.015 0\n0.015 0.03\n"
                                "0.05 0.1\n0.065 0.1\n0.065 0.13\n"));
  EXPECT_THAT(script, HasSubstr("$st << END\n0 0\n0.015 0.03\n0.05 0.095\n0.065 0.13\n"));
  EXPECT_THAT(script, HasSubstr("$marks << END\n0 0\n0.05 0.1\n0.1 0.2\nEND\n"));
}

TEST(TimelinePlot, OfTheFirstInteractionsEndsWithThem) {
  const record::Record record = sample_record(50);
  const auto plot = timeline_plot({&record, "uav1", "target", 1}, Extent::kFirstInteractions);
  EXPECT_THAT(plot.value().script, HasSubstr("\n0.95 1.9\nEND\n"));
}

TEST(TimelinePlot, InFreeRunningHasStOnly) {
  record::Record record = sample_record(3);
  record.header.policy = record::kFreeRunning;
  EXPECT_THAT(whole(record), Not(HasSubstr("$et")));
  EXPECT_THAT(whole(record), HasSubstr("$marks << END\n0 0\n0.05 0.095\n"));
  EXPECT_FALSE(lag_plot({&record, "uav1", "no sync", 2}));
}

TEST(TimelinePlot, NeedsTwoInteractionsWithWallTimes) {
  record::Record record = sample_record(2);
  EXPECT_FALSE(timeline_plot({&record, "uav2", "target", 1}, Extent::kWhole));
  record.interactions[1].message.wall_at_release = WallTime{};
  EXPECT_FALSE(timeline_plot({&record, "uav1", "target", 1}, Extent::kWhole));
}

TEST(LagPlot, HasTheLagOfEachRequestInMilliseconds) {
  const record::Record record = sample_record(3);
  EXPECT_THAT(lag_plot({&record, "uav1", "target", 1}).value().script,
              HasSubstr("$lag << END\n0 0\n0.095 5\n0.195 5\nEND\n"));
}

TEST(LagPlot, OfALongRunKeepsItsPeaks) {
  record::Record record = sample_record(50'000);
  record.interactions[31'234].message.lag = std::chrono::milliseconds(777);
  record.interactions[31'235].message.lag = -std::chrono::milliseconds(333);
  const std::string script = lag_plot({&record, "uav1", "target", 1}).value().script;
  EXPECT_THAT(script, HasSubstr(" 777\n"));
  EXPECT_THAT(script, HasSubstr(" -333\n"));
}

}  // namespace
}  // namespace tether::report
