#include "light_mix.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes every_byte() {
  Bytes bytes(256);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

Bytes mixed(const Bytes& a, double weight_a, const Bytes& b, double weight_b) {
  LightMix mix;
  mix.clear(a.size());
  mix.add(0, a, weight_a);
  mix.add(0, b, weight_b);
  Bytes out(a.size());
  mix.encode(out);
  return out;
}

TEST(LightMixTest, OneImageComesOutAsItWentIn) {
  const Bytes all = every_byte();
  EXPECT_EQ(mixed(all, 1.0, all, 0.0), all);
  EXPECT_EQ(mixed(all, 0.3, all, 0.7), all) << "whatever the weights";
  LightMix mix;
  mix.clear(all.size());
  for (int i = 0; i < 32; ++i) mix.add(0, all, 1.0 / 32.0);
  Bytes out(all.size());
  mix.encode(out);
  EXPECT_EQ(out, all);
}

TEST(LightMixTest, MixesLightNotBytes) {
  // Half the light of white is sRGB 188, of 100 (12.7 % of white) sRGB 71.
  EXPECT_EQ(mixed({0, 255, 100}, 0.5, {255, 0, 0}, 0.5), (Bytes{188, 188, 71}));
}

TEST(LightMixTest, AddsRowsWhereTheyBelong) {
  LightMix mix;
  mix.clear(4);
  mix.add(2, Bytes{9, 8}, 1.0);
  mix.add(0, Bytes{7, 6}, 1.0);
  Bytes out(4);
  mix.encode(out);
  EXPECT_EQ(out, (Bytes{7, 6, 9, 8}));
  mix.clear(4);
  mix.encode(out);
  EXPECT_EQ(out, Bytes(4, 0));
}

}  // namespace
}  // namespace tether::sim
