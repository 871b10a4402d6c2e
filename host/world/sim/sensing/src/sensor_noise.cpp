#include "sensor_noise.h"

#include "drawn_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tether::sim {
namespace {

constexpr std::uint64_t kBias = 0x62696173;  // "bias"
constexpr std::uint64_t kWalk = 0x77616c6b;  // "walk"
constexpr int kWalkLevels = 33;              // 2³³ ms: 99 days

double normal(const RandomKey& key) {
  return KeyedRandom(key).normal();
}

double constant_bias(const Noise& noise, std::uint64_t seed, std::uint64_t stream) {
  if (noise.bias_stddev == 0.0) return noise.bias_mean;
  return noise.bias_mean + noise.bias_stddev * normal({seed, stream ^ kBias, 0});
}

// The middle of two values of the process that are 2·half apart.
double walk_midpoint(double left, double right, double half_s, const Noise& noise, double draw) {
  const double tau = noise.dynamic_bias_correlation_time_s;
  const double variance = 0.5 * noise.dynamic_bias_stddev * noise.dynamic_bias_stddev * tau;
  const double decay = std::exp(-half_s / tau);
  const double one_minus_decay2 = -std::expm1(-2.0 * half_s / tau);
  const double one_plus_decay2 = 1.0 + decay * decay;
  return (left + right) * decay / one_plus_decay2 +
         std::sqrt(variance * one_minus_decay2 / one_plus_decay2) * draw;
}

// 256 equally probable values of the standard normal distribution, of standard deviation 1: the
// quantiles at the middle of each of the 256 probabilities, rescaled.
std::array<double, 256> make_quantiles() {
  std::array<double, 256> z{};
  double sum_of_squares = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double p = (static_cast<double>(i) + 0.5) / 256.0;
    double low = -8.0;
    double high = 8.0;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
    }
    z[i] = low;
    sum_of_squares += low * low;
  }
  for (double& value : z) value /= std::sqrt(sum_of_squares / 256.0);
  return z;
}

// What each of the 256 draws adds: grey levels, rounded to 1/256 first.
PixelDeltas pixel_deltas(double offset, double stddev) {
  static const std::array<double, 256> kQuantiles = make_quantiles();
  PixelDeltas deltas{};
  for (std::size_t i = 0; i < deltas.size(); ++i) {
    const double grey = std::clamp(255.0 * (offset + stddev * kQuantiles[i]), -256.0, 256.0);
    deltas[i] = static_cast<std::int16_t>((std::lround(256.0 * grey) + 128) >> 8);
  }
  return deltas;
}

}  // namespace

double walking_bias(const Noise& noise, std::uint64_t seed, std::uint64_t stream, SimTime at) {
  const double tau = noise.dynamic_bias_correlation_time_s;
  if (noise.dynamic_bias_stddev == 0.0 || tau <= 0.0) return 0.0;
  constexpr std::int64_t kNsPerNode = 1'000'000;
  const std::int64_t end = std::int64_t{1} << kWalkLevels;
  const std::int64_t node = std::clamp(to_ns(at) / kNsPerNode, std::int64_t{0}, end - 1);
  std::int64_t low = 0;
  std::int64_t high = end;
  double low_value = 0.0;
  const double stationary = noise.dynamic_bias_stddev * std::sqrt(0.5 * tau);
  double high_value = stationary * normal({seed, stream ^ kWalk, static_cast<std::uint64_t>(end)});
  while (low != node) {
    const std::int64_t middle = low + (high - low) / 2;
    const double half_s = 1e-3 * static_cast<double>(high - middle);
    const double draw = normal({seed, stream ^ kWalk, static_cast<std::uint64_t>(middle)});
    const double value = walk_midpoint(low_value, high_value, half_s, noise, draw);
    (node < middle ? high : low) = middle;
    (node < middle ? high_value : low_value) = value;
  }
  return low_value;
}

namespace {

// What the noise adds to every pixel of an image.
double image_offset(const Noise& noise, const NoiseKey& key) {
  return noise.mean + constant_bias(noise, key.seed, key.stream) +
         walking_bias(noise, key.seed, key.stream, key.at);
}

}  // namespace

double noise_value(const Noise& noise, const NoiseKey& key) {
  const double white =
      noise.stddev == 0.0 ? 0.0 : noise.stddev * normal({key.seed, key.stream, key.index});
  return noise.mean + white + constant_bias(noise, key.seed, key.stream) +
         walking_bias(noise, key.seed, key.stream, key.at);
}

double noise_stddev(const Noise& noise, SimTime at) {
  const double tau_s = noise.dynamic_bias_correlation_time_s;
  const double walk = tau_s > 0.0 ? 0.5 * noise.dynamic_bias_stddev * noise.dynamic_bias_stddev *
                                        tau_s * -std::expm1(-2.0 * to_seconds(at) / tau_s)
                                  : 0.0;
  return std::sqrt(noise.stddev * noise.stddev + noise.bias_stddev * noise.bias_stddev + walk);
}

void add_depth_noise(const Noise& noise, const NoiseKey& key, std::span<float> depth_m) {
  const double offset = image_offset(noise, key);
  if (offset == 0.0 && noise.stddev == 0.0) return;
  KeyedRandom random({key.seed, key.stream, key.index});
  for (float& depth : depth_m) {
    const double white = noise.stddev == 0.0 ? 0.0 : noise.stddev * random.normal();
    depth = static_cast<float>(depth + offset + white);
  }
}

void add_pixel_noise(const Noise& noise, const NoiseKey& key, std::span<std::uint8_t> rgb) {
  const double offset = image_offset(noise, key);
  if (offset == 0.0 && noise.stddev == 0.0) return;
  KeyedRandom random({key.seed, key.stream, key.index});
  const std::uint32_t added = random.bits();
  add_drawn(pixel_deltas(offset, noise.stddev), {added, random.bits()}, rgb);
}

}  // namespace tether::sim
