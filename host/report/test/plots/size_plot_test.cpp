#include "sample_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/plots.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(SizePlot, HasEachFlightTheThresholdAndTheBoards) {
  const std::string script = size_plot(sample_size()).script;
  EXPECT_THAT(script, HasSubstr("flight, goal reached"));
  EXPECT_THAT(script, HasSubstr("pointtype 2 linewidth 1.5 pointsize 0.55"));  // missed
  EXPECT_THAT(script, HasSubstr("rectangle from 2.7,graph 0 to 3.6,graph 1"));
  EXPECT_THAT(script, HasSubstr("arrow from 3.1,graph 0"));
  EXPECT_THAT(script, HasSubstr("rectangle from 1.7,graph 0 to 2.1,graph 1"));
  EXPECT_THAT(script, HasSubstr("'pi.toml' at 1.9"));
  EXPECT_THAT(script, HasSubstr("title 'Time required'"));
  EXPECT_THAT(script, HasSubstr("\n1.5 0.5384615\n"));  // (6.5 − 3) / 6.5
}

TEST(SizePlot, HasNoAreaOfMarginsWithoutThem) {
  SizeReport report = sample_size();
  for (campaign::TrialResult& trial : report.synchronised.trials) trial.metrics.clear();
  EXPECT_THAT(size_plot(report).script, Not(HasSubstr("multiplot")));
}

TEST(SizePlot, IsDrawnOnEachBasis) {
  SizeReport report = sample_size();
  report.unsynchronised = report.synchronised;
  EXPECT_THAT(draw_svg(size_plot(report)), HasSubstr("without synchronisation"));
  report.synchronised.answer.basis = sizing::Basis::kLevels;
  EXPECT_THAT(draw_svg(size_plot(report)), HasSubstr("share of near slowdowns"));
}

}  // namespace
}  // namespace tether::report
