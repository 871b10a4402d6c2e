#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/allocation_count.h>

namespace tether {
namespace {

TEST(AllocationCount, CountsAllocationsUntilItStops) {
  if (!AllocationCount::is_possible()) GTEST_SKIP() << "a sanitizer's allocator";
  AllocationCount count;
  const auto buffer = std::make_unique<std::vector<int>>(100);
  EXPECT_EQ(count.stop(), 2);
  const auto later = std::make_unique<std::vector<int>>(100);
  EXPECT_EQ(count.stop(), 2);
  EXPECT_EQ(buffer->size(), later->size());
  EXPECT_EQ(AllocationCount().stop(), 0);
}

}  // namespace
}  // namespace tether
