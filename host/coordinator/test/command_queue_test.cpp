#include "command_queue.h"

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

SimTime st(std::int64_t ns) {
  return from_ns<SimTime>(ns);
}

TEST(CommandQueue, ReturnsAndCountsCommandsInTheOrderOfEffectThenUav) {
  CommandQueue queue;
  EXPECT_EQ(queue.next_effect(), SimTime::max());
  queue.push({st(30), 0, 1, {}});
  queue.push({st(10), 1, 2, {}});
  queue.push({st(30), 1, 3, {}});
  queue.push({st(10), 0, 4, {}});
  EXPECT_EQ(queue.next_effect(), st(10));
  EXPECT_EQ(queue.waiting(0), 2u);
  EXPECT_EQ(queue.waiting(3), 0u);
  EXPECT_FALSE(queue.pop_due(st(9)));
  queue.push({st(10), 0, 5, {}});
  for (const std::uint64_t sequence : {4u, 5u, 2u})
    EXPECT_EQ(queue.pop_due(st(10))->sequence, sequence);
  EXPECT_FALSE(queue.pop_due(st(29)));
  EXPECT_EQ(queue.pop_due(st(40))->sequence, 1u);
  EXPECT_EQ(queue.pop_due(st(40))->sequence, 3u);
  EXPECT_EQ(queue.waiting(0), 0u);
  EXPECT_EQ(queue.next_effect(), SimTime::max());
}

}  // namespace
}  // namespace tether::coordinator
