#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

const Question kOfCurve{.interval = 1.6, .least = 1.0, .most = 16.0};

// Flights of a curve that falls from 90 % at 4 to 10 % at 4 · e^(4.4 · width).
std::vector<Flight> flights_of_curve(std::size_t count, double width) {
  KeyedRandom random({1, 2, 3});
  std::vector<Flight> flights;
  for (std::size_t i = 0; i < count; ++i) {
    const double slowdown = std::pow(16.0, random.uniform());
    const double z = (std::log(4.0) - std::log(slowdown)) / width + std::log(9.0);
    const double u = random.uniform(), noise = std::log(u / (1.0 - u));
    flights.push_back({slowdown, z + noise >= 0.0, 0.1 * (z + noise)});
  }
  return flights;
}

SuccessCurve curve_of(const CurveGrid& grid, SuccessCurve::Margins margins,
                      const std::vector<Flight>& flights) {
  SuccessCurve curve(grid, margins);
  for (const Flight& flight : flights) curve.observe(flight);
  return curve;
}

TEST(SuccessCurve, FindsTheThresholdAndMarginsSayMore) {
  const CurveGrid grid(kOfCurve);
  const std::vector<Flight> flights = flights_of_curve(150, 0.2);
  const Threshold without = curve_of(grid, SuccessCurve::Margins::kIgnored, flights).threshold();
  const Threshold with = curve_of(grid, SuccessCurve::Margins::kLinear, flights).threshold();
  for (const Threshold& threshold : {without, with}) {
    EXPECT_LT(threshold.low, 4.0);
    EXPECT_GT(threshold.high, 4.0);
    EXPECT_LT(threshold.low, threshold.estimate);
    EXPECT_LT(threshold.estimate, threshold.high);
  }
  EXPECT_LT(with.high / with.low, without.high / without.low);
}

TEST(SuccessCurve, FliesNearTheThresholdOnceItIsKnown) {
  const CurveGrid grid(kOfCurve);
  SuccessCurve curve(grid, SuccessCurve::Margins::kIgnored);
  for (const Flight& flight : flights_of_curve(150, 0.05)) curve.observe(flight);
  for (const double slowdown : curve.next_slowdowns(3)) {
    EXPECT_GT(slowdown, 3.0);
    EXPECT_LT(slowdown, 6.0);
  }
}

TEST(SuccessCurve, FlightsOfABatchDiffer) {
  const CurveGrid grid(kOfCurve);
  const std::vector<double> slowdowns =
      SuccessCurve(grid, SuccessCurve::Margins::kIgnored).next_slowdowns(4);
  EXPECT_NE(slowdowns.front(), slowdowns.back());
}

TEST(SuccessCurve, ShareFallsAndIsInItsInterval) {
  const CurveGrid grid(kOfCurve);
  const SuccessCurve curve =
      curve_of(grid, SuccessCurve::Margins::kIgnored, flights_of_curve(100, 0.2));
  double last = 1.0;
  for (const double slowdown : {1.0, 2.0, 4.0, 8.0, 16.0}) {
    const Share share = curve.share(slowdown);
    EXPECT_LE(share.low, share.estimate);
    EXPECT_GE(share.high, share.estimate);
    EXPECT_LT(share.estimate, last);
    last = share.estimate;
  }
}

TEST(SuccessCurve, FitsItsOwnFlightsOnly) {
  const CurveGrid grid(kOfCurve);
  const std::vector<Flight> own = flights_of_curve(100, 0.2);
  std::vector<Flight> dip = own;  // nothing succeeds between 1.5 and 2
  for (Flight& flight : dip)
    if (flight.slowdown > 1.5 && flight.slowdown < 2.2) flight = {flight.slowdown, false, -0.1};
  std::vector<Flight> bent = own;  // margins that do not know of the limit
  for (Flight& flight : bent) *flight.margin *= flight.reached ? 1.0 : 0.02;
  using Margins = SuccessCurve::Margins;
  EXPECT_GT(curve_of(grid, Margins::kIgnored, own).fit(own), 0.05);
  EXPECT_GT(curve_of(grid, Margins::kLinear, own).fit(own), 0.05);
  EXPECT_LT(curve_of(grid, Margins::kIgnored, dip).fit(dip), 0.01);
  EXPECT_LT(curve_of(grid, Margins::kLinear, bent).fit(bent), 0.01);
  EXPECT_GT(curve_of(grid, Margins::kIgnored, bent).fit(bent), 0.05);
}

// Five failures at one slowdown among many flights that fit.
TEST(SuccessCurve, DoesNotFitADipAtOneSlowdown) {
  const CurveGrid grid(kOfCurve);
  std::vector<Flight> flights = flights_of_curve(300, 0.2);
  for (int i = 0; i < 8; ++i) flights.push_back({1.5, i < 3, std::nullopt});
  EXPECT_LT(curve_of(grid, SuccessCurve::Margins::kIgnored, flights).fit(flights), 0.01);
}

// Whole periods of a camera: at every other slowdown of a neighbourhood, the loop misses a picture.
TEST(SuccessCurve, DoesNotFitTeethThatAreNarrowerThanAGroup) {
  const CurveGrid grid(kOfCurve);
  std::vector<Flight> teeth, spread;
  for (std::size_t i = 0; i < 72; ++i) {
    const double slowdown = grid.slowdowns()[100 + i];
    teeth.push_back({slowdown, i % 6 < 3});
    spread.push_back({slowdown, KeyedRandom({i, 1, 3}).uniform() < 0.5});
  }
  using Margins = SuccessCurve::Margins;
  EXPECT_LT(curve_of(grid, Margins::kIgnored, teeth).fit(teeth), 0.01);
  EXPECT_GT(curve_of(grid, Margins::kIgnored, spread).fit(spread), 0.01);
}

}  // namespace
}  // namespace tether::sizing
