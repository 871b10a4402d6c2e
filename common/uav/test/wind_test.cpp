#include <array>
#include <chrono>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tether/uav/wind.h>

namespace tether::uav {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(10);
constexpr double kHeight_m = 30.0;

Wind breeze() {
  return {.v_WA_m_s = {0.0, 8.0, 0.0}, .roughness_m = 0.0, .turbulence = 1.0};
}

std::vector<Vec3> blow(const Wind& wind, std::uint64_t seed, std::size_t steps) {
  Gusts gusts(wind, kStep, seed, "uav1");
  std::vector<Vec3> values;
  for (std::size_t i = 0; i < steps; ++i) values.push_back(gusts.step(kHeight_m, {}));
  return values;
}

TEST(Wind, MeanGrowsWithTheLogarithmOfHeight) {
  const Wind wind{.v_WA_m_s = {4.0, -2.0, 0.5}, .roughness_m = 0.05};
  EXPECT_LT(norm(mean_wind_W(wind, kWindHeight_m) - wind.v_WA_m_s), 1e-12);
  EXPECT_EQ(mean_wind_W(wind, 0.05), (Vec3{0.0, 0.0, 0.5}));
  const double share = std::log(20.0 / 0.05) / std::log(kWindHeight_m / 0.05);
  EXPECT_NEAR(mean_wind_W(wind, 20.0).x, 4.0 * share, 1e-12);
  EXPECT_NEAR(mean_wind_W(wind, 20.0).y, -2.0 * share, 1e-12);
}

TEST(Wind, TurbulenceIsThatOfTheStandardInFeet) {
  // 100 ft, wind of 10 m/s at 20 ft: 0.177 + 0.0823 = 0.2593.
  const Turbulence at_100_ft =
      turbulence_at({.v_WA_m_s = {6.0, 8.0, 0.0}, .turbulence = 1.0}, 30.48);
  EXPECT_NEAR(at_100_ft.sigma_m_s.z, 1.0, 1e-12);
  EXPECT_NEAR(at_100_ft.sigma_m_s.x, 1.0 / std::pow(0.2593, 0.4), 1e-12);
  EXPECT_NEAR(at_100_ft.length_m.z, 30.48, 1e-9);
  EXPECT_NEAR(at_100_ft.length_m.x, 30.48 / std::pow(0.2593, 1.2), 1e-9);
}

// 40 flights of 100 s each. Along W's y the wind is longitudinal, along x lateral.
TEST(Gusts, HaveTheVarianceAndTheCorrelationOfDrydensFilters) {
  const Turbulence theory = turbulence_at(breeze(), kHeight_m);
  constexpr std::size_t kSteps = 10'000, kLag = 100;  // a second
  std::array<double, 3> square{}, lagged{};
  constexpr int kFlights = 40;
  for (std::uint64_t seed = 0; seed < kFlights; ++seed) {
    const std::vector<Vec3> wind = blow(breeze(), seed, kSteps);
    for (std::size_t i = 0; i + kLag < kSteps; ++i) {
      const Vec3 a = wind[i] - breeze().v_WA_m_s, b = wind[i + kLag] - breeze().v_WA_m_s;
      constexpr double kShare = 1.0 / (kFlights * static_cast<double>(kSteps - kLag));
      square[0] += kShare * a.y * a.y, lagged[0] += kShare * a.y * b.y;
      square[1] += kShare * a.x * a.x, lagged[1] += kShare * a.x * b.x;
      square[2] += kShare * a.z * a.z, lagged[2] += kShare * a.z * b.z;
    }
  }
  const std::array<double, 3> sigma = {theory.sigma_m_s.x, theory.sigma_m_s.y, theory.sigma_m_s.z};
  const std::array<double, 3> length = {theory.length_m.x, theory.length_m.y, theory.length_m.z};
  for (const std::size_t axis : {0U, 1U, 2U}) {
    const double passed = 8.0 * 1.0 / length[axis];  // lengths of air in the lag
    // Of the first filter e^−x; of the second e^−x (1 − x / 2).
    const double correlation = std::exp(-passed) * (axis == 0 ? 1.0 : 1.0 - 0.5 * passed);
    EXPECT_NEAR(std::sqrt(square[axis]), sigma[axis], 0.05 * sigma[axis]) << axis;
    EXPECT_NEAR(lagged[axis] / square[axis], correlation, 0.04) << axis;
  }
}

TEST(Gusts, AreAFunctionOfSeedAndUav) {
  EXPECT_EQ(blow(breeze(), 7, 100), blow(breeze(), 7, 100));
  EXPECT_NE(blow(breeze(), 7, 100), blow(breeze(), 8, 100));
  Gusts other(breeze(), kStep, 7, "uav2");
  EXPECT_NE(other.step(kHeight_m, {}), blow(breeze(), 7, 1).front());
}

TEST(Gusts, WithoutTurbulenceTheWindIsItsMean) {
  Wind wind = breeze();
  wind.turbulence = 0.0;
  for (const Vec3& now : blow(wind, 3, 10)) EXPECT_EQ(now, wind.v_WA_m_s);
}

}  // namespace
}  // namespace tether::uav
