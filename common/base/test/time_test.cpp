#include <cmath>
#include <limits>
#include <type_traits>

#include <gtest/gtest.h>

#include <tether/base/time.h>

namespace tether {
namespace {

template <class A, class B>
concept Mixable = requires(A a, B b) {
  a - b;
}
|| requires(A a, B b) {
  a < b;
};

TEST(Time, AxesDoNotMix) {
  static_assert(!std::is_convertible_v<SimTime, ExecTime> && !Mixable<SimTime, ExecTime>);
  static_assert(!std::is_convertible_v<ExecTime, SimTime> && !Mixable<ExecTime, WallTime>);
  static_assert(!std::is_convertible_v<WallTime, SimTime> && !Mixable<SimTime, WallTime>);
  static_assert(!std::is_convertible_v<double, Duration>);
}

TEST(Time, SameInstantKeepsTheTimestampAndLagIsEtMinusSt) {
  constexpr auto et = from_ns<ExecTime>(123'456'789);
  static_assert(to_ns(same_instant(et)) == 123'456'789);
  static_assert(same_instant(same_instant(et)) == et);
  static_assert(lag(from_ns<ExecTime>(10), from_ns<SimTime>(4)) == Duration(6));
  static_assert(lag(from_ns<ExecTime>(4), from_ns<SimTime>(10)) == Duration(-6));
}

TEST(Time, SecondsRoundToTheNearestNanosecond) {
  using Limits = std::numeric_limits<std::int64_t>;
  const std::pair<double, std::int64_t> cases[] = {{0.0, 0},
                                                   {1e-9, 1},
                                                   {0.4e-9, 0},
                                                   {0.5e-9, 1},
                                                   {-0.5e-9, -1},
                                                   {0.1, 100'000'000},
                                                   {0.0374, 37'400'000},
                                                   {-2.5, -2'500'000'000},
                                                   {1e300, Limits::max()},
                                                   {-1e300, Limits::min()},
                                                   {std::nan(""), 0}};
  for (const auto& [seconds, ns] : cases)
    EXPECT_EQ(duration_from_seconds(seconds).count(), ns) << seconds;
}

TEST(Time, SecondsSurviveTheRoundTripForDays) {
  for (std::int64_t ns = 1; ns < (std::int64_t{1} << 51); ns = ns * 7 + 3)
    EXPECT_EQ(duration_from_seconds(to_seconds(Duration(ns))), Duration(ns));
}

TEST(Time, RepresentableSeconds) {
  EXPECT_TRUE(is_representable_seconds(9e9));
  for (const double seconds : {1e10, std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_FALSE(is_representable_seconds(seconds));
}

}  // namespace
}  // namespace tether
