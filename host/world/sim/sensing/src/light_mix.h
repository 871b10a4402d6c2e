#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tether::sim {

/// A weighted sum of images in linear light, which is what a sensor collects. sRGB bytes are about
/// its square root.
class LightMix {
 public:
  /// Darkness, of `bytes` bytes.
  void clear(std::size_t bytes);
  /// Adds `weight` times the light of `rgb`, from byte `first` on.
  void add(std::size_t first, std::span<const std::uint8_t> rgb, double weight);
  /// The nearest sRGB bytes. An image that was added with weights whose sum is 1 is unchanged.
  void encode(std::span<std::uint8_t> rgb) const;

 private:
  std::vector<float> light_;
};

}  // namespace tether::sim
