#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <tether/base/random.h>

namespace tether {
namespace {

// Known-answer vectors published with Random123 (kat_vectors, philox4x32-10).
TEST(Philox, KnownAnswers) {
  using Block = std::array<std::uint32_t, 4>;
  constexpr std::uint32_t ones = 0xffffffffu;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({ones, ones, ones, ones}, {ones, ones}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(KeyedRandom, DependsOnEachBitOfTheKeyAlone) {
  std::set<std::uint32_t> seen;
  for (std::uint64_t i = 0; i < 64; ++i) {
    const std::uint64_t bit = std::uint64_t{1} << i;
    for (const RandomKey& key : {RandomKey{bit, 0, 0}, {0, bit, 0}, {0, 0, bit}}) {
      seen.insert(KeyedRandom(key).bits());
      EXPECT_EQ(KeyedRandom(key).normal(), KeyedRandom(key).normal());
    }
  }
  EXPECT_EQ(seen.size(), 3u * 64u);
}

TEST(KeyedRandom, StreamNamesDoNotRunIntoEachOther) {
  EXPECT_NE(random_stream("ab", "c", "d"), random_stream("a", "bc", "d"));
  EXPECT_NE(random_stream("", "", "a"), random_stream("", "a", ""));
}

/// The mean of the n-th power of many draws.
template <class Draw>
double moment(int n, const Draw& draw) {
  constexpr int kCount = 200'000;
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) sum += std::pow(draw(), n);
  return sum / kCount;
}

TEST(KeyedRandom, DrawsHaveTheMomentsOfTheirDistribution) {
  KeyedRandom random({.seed = 3});
  const auto uniform = [&] {
    const double u = random.uniform();
    EXPECT_TRUE(u >= 0.0 && u < 1.0);
    return u;
  };
  EXPECT_NEAR(moment(1, uniform), 0.5, 0.003);
  EXPECT_NEAR(moment(2, uniform), 1.0 / 3.0, 0.003);
  const auto normal = [&] { return random.normal(); };
  EXPECT_NEAR(moment(1, normal), 0.0, 0.01);
  EXPECT_NEAR(moment(2, normal), 1.0, 0.02);
  EXPECT_NEAR(moment(4, normal), 3.0, 0.15);
}

}  // namespace
}  // namespace tether
