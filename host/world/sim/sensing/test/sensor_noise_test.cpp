#include "sensor_noise.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

struct Moments {
  double mean = 0.0;
  double stddev = 0.0;
};

template <class Draw>
Moments moments(int count, Draw draw) {
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < count; ++i) {
    const double value = draw(static_cast<std::uint64_t>(i));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

TEST(SensorNoiseTest, WhiteNoiseAndBiasHaveTheirMoments) {
  const Noise noise{0.5, 0.2, 1.0, 0.3, 0.0, 0.0};
  const Moments within = moments(20'000, [&](std::uint64_t i) {
    return noise_value(noise, {1, 2, i, SimTime{}});
  });
  EXPECT_NEAR(within.stddev, 0.2, 0.005) << "one run: its bias is constant";
  const Moments across = moments(20'000, [&](std::uint64_t seed) {
    return noise_value(noise, {seed, 2, 0, SimTime{}});
  });
  EXPECT_NEAR(across.mean, 1.5, 0.01);
  EXPECT_NEAR(across.stddev, std::hypot(0.2, 0.3), 0.01);
}

TEST(SensorNoiseTest, WalkIsGaussMarkov) {
  const Noise noise{0.0, 0.0, 0.0, 0.0, 0.1, 2.0};
  const double stationary = 0.1 * std::sqrt(0.5 * 2.0);
  const auto walk = [&](std::uint64_t seed, double t_s) {
    return walking_bias(noise, seed, 9, SimTime(duration_from_seconds(t_s)));
  };
  EXPECT_EQ(walk(3, 0.0), 0.0);
  EXPECT_EQ(noise_value({}, {1, 2, 3, SimTime(std::chrono::seconds(5))}), 0.0);
  const Moments early = moments(4'000, [&](std::uint64_t seed) { return walk(seed, 0.5); });
  EXPECT_NEAR(early.stddev, stationary * std::sqrt(1.0 - std::exp(-0.5)), 0.004);
  const Moments late = moments(4'000, [&](std::uint64_t seed) { return walk(seed, 60.0); });
  EXPECT_NEAR(late.stddev, stationary, 0.004);
  const double lag_s = 1.234;
  const Moments innovation = moments(4'000, [&](std::uint64_t seed) {
    return walk(seed, 50.0 + lag_s) - std::exp(-lag_s / 2.0) * walk(seed, 50.0);
  });
  EXPECT_NEAR(innovation.mean, 0.0, 0.004);
  EXPECT_NEAR(innovation.stddev, stationary * std::sqrt(1.0 - std::exp(-lag_s)), 0.004);
}

TEST(SensorNoiseTest, PixelNoiseHasItsMoments) {
  for (const double stddev : {0.002, 0.007, 0.05}) {
    std::vector<std::uint8_t> rgb(300'000, 128);
    add_pixel_noise({0.01, stddev, 0.0, 0.0, 0.0, 0.0}, {1, 2, 3, SimTime{}}, rgb);
    const Moments m =
        moments(300'000, [&](std::uint64_t i) { return static_cast<double>(rgb[i]); });
    EXPECT_NEAR(m.mean, 128.0 + 2.55, 0.1);
    EXPECT_NEAR(m.stddev, std::hypot(255.0 * stddev, std::sqrt(1.0 / 12.0)), 0.03 * m.stddev);
  }
}

TEST(SensorNoiseTest, PixelNoiseIsClampedAndKeyed) {
  std::vector<std::uint8_t> dark(1'000, 0);
  std::vector<std::uint8_t> same = dark;
  std::vector<std::uint8_t> other = dark;
  const Noise noise{0.0, 0.5, 0.0, 0.0, 0.0, 0.0};
  add_pixel_noise(noise, {1, 2, 3, SimTime{}}, dark);
  add_pixel_noise(noise, {1, 2, 3, SimTime{}}, same);
  add_pixel_noise(noise, {1, 2, 4, SimTime{}}, other);
  EXPECT_EQ(dark, same);
  EXPECT_NE(dark, other);
  EXPECT_NEAR(static_cast<double>(std::count(dark.begin(), dark.end(), 0)), 500.0, 60.0);
}

}  // namespace
}  // namespace tether::sim
