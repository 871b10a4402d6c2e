#include <array>
#include <cmath>
#include <set>

#include <gmock/gmock.h>

#include <tether/uav/sensor_timing.h>

namespace tether::uav {
namespace {

using std::chrono::milliseconds;

RandomKey key(std::uint64_t index) {
  return {99, random_stream("uav", "camera", "delay"), index};
}

TEST(Delay, ConstantIsConstant) {
  EXPECT_EQ(draw(ConstantDelay{milliseconds(20)}, key(0)), milliseconds(20));
  EXPECT_EQ(draw(ConstantDelay{milliseconds(-20)}, key(0)), Duration::zero());
  EXPECT_EQ(draw(EmpiricalDelay{}, key(0)), Duration::zero());
}

TEST(Delay, NormalHasItsMeanAndStandardDeviation) {
  const NormalDelay delay{milliseconds(50), milliseconds(5)};
  constexpr int kDraws = 20'000;
  double sum = 0, squares = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double ms = to_seconds(draw(delay, key(i))) * 1e3;
    sum += ms;
    squares += ms * ms;
  }
  const double average = sum / kDraws;
  EXPECT_NEAR(average, 50.0, 0.15);
  EXPECT_NEAR(std::sqrt(squares / kDraws - average * average), 5.0, 0.15);
}

TEST(Delay, NormalIsTruncatedNotClamped) {
  const NormalDelay delay{milliseconds(1), milliseconds(5)};
  int zeros = 0;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Duration value = draw(delay, key(i));
    EXPECT_GE(value, Duration::zero());
    zeros += value == Duration::zero() ? 1 : 0;
  }
  EXPECT_LT(zeros, 3);
}

TEST(Delay, NormalFarBelowZeroEnds) {
  EXPECT_EQ(draw(NormalDelay{-std::chrono::hours(1), milliseconds(1)}, key(0)), Duration::zero());
  EXPECT_EQ(draw(NormalDelay{milliseconds(3), Duration::zero()}, key(0)), milliseconds(3));
}

TEST(Delay, EmpiricalDrawsEachSampleAsOften) {
  const EmpiricalDelay delay{{milliseconds(1), milliseconds(2), milliseconds(4)}};
  std::array<int, 5> count{};
  for (std::uint64_t i = 0; i < 6000; ++i) {
    const Duration value = draw(delay, key(i));
    ++count.at(static_cast<std::size_t>(value / milliseconds(1)));
  }
  for (const int n : {count[1], count[2], count[4]}) EXPECT_NEAR(n, 2000, 150);
}

TEST(Delay, IsAFunctionOfItsKeyAlone) {
  const Delay delay = NormalDelay{milliseconds(50), milliseconds(5)};
  std::set<Duration> values;
  for (std::uint64_t i = 0; i < 100; ++i) values.insert(draw(delay, key(i)));
  EXPECT_GT(values.size(), 95u);
  for (std::uint64_t i = 100; i-- > 0;) EXPECT_TRUE(values.contains(draw(delay, key(i))));
}

TEST(Delay, Mean) {
  EXPECT_EQ(mean(ConstantDelay{milliseconds(7)}), milliseconds(7));
  EXPECT_EQ(mean(NormalDelay{milliseconds(8), milliseconds(80)}), milliseconds(8));
  EXPECT_EQ(mean(EmpiricalDelay{{milliseconds(2), milliseconds(5)}}), Duration(3'500'000));
  EXPECT_EQ(mean(EmpiricalDelay{}), Duration::zero());
}

TEST(PeriodicTiming, SamplesAtPhasePlusMultiples) {
  const PeriodicTiming timing{Duration(33'333'333), milliseconds(5), ConstantDelay{}};
  EXPECT_EQ(to_ns(sampling_instant(timing, 0)), 5'000'000);
  EXPECT_EQ(to_ns(sampling_instant(timing, 3)), 104'999'999);
}

}  // namespace
}  // namespace tether::uav
