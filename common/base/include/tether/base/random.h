#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tether {

/// The key of a random number (Philox4x32-10; Salmon et al., "Parallel random numbers: as easy as
/// 1, 2, 3", SC 2011). A value is a pure function of its key, never of earlier draws, so that
/// results do not depend on the order of execution. Draws with the same key are equal; draws with
/// different keys are independent.
struct RandomKey {
  std::uint64_t seed = 0;    ///< of the trial
  std::uint64_t stream = 0;  ///< which quantity: `random_stream(uav, sensor, "delay")`
  std::uint64_t index = 0;   ///< which sample of it
};

/// A stable 64-bit id of a named quantity (FNV-1a over the names, separated).
std::uint64_t random_stream(std::string_view uav, std::string_view sensor,
                            std::string_view quantity);

/// The Philox4x32-10 block function.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// A sequence of draws under one key, for quantities that need more than one number (the noise of
/// an image, a truncated normal distribution). Cheap to make and to copy. Not thread-safe.
class KeyedRandom {
 public:
  explicit KeyedRandom(const RandomKey& key);

  std::uint32_t bits();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Normal with mean 0 and standard deviation 1 (Box-Muller, no caching: two uniforms a draw).
  double normal();

 private:
  // The arguments of `philox4x32` for the next four draws.
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 2> key_{};
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
};

}  // namespace tether
