#include "pose_history.h"

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

std::vector<double> written(const PoseHistory& history) {
  std::vector<double> out(history.size());
  history.write(out.data());
  return out;
}

TEST(PoseHistoryTest, ForgetsTheOldestFirst) {
  PoseHistory history(3, 2);
  history.fill(std::vector{1.0, 2.0});
  EXPECT_EQ(written(history), (std::vector{1.0, 2.0, 1.0, 2.0, 1.0, 2.0}));
  history.push(std::vector{3.0, 4.0});
  EXPECT_EQ(written(history), (std::vector{1.0, 2.0, 1.0, 2.0, 3.0, 4.0}));
  for (const double x : {5.0, 6.0, 7.0, 8.0}) history.push(std::vector{x, -x});
  EXPECT_EQ(written(history), (std::vector{6.0, -6.0, 7.0, -7.0, 8.0, -8.0}));
}

TEST(PoseHistoryTest, FillForgetsEverything) {
  PoseHistory history(2, 1);
  history.push(std::vector{1.0});
  history.fill(std::vector{9.0});
  EXPECT_EQ(written(history), (std::vector{9.0, 9.0}));
}

TEST(PoseHistoryTest, WithoutRoomKeepsNothing) {
  PoseHistory history(0, 2);
  history.fill(std::vector{1.0, 2.0});
  history.push(std::vector{1.0, 2.0});
  EXPECT_EQ(history.size(), 0U);
  EXPECT_TRUE(written(history).empty());
}

}  // namespace
}  // namespace tether::sim
