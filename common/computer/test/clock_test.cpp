#include <cmath>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/computer/clock.h>

namespace tether::computer {
namespace {

TEST(Clock, IsTheSameAfterItsText) {
  KeyedRandom random({1, 2, 3});
  for (std::size_t i = 0; i < 6'000; ++i) {
    const auto kind = static_cast<ClockKind>(i % kClockKinds);
    const double rate = std::pow(10.0, 12.0 * random.uniform() - 6.0);
    Clock clock{.kind = kind};
    if (kind == ClockKind::kWall || kind == ClockKind::kCpu) clock.factor = rate;
    if (kind == ClockKind::kScripted) clock.computing = Duration(1 + std::llround(rate * 1e6));
    const auto parsed = parse_clock(clock.text());
    ASSERT_TRUE(parsed) << clock.text();
    EXPECT_EQ(*parsed, clock) << clock.text();
  }
}

TEST(Clock, HasTheShortestText) {
  EXPECT_EQ((Clock{ClockKind::kWall}).text(), "wall");
  EXPECT_EQ((Clock{ClockKind::kCpu, 12.0}).text(), "cpu*12");
  EXPECT_EQ((Clock{ClockKind::kWall, 0.1}).text(), "wall*0.1");
  EXPECT_EQ((Clock{ClockKind::kScripted, 1.0, Duration(2'500'000)}).text(), "scripted*2.5");
  EXPECT_EQ((Clock{ClockKind::kReplayed}).text(), "replayed");
}

TEST(ParseClock, RefusesOtherTexts) {
  for (const char* text : {"", "sundial", "cpu*", "cpu*0", "cpu*1e7", "cpu*4x", "*4", "counted*2",
                           "scripted", "scripted*-1", "wall*nan", "cpu*4*2", "WALL"})
    EXPECT_FALSE(parse_clock(text)) << text;
}

TEST(Clock, NeedsTheBarrierIfItIsNotTheTimeOfThisMachine) {
  EXPECT_FALSE((Clock{ClockKind::kWall}).needs_barrier());
  EXPECT_FALSE((Clock{ClockKind::kCpu, 4.0}).needs_barrier());
  EXPECT_TRUE((Clock{ClockKind::kWall, 4.0}).needs_barrier());
  EXPECT_TRUE((Clock{ClockKind::kUnstamped}).needs_barrier());
}

}  // namespace
}  // namespace tether::computer
