#include "capture_store.h"

#include <gtest/gtest.h>

#include <tether/base_testing/allocation_count.h>

namespace tether::coordinator {
namespace {

TEST(CaptureStore, KeepsStatesFromAnIndexOn) {
  CaptureStore store;
  for (std::uint64_t i = 0; i < 5; ++i)
    store.add(i).at = from_ns<SimTime>(static_cast<std::int64_t>(i) * 10);
  store.drop_before(3);
  EXPECT_EQ(store.size(), 2u);
  EXPECT_EQ(store.find(2), nullptr);
  ASSERT_NE(store.find(3), nullptr);
  EXPECT_EQ(store.find(3)->at, from_ns<SimTime>(30));
  EXPECT_EQ(store.find(5), nullptr);
  store.drop_before(100);
  EXPECT_EQ(store.size(), 0u);
}

TEST(CaptureStore, SteadyUseAllocatesNothing) {
  if (!AllocationCount::is_possible()) GTEST_SKIP() << "a sanitizer's allocator";
  CaptureStore store;
  const auto use = [&](std::uint64_t begin) {
    for (std::uint64_t i = begin; i < begin + 100; ++i) {
      store.add(i).state.resize(64);
      store.drop_before(i < 5 ? 0 : i - 5);
    }
  };
  use(0);
  AllocationCount count;
  use(100);
  EXPECT_EQ(count.stop(), 0);
}

}  // namespace
}  // namespace tether::coordinator
