#include <gtest/gtest.h>

#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

ExecTime at(Duration time) {
  return ExecTime(time);
}

TEST(LoopLimit, CountsFromItsStart) {
  LoopLimit limit(seconds(2), 100);
  limit.start(at(seconds(10)));
  EXPECT_FALSE(limit.next_round(at(seconds(12))));
  EXPECT_EQ(limit.elapsed(at(seconds(12))), seconds(2));
  EXPECT_EQ(limit.left(at(seconds(11))), seconds(1));
  EXPECT_EQ(limit.left(at(seconds(13))), seconds(0));
  const Progress end = limit.next_round(at(seconds(12) + milliseconds(1)));
  ASSERT_TRUE(end);
  EXPECT_EQ(end->status, TaskStatus::kNotReached);
  EXPECT_EQ(end->reason, "time limit");
}

TEST(LoopLimit, EndsWhileTheClockStandsStill) {
  LoopLimit limit(seconds(2), 3);
  for (int run = 0; run < 2; ++run) {
    limit.start(at(seconds(1)));
    for (int round = 0; round < 3; ++round) EXPECT_FALSE(limit.next_round(at(seconds(1))));
    const Progress end = limit.next_round(at(seconds(1)));
    ASSERT_TRUE(end);
    EXPECT_EQ(end->reason, "round limit");
  }
}

}  // namespace
}  // namespace tether::tasks
