#include "plots/board_lanes.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::HasSubstr;

record::Record shared_record() {
  record::Record record;
  record.header.boards = {{"obc", 2}};
  for (const char* uav : {"a", "b", "c", "d"}) {
    record.header.suts.emplace_back().uav = uav;
    record.header.suts.back().board = "obc";
    record::Interaction m;
    m.uav = uav;
    m.request_at = m.reply_at = ExecTime(std::chrono::seconds(10));
    record.interactions.push_back({{}, 0, m});
  }
  return record;
}

TEST(BoardLanes, EachComputingSutHasItsShareOfTheCores) {
  const std::string svg = board_lanes(shared_record(), {"obc", 2});
  EXPECT_THAT(svg, HasSubstr("2 cores"));
  EXPECT_THAT(svg, HasSubstr("width=\"830.00\" height=\"17.00\"")) << "half a core of 34";
}

TEST(BoardLanes, PinnedSutsHaveALaneOfTheirOwn) {
  record::Record record = shared_record();
  record.header.suts[1].pinned_core = 1;
  const std::string svg = board_lanes(record, {"obc", 2});
  EXPECT_THAT(svg, HasSubstr("core 1"));
  EXPECT_THAT(svg, HasSubstr("width=\"830.00\" height=\"34.00\""));
  EXPECT_THAT(svg, HasSubstr("width=\"830.00\" height=\"11.33\"")) << "three share the other core";
}

TEST(BoardLanes, NothingIsDrawnOfABoardOnWhichNothingWasComputed) {
  EXPECT_EQ(board_lanes(shared_record(), {"other", 2}), "");
}

}  // namespace
}  // namespace tether::report
