#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/client/exec/clock_page.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;

ExecTime et(Duration since_start) {
  return ExecTime(since_start);
}

TEST(ClockState, AdvancesFactorTimesAsFast) {
  const ClockState state{et(10ms), 100ms, 4.0, true};
  EXPECT_EQ(state.at(100ms), et(10ms));
  EXPECT_EQ(state.at(101ms), et(14ms));
  EXPECT_EQ(state.at(99ms), et(10ms));
  EXPECT_EQ(state.mono_at(et(14ms)), 101ms);
  EXPECT_EQ((ClockState{et(10ms), 100ms, 4.0, false}.at(200ms)), et(10ms));
}

TEST(ClockState, ReachesAnInstantAtThePredictedTime) {
  KeyedRandom random(RandomKey{5, 0, 0});
  for (int i = 0; i < 10'000; ++i) {
    const double factor = i % 2 == 0 ? 1.0 : 0.01 + 20.0 * random.uniform();
    const ClockState state{et(Duration(i)), Duration(i * 7), factor, true};
    const ExecTime due = state.base_et + Duration(std::int64_t(random.uniform() * 1e9));
    // One nanosecond short is what rounding down may cost.
    EXPECT_GE(state.at(state.mono_at(due)) + 1ns, due) << factor;
    EXPECT_LE(state.at(state.mono_at(due) - 2ns), due) << factor;
  }
}

/// A run of freezes and thaws on a manual clock, as tether-exec makes them: ET stops where the
/// machine's clock has brought it, and goes on from there.
TEST(ClockPage, ReadersSeeMonotoneEtWithoutFreezes) {
  constexpr Duration kRun = 1us;
  constexpr Duration kFreeze = 1h;  // a reading that takes a freeze for ET cannot be overlooked
  ClockPage page;
  std::atomic<std::int64_t> mono_ns{0};
  std::atomic<std::int64_t> latest_et_ns{0};  // no reader may be past it
  std::atomic<bool> over = false;
  const auto read_mono = [&] { return Duration(mono_ns.load()); };
  page.publish({et(0ns), 0ns, 1.0, true});

  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      ExecTime last{};
      while (!over) {
        const ExecTime now = page.now(read_mono);
        ASSERT_GE(now, last);
        ASSERT_LE(to_ns(now), latest_et_ns.load());
        last = now;
      }
    });
  }
  for (int i = 0; i < 20'000; ++i) {
    latest_et_ns += kRun.count();
    mono_ns += kRun.count();
    const ExecTime stopped = page.now(read_mono);
    page.publish({stopped, read_mono(), 1.0, false});
    mono_ns += kFreeze.count();
    page.publish({stopped, read_mono(), 1.0, true});
  }
  over = true;
  for (auto& reader : readers) reader.join();
  EXPECT_EQ(page.now(read_mono), et(20'000 * kRun));
}

TEST(ClockPage, IsReadableInAnotherMapping) {
  auto made = make_clock_page();
  ASSERT_TRUE(made.ok()) << made.failure().message;
  const auto mapped = map_clock_page(made->descriptor);
  ASSERT_TRUE(mapped.ok()) << mapped.failure().message;
  EXPECT_EQ(mapped->page->now(), et(0ns));
  const ClockState state{et(3s), 7s, 2.0, false};
  made->page->publish(state);
  EXPECT_EQ(mapped->page->state(), state);
  EXPECT_EQ(mapped->page->now(), et(3s));
  EXPECT_FALSE(map_clock_page(os::FileDescriptor()).ok());
}

}  // namespace
}  // namespace tether::client
