#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/client/sut_clock.h>
#include <tether/client_testing/manual_time_source.h>

namespace tether::client {
namespace {

using client_testing::ManualTimeSource;

/// Rule 5: between two interactions ET grows only by what the source measured, whatever went on
/// during them.
TEST(SutClock, BetweenInteractionsOnlyComputingCounts) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    KeyedRandom random({3, 1, trial});
    ManualTimeSource source;
    source.advance(Duration(random.bits()));  // the source's origin is its own
    ExecTime resumed = from_ns<ExecTime>(random.bits() % 100);
    SutClock clock(source, resumed);
    for (int i = 0; i < 100; ++i) {
      Duration computed{0};
      for (std::uint32_t piece = random.bits() % 4; piece > 0; --piece) {
        const Duration part(random.bits() % 1'000'000);
        source.advance(part);
        computed += part;
        ASSERT_EQ(clock.now(), resumed + computed);
      }
      const ExecTime stamp = clock.hold();
      ASSERT_EQ(stamp, resumed + computed);
      ASSERT_TRUE(clock.is_held());
      source.advance(Duration(random.bits()));  // the wire, the simulator
      ASSERT_EQ(clock.now(), stamp);
      ASSERT_EQ(clock.hold(), stamp);
      resumed = stamp + Duration(random.bits() % 50'000'000);
      clock.resume(resumed);
      ASSERT_EQ(clock.now(), resumed);
    }
  }
}

// The SUT is held, its children are not: none of their time is lost, and none comes twice.
TEST(SutClock, AddsWhatChildrenComputedDuringAnInteraction) {
  ManualTimeSource source;
  SutClock clock(source);
  source.advance_children(Duration(10));
  const ExecTime stamp = clock.hold();
  EXPECT_EQ(stamp, from_ns<ExecTime>(10));
  source.advance(Duration(1000));
  source.advance_children(Duration(7));
  EXPECT_EQ(clock.hold(), stamp);
  source.advance_children(Duration(5));
  EXPECT_EQ(clock.now(), stamp);
  clock.resume(from_ns<ExecTime>(100));
  EXPECT_EQ(clock.now(), from_ns<ExecTime>(112));
  source.advance_children(Duration(1));
  EXPECT_EQ(clock.hold(), from_ns<ExecTime>(113));
}

}  // namespace
}  // namespace tether::client
