#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <tether/base/random.h>
#include <tether/base/time.h>
#include <tether/sim/world.h>

/// SDF's sensor noise as pure functions of their keys: a value depends on which sample it is and
/// when it was taken, never on the order of measurements.
namespace tether::sim {

/// Which measurement of which quantity.
struct NoiseKey {
  std::uint64_t seed = 0;
  std::uint64_t stream = 0;  ///< random_stream(uav, sensor, channel)
  std::uint64_t index = 0;
  SimTime at;
};

/// White noise plus the run's constant bias (drawn once per seed) plus the walking bias.
double noise_value(const Noise& noise, const NoiseKey& key);

/// The walking bias at one instant: a first-order Gauss-Markov process that starts at 0 and has the
/// stationary variance stddev²·τ/2 of Gazebo's dynamic bias. The process is bisected between ST 0
/// and a far end, each midpoint drawn from its exact conditional distribution under a key of its
/// own, so that any instant can be evaluated alone. Constant within each millisecond.
double walking_bias(const Noise& noise, std::uint64_t seed, std::uint64_t stream, SimTime at);

/// The standard deviation of `noise_value` at one instant, over all seeds.
double noise_stddev(const Noise& noise, SimTime at);

/// Adds the noise of measurement `key` to depths [m]: one bias for the whole image, white noise for
/// each pixel. Depths that are not finite stay as they are.
void add_depth_noise(const Noise& noise, const NoiseKey& key, std::span<float> depth_m);

/// Adds the noise of measurement `key` to an image's bytes, clamped to 0..255. The bias is one for
/// the whole image; the white noise takes one of 256 equally probable values of the normal
/// distribution per byte.
void add_pixel_noise(const Noise& noise, const NoiseKey& key, std::span<std::uint8_t> rgb);

}  // namespace tether::sim
