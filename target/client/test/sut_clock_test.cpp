#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/client/sut_clock.h>
#include <tether/client_testing/manual_time_source.h>

namespace tether::client {
namespace {

using client_testing::ManualTimeSource;

/// One action on a clock, and the ET that it must show after it [ns].
struct Row {
  enum class Do { kCompute, kHold, kResume };
  Do action;
  std::int64_t ns;  // computed for, or resumed at
  std::int64_t expected_et_ns;
};

void run(const std::vector<Row>& rows, std::int64_t start_ns) {
  ManualTimeSource source;
  source.advance(Duration(123'456));  // the source's origin is its own
  SutClock clock(source, from_ns<ExecTime>(start_ns));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (row.action == Row::Do::kCompute) source.advance(Duration(row.ns));
    if (row.action == Row::Do::kHold) {
      EXPECT_EQ(to_ns(clock.hold()), row.expected_et_ns) << "row " << i;
      EXPECT_TRUE(clock.is_held());
    }
    if (row.action == Row::Do::kResume) clock.resume(from_ns<ExecTime>(row.ns));
    EXPECT_EQ(to_ns(clock.now()), row.expected_et_ns) << "row " << i;
  }
}

TEST(SutClock, RunsWithItsSource) {
  run({{Row::Do::kCompute, 0, 50}, {Row::Do::kCompute, 7, 57}, {Row::Do::kCompute, 1, 58}}, 50);
}

TEST(SutClock, StandsStillWhileHeld) {
  run({{Row::Do::kCompute, 10, 10},
       {Row::Do::kHold, 0, 10},
       {Row::Do::kCompute, 1000, 10},
       {Row::Do::kHold, 0, 10},
       {Row::Do::kCompute, 1000, 10}},
      0);
}

TEST(SutClock, GoesOnFromTheReplysTimestamp) {
  run({{Row::Do::kCompute, 10, 10},
       {Row::Do::kHold, 0, 10},
       {Row::Do::kCompute, 1000, 10},  // the wire, the simulator
       {Row::Do::kResume, 35, 35},
       {Row::Do::kCompute, 5, 40},
       {Row::Do::kHold, 0, 40},
       {Row::Do::kResume, 40, 40},  // an answer without delay
       {Row::Do::kCompute, 2, 42}},
      0);
}

/// Rule 5: between two interactions ET grows only by what the source measured, whatever went on
/// during them.
TEST(SutClock, BetweenInteractionsOnlyComputingCounts) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    KeyedRandom random({3, 1, trial});
    ManualTimeSource source;
    SutClock clock(source);
    ExecTime resumed{};
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
      source.advance(Duration(random.bits()));
      resumed = stamp + Duration(random.bits() % 50'000'000);
      clock.resume(resumed);
      ASSERT_EQ(clock.now(), resumed);
    }
  }
}

}  // namespace
}  // namespace tether::client
