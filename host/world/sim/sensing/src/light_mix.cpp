#include "light_mix.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tether::sim {
namespace {

// Light is counted from 0 to this: the darkest bytes are 20 apart.
constexpr int kWhite = 65535;

// IEC 61966-2-1.
double linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

std::array<float, 256> make_light() {
  std::array<float, 256> light{};
  for (std::size_t i = 0; i < light.size(); ++i) {
    light[i] = static_cast<float>(kWhite * linear(static_cast<double>(i) / 255.0));
  }
  return light;
}

// The byte whose colour is nearest, for each whole amount of light.
std::array<std::uint8_t, kWhite + 1> make_bytes() {
  std::array<std::uint8_t, kWhite + 1> bytes{};
  int byte = 0;
  for (int light = 0; light <= kWhite; ++light) {
    while (byte < 255 && light > kWhite * linear((byte + 0.5) / 255.0)) ++byte;
    bytes[static_cast<std::size_t>(light)] = static_cast<std::uint8_t>(byte);
  }
  return bytes;
}

}  // namespace

void LightMix::clear(std::size_t bytes) {
  light_.assign(bytes, 0.0F);
}

void LightMix::add(std::size_t first, std::span<const std::uint8_t> rgb, double weight) {
  static const std::array<float, 256> kLight = make_light();
  std::array<float, 256> weighted{};
  const auto factor = static_cast<float>(weight);
  std::transform(kLight.begin(), kLight.end(), weighted.begin(),
                 [&](float light) { return factor * light; });
  float* out = light_.data() + first;
  for (const std::uint8_t byte : rgb) *out++ += weighted[byte];
}

void LightMix::encode(std::span<std::uint8_t> rgb) const {
  static const std::array<std::uint8_t, kWhite + 1> kBytes = make_bytes();
  std::transform(light_.begin(), light_.end(), rgb.begin(), [](float light) {
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): light is not negative
    const int rounded = static_cast<int>(light + 0.5F);
    return kBytes[static_cast<std::size_t>(std::min(rounded, kWhite))];
  });
}

}  // namespace tether::sim
