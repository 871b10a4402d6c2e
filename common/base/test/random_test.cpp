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

TEST(KeyedRandom, DependsOnTheKeyAlone) {
  const RandomKey key{7, random_stream("uav1", "camera", "delay"), 42};
  KeyedRandom a(key), b(key);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.bits(), b.bits());
}

TEST(KeyedRandom, EveryPartOfTheKeyMatters) {
  std::set<std::uint32_t> seen;
  for (std::uint64_t i = 0; i < 64; ++i) {
    const std::uint64_t bit = std::uint64_t{1} << i;
    seen.insert(KeyedRandom({bit, 0, 0}).bits());
    seen.insert(KeyedRandom({0, bit, 0}).bits());
    seen.insert(KeyedRandom({0, 0, bit}).bits());
  }
  EXPECT_EQ(seen.size(), 3u * 64u);
}

TEST(KeyedRandom, StreamNamesDoNotRunIntoEachOther) {
  EXPECT_NE(random_stream("ab", "c", "d"), random_stream("a", "bc", "d"));
  EXPECT_NE(random_stream("", "", "a"), random_stream("", "a", ""));
}

TEST(KeyedRandom, UniformHasItsMoments) {
  KeyedRandom random({.seed = 3});
  constexpr int n = 200'000;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 0.003);
  EXPECT_NEAR(squares / n, 1.0 / 3.0, 0.003);
}

TEST(KeyedRandom, NormalHasItsMoments) {
  KeyedRandom random({.seed = 4});
  constexpr int n = 200'000;
  double sum = 0.0, squares = 0.0, fourth = 0.0;
  for (int i = 0; i < n; ++i) {
    const double z = random.normal();
    sum += z;
    squares += z * z;
    fourth += z * z * z * z;
  }
  EXPECT_NEAR(sum / n, 0.0, 0.01);
  EXPECT_NEAR(squares / n, 1.0, 0.02);
  EXPECT_NEAR(fourth / n, 3.0, 0.15);
}

}  // namespace
}  // namespace tether
