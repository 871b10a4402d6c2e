#include "plots/plot_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::ElementsAre;

TEST(PlotScript, QuotesText) {
  EXPECT_EQ(quoted("it's `rm -rf` @x\n\"y\""), "'it''s `rm -rf` @x \"y\"'");
}

TEST(PlotScript, ThinsEvenlyAndKeepsBothEnds) {
  EXPECT_THAT(thinned(3, 5), ElementsAre(0, 1, 2));
  EXPECT_THAT(thinned(0, 5), ElementsAre());
  EXPECT_THAT(thinned(101, 5), ElementsAre(0, 25, 50, 75, 100));
}

TEST(PlotScript, ABlockHasALineForEachPoint) {
  DataBlock block("b");
  EXPECT_TRUE(block.empty());
  block.add(1.0, 2.5);
  block.add(1e-3, std::nan(""), 0.5, -4.0);
  EXPECT_EQ(block.script(), "$b << END\n1 2.5\n0.001 NaN 0.5 -4\nEND\n");
}

TEST(PlotScript, ADrawingLeavesOutEmptyBlocks) {
  Drawing drawing;
  drawing.add(DataBlock("none"), "with lines", Ink::kMuted, "none");
  EXPECT_TRUE(drawing.empty());
  DataBlock block("b");
  block.add(1.0, 2.0);
  drawing.add(block, "with lines", series_ink(0), "it's");
  EXPECT_EQ(drawing.script(),
            "$b << END\n1 2\nEND\nplot $b with lines linecolor rgb '#010203'  title 'it''s'\n");
}

}  // namespace
}  // namespace tether::report
