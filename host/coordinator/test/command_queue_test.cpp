#include "command_queue.h"

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

SimTime st(std::int64_t ns) {
  return from_ns<SimTime>(ns);
}

TEST(CommandQueue, ReturnsDueCommandsInTheOrderOfEffectThenArrival) {
  CommandQueue queue;
  EXPECT_EQ(queue.next_effect(), SimTime::max());
  queue.push({st(30), 0, 1, {}});
  queue.push({st(10), 1, 2, {}});
  queue.push({st(30), 1, 3, {}});
  queue.push({st(10), 0, 4, {}});
  EXPECT_EQ(queue.next_effect(), st(10));
  EXPECT_FALSE(queue.pop_due(st(9)));
  EXPECT_EQ(queue.pop_due(st(10))->sequence, 2u);
  EXPECT_EQ(queue.pop_due(st(10))->sequence, 4u);
  EXPECT_FALSE(queue.pop_due(st(29)));
  EXPECT_EQ(queue.pop_due(st(40))->sequence, 1u);
  EXPECT_EQ(queue.pop_due(st(40))->sequence, 3u);
  EXPECT_EQ(queue.next_effect(), SimTime::max());
}

TEST(CommandQueue, CountsThePendingCommandsOfEachUav) {
  CommandQueue queue;
  EXPECT_EQ(queue.waiting(3), 0u);
  for (const std::size_t uav : {3u, 0u, 3u}) queue.push({st(10), uav, 1, {}});
  EXPECT_EQ(queue.waiting(0), 1u);
  EXPECT_EQ(queue.waiting(1), 0u);
  EXPECT_EQ(queue.waiting(3), 2u);
  while (queue.pop_due(st(10))) continue;
  EXPECT_EQ(queue.waiting(3), 0u);
}

}  // namespace
}  // namespace tether::coordinator
