#include "sample_record.h"

#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/plots.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(PathPlot, HasPathEndsAndAnchorToScale) {
  const record::Record record = sample_record(3);
  const std::string script = path_plot({{{&record, "uav1", "target", 1}}})->script;
  for (const char* part : {"$path0 << END\n0 0\n0.1 0\n0.2 0\nEND\n", "$starts << END\n0 0\nEND\n",
                           "$end0 << END\n0.2 0\nEND\n", "set label 'blue_box'",
                           "$anchor0 << END\n2.2 1.1\n1.8 1.1\n1.8 0.9\n2.2 0.9\n2.2 1.1\nEND\n"})
    EXPECT_THAT(script, HasSubstr(part));
  EXPECT_FALSE(path_plot({{{&record, "uav2", "host", 0}}})) << "no ground truth";
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

TEST(PathPlot, BeginsTheDeadReckoningOfEachTaskWhereTheUavIs) {
  record::Record record = sample_record(4);      // at 0, 0.1, 0.2 and 0.3 m
  record.ground_truth[2].message.q_WB[0] = 0.0;  // half a turn
  record.ground_truth[2].message.q_WB[3] = 1.0;
  const auto note = [](const char* topic, const char* json) {
    return record::Annotation{"uav1", ExecTime{}, topic, json};
  };
  record.annotations[1].message = note("task", R"({"event":"start","task":"go_to"})");
  record.annotations[2].message = note("odometry", R"({"x_m":0.5,"y_m":0,"yaw_rad":0})");
  record.annotations[3].message = note("odometry", R"({"x_m":0.7,"y_m":0,"yaw_rad":0})");
  EXPECT_THAT(path_plot({{{&record, "uav1", "target", 1}}})->script,
              HasSubstr("$odometry0 << END\n0 0\n\n0.2 0\n0 "));
}

// The numbers of the expression's groups.
std::vector<double> numbers(const std::string& script, const std::string& expression) {
  std::smatch m;
  std::regex_search(script, m, std::regex(expression));
  std::vector<double> found;
  for (std::size_t i = 1; i < m.size(); ++i) found.push_back(std::stod(m[i]));
  return found;
}

TEST(PathPlot, HasTheSameScaleOnBothAxes) {
  for (const double north_m : {0.0, 3.0, 40.0}) {
    record::Record record = sample_record(30);
    record.ground_truth.back().message.p_WB_m[1] = north_m;
    const std::string script = path_plot({{{&record, "uav1", "target", 1}}})->script;
    const auto size = numbers(script, "size ([0-9]+),([0-9]+)");
    const auto metres_per_px = [&](const std::string& axis, const std::string& low,
                                   const std::string& high, double size_px) {
      const auto range = numbers(script, "set " + axis + "range \\[([-0-9.e]+):([-0-9.e]+)\\]");
      const auto from = numbers(script, "set " + low + "margin at screen ([0-9.]+)");
      const auto to = numbers(script, "set " + high + "margin at screen ([0-9.]+)");
      return (range[1] - range[0]) / (size_px * (to[0] - from[0]));
    };
    const double x = metres_per_px("x", "l", "r", size[0]);
    EXPECT_NEAR(x, metres_per_px("y", "b", "t", size[1]), 1e-3 * x);
  }
}

TEST(PathPlot, OverlaysRunsInTheirColours) {
  const record::Record a = sample_record(3), b = sample_record(4);
  const std::string script =
      path_plot({{{&a, "uav1", "host", 0}, {&b, "uav1", "target", 1}}})->script;
  EXPECT_THAT(
      script,
      HasSubstr("$path0 with linespoints linewidth 2 pointtype 7 pointsize 0.6 pointinterval 100 "
                "linecolor rgb '#010203'"));
  EXPECT_THAT(
      script,
      HasSubstr("$path1 with linespoints linewidth 2 pointtype 9 pointsize 0.6 pointinterval 100 "
                "linecolor rgb '#010204'"));
}

}  // namespace
}  // namespace tether::report
