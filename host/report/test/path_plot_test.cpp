#include "sample_record.h"

#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/plots.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(PathPlot, HasPathTicksEndsAndAnchorToScale) {
  const record::Record record = sample_record(3);
  const auto plot = path_plot({{{&record, "uav1", "target", 1}}});
  ASSERT_TRUE(plot);
  EXPECT_THAT(plot->script, HasSubstr("$path0 << END\n0 0\n0.1 0\n0.2 0\nEND\n"));
  EXPECT_THAT(plot->script, HasSubstr("$starts << END\n0 0\nEND\n"));
  EXPECT_THAT(plot->script, HasSubstr("$end0 << END\n0.2 0\nEND\n"));
  EXPECT_THAT(plot->script,
              HasSubstr("$anchor0 << END\n2.2 1.1\n1.8 1.1\n1.8 0.9\n2.2 0.9\n2.2 1.1\nEND\n"));
  EXPECT_THAT(plot->script, HasSubstr("set label 'blue_box'"));
}

TEST(PathPlot, TurnsAnchorAndTicksByTheirYaw) {
  record::Record record = sample_record(1);
  const double half = std::sqrt(0.5);
  for (double* q : {record.header.anchors[0].q_WA, record.ground_truth[0].message.q_WB}) {
    q[0] = half;
    q[3] = half;
  }
  const auto plot = path_plot({{{&record, "uav1", "target", 1}}});
  ASSERT_TRUE(plot);
  EXPECT_THAT(plot->script,
              HasSubstr("$anchor0 << END\n1.9 1.2\n1.9 0.8\n2.1 0.8\n2.1 1.2\n1.9 1.2\nEND\n"));
  EXPECT_TRUE(
      std::regex_search(plot->script, std::regex(R"(\$ticks0 << END\n0 0 [-0-9.]+e-1[0-9] 0\.1)")))
      << plot->script;
}

TEST(PathPlot, PlacesDeadReckoningAtTheTrueStart) {
  record::Record record = sample_record(2);
  record::GroundTruth& start = record.ground_truth[0].message;
  start.p_WB_m[0] = 5.0;
  start.p_WB_m[1] = 1.0;
  start.q_WB[0] = 0.0;  // half a turn
  start.q_WB[3] = 1.0;
  const auto plot = path_plot({{{&record, "uav1", "target", 1}}});
  ASSERT_TRUE(plot);
  EXPECT_THAT(plot->script, HasSubstr("$odometry0 << END\n5 1\n4.91 1\nEND\n"));
  EXPECT_THAT(plot->script, HasSubstr("title 'target, dead reckoning'"));
  record.annotations.clear();
  EXPECT_THAT(path_plot({{{&record, "uav1", "target", 1}}})->script, Not(HasSubstr("odometry")));
}

double span(const std::string& script, const std::string& axis) {
  std::smatch m;
  std::regex_search(script, m, std::regex("set " + axis + "range \\[([-0-9.e]+):([-0-9.e]+)\\]"));
  return std::stod(m[2]) - std::stod(m[1]);
}

double margin(const std::string& script, const std::string& side) {
  std::smatch m;
  std::regex_search(script, m, std::regex("set " + side + "margin at screen ([0-9.]+)"));
  return std::stod(m[1]);
}

TEST(PathPlot, HasOneScale) {
  for (const double north_m : {0.0, 3.0, 40.0}) {
    record::Record record = sample_record(30);
    record.ground_truth.back().message.p_WB_m[1] = north_m;
    const std::string script = path_plot({{{&record, "uav1", "target", 1}}})->script;
    std::smatch size;
    std::regex_search(script, size, std::regex("size ([0-9]+),([0-9]+)"));
    const double x_px = std::stod(size[1]) * (margin(script, "r") - margin(script, "l"));
    const double y_px = std::stod(size[2]) * (margin(script, "t") - margin(script, "b"));
    EXPECT_NEAR(span(script, "x") / x_px, span(script, "y") / y_px,
                1e-3 * span(script, "x") / x_px);
  }
}

TEST(PathPlot, OverlaysRunsInTheirColours) {
  const record::Record a = sample_record(3), b = sample_record(4);
  const auto plot = path_plot({{{&a, "uav1", "host", 0}, {&b, "uav1", "target", 1}}});
  ASSERT_TRUE(plot);
  EXPECT_THAT(plot->script, HasSubstr("$path0 with lines linewidth 2 linecolor rgb '#010203'"));
  EXPECT_THAT(plot->script, HasSubstr("$path1 with lines linewidth 2 linecolor rgb '#010204'"));
}

TEST(PathPlot, NeedsGroundTruth) {
  const record::Record record = sample_record(3);
  EXPECT_FALSE(path_plot({{{&record, "uav2", "host", 0}}}));
}

}  // namespace
}  // namespace tether::report
