#pragma once

#include "sensor_noise.h"

#include <array>
#include <cstdint>
#include <string_view>

#include <tether/base/random.h>
#include <tether/base/time.h>
#include <tether/sim/world.h>

/// What the samples of all kinds of sensors are made with. Each kind has a file in this folder.
namespace tether::sim {

/// Identifies a measurement.
struct MeasurementKey {
  std::uint64_t seed = 0;
  std::string_view uav;
  std::string_view sensor;
  std::uint64_t index = 0;
  SimTime at;
};

/// The noise of one channel of a measurement.
inline double noise_of(const Noise& noise, const MeasurementKey& key, std::string_view channel) {
  return noise_value(noise,
                     {key.seed, random_stream(key.uav, key.sensor, channel), key.index, key.at});
}

inline uav::Vec3 noise_of(const std::array<Noise, 3>& noise, const MeasurementKey& key,
                          const std::array<std::string_view, 3>& channels) {
  return {noise_of(noise[0], key, channels[0]), noise_of(noise[1], key, channels[1]),
          noise_of(noise[2], key, channels[2])};
}

/// Whether a measurement is one of those that fail with this probability.
inline bool is_dropped(double probability, const MeasurementKey& key) {
  if (probability == 0.0) return false;
  const std::uint64_t stream = random_stream(key.uav, key.sensor, "dropout");
  return KeyedRandom({key.seed, stream, key.index}).uniform() < probability;
}

}  // namespace tether::sim
