#include "sensors/capture_store.h"

#include <gtest/gtest.h>

#include <tether/base_testing/allocation_count.h>

namespace tether::coordinator {
namespace {

TEST(CaptureStore, KeepsStatesFromAnIndexOn) {
  CaptureStore store;
  for (std::uint64_t i = 0; i < 5; ++i)
    store.add(i, std::make_shared<sim::Snapshot>(sim::Snapshot{
                     .at = from_ns<SimTime>(static_cast<std::int64_t>(i) * 10), .state = {}}));
  store.drop_before(3);
  EXPECT_EQ(store.size(), 2u);
  EXPECT_EQ(store.find(2), nullptr);
  ASSERT_NE(store.find(3), nullptr);
  EXPECT_EQ(store.find(3)->at, from_ns<SimTime>(30));
  EXPECT_EQ(store.find(5), nullptr);
  store.drop_before(100);
  EXPECT_EQ(store.size(), 0u);
}

TEST(StatePool, CapturesEachInstantOnceAndKeepsWhatIsReferredTo) {
  StatePool pool;
  int captures = 0;
  const auto at = [&](std::int64_t ns) {
    return pool.at(from_ns<SimTime>(ns), [&](sim::Snapshot& snapshot) {
      snapshot.at = from_ns<SimTime>(ns);
      ++captures;
    });
  };
  const SharedState first = at(0);
  EXPECT_EQ(at(0), first);
  EXPECT_EQ(captures, 1);
  for (std::int64_t ns = 1; ns < 5; ++ns) EXPECT_EQ(at(ns)->at, from_ns<SimTime>(ns));
  EXPECT_EQ(captures, 5);
  EXPECT_EQ(first->at, SimTime{});
}

TEST(StatePool, SteadyUseAllocatesNothing) {
  if (!AllocationCount::is_possible()) GTEST_SKIP() << "a sanitizer's allocator";
  StatePool pool;
  CaptureStore store;
  const std::function<void(sim::Snapshot&)> capture = [](sim::Snapshot& snapshot) {
    snapshot.state.resize(64);
  };
  const auto use = [&](std::uint64_t begin) {
    for (std::uint64_t i = begin; i < begin + 100; ++i) {
      store.add(i, pool.at(from_ns<SimTime>(static_cast<std::int64_t>(i)), capture));
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
