#include "drawn_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace tether::sim {
namespace {

template <class Value>
PixelDeltas deltas_of(Value value) {
  PixelDeltas deltas{};
  for (int i = 0; i < 256; ++i) {
    deltas[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(value(i));
  }
  return deltas;
}

constexpr DrawKey kDrawKey{0xFFFFFF00U, 0x89ABCDEFU};

std::uint32_t drawn_word(const DrawKey& key, std::uint32_t i) {
  std::uint32_t x = i + key.added;
  x = ((x ^ x >> 17U) * 0xED5AD4BBU) ^ key.mixed_in;
  x = (x ^ x >> 11U) * 0xAC4C1B51U;
  x = (x ^ x >> 15U) * 0x31848BABU;
  return x ^ x >> 14U;
}

class DrawnNoiseTest : public ::testing::TestWithParam<PixelDeltas> {};

TEST_P(DrawnNoiseTest, IsTheSameOnAnyProcessor) {
  const PixelDeltas& deltas = GetParam();
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    for (const std::size_t size : {0U, 1U, 15U, 1023U, 1024U, 5001U}) {
      std::vector<std::uint8_t> bytes(size);
      for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(37 * i);
      std::vector<std::uint8_t> expected = bytes;
      std::uint32_t bits = 0;
      for (std::size_t i = 0; i < size; ++i, bits >>= 8U) {
        if (i % 4 == 0) bits = drawn_word(kDrawKey, static_cast<std::uint32_t>(i / 4));
        expected[i] =
            static_cast<std::uint8_t>(std::clamp(expected[i] + deltas[bits & 0xFFU], 0, 255));
      }
      add_drawn(deltas, kDrawKey, bytes);
      EXPECT_EQ(bytes, expected) << hwy::TargetName(target) << ", " << size << " bytes";
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

INSTANTIATE_TEST_SUITE_P(
    Deltas, DrawnNoiseTest,
    ::testing::Values(deltas_of([](int i) { return i / 20 - 6; }),             // few steps
                      deltas_of([](int i) { return i / 4 - 32; }),             // as many as allowed
                      deltas_of([](int i) { return i < 128 ? -127 : -100; }),  // all at once
                      deltas_of([](int i) { return i < 200 ? 128 : 130; }),    // beyond a byte
                      deltas_of([](int i) { return 2 * (i - 128); }),          // many steps
                      deltas_of([](int i) { return i % 7 - 3; }),              // up and down
                      deltas_of([](int i) { return i < 8 ? -256 + i : i; })));  // far

// Bytes 1 to 4, 6 and 1920 apart: channels, words, pixels and rows.
TEST(DrawnNoise, IsUniformAndUnlikeItsNeighboursAndOtherKeys) {
  constexpr std::size_t kSize = 921'600;
  const PixelDeltas all = deltas_of([](int i) { return i; });
  const auto drawn = [&](const DrawKey& key) {
    std::vector<std::uint8_t> bytes(kSize);
    add_drawn(all, key, bytes);
    return bytes;
  };
  const double limit = 4.5 / std::sqrt(kSize);
  for (const DrawKey& key : {DrawKey{0, 0}, DrawKey{1, 0}, kDrawKey, DrawKey{77, 1}}) {
    const std::vector<std::uint8_t> a = drawn(key);
    for (std::size_t from = 0; from < 4; ++from) {
      std::array<double, 256> counts{};
      for (std::size_t i = from; i < kSize; i += 4) ++counts[a[i]];
      double chi2 = 0.0;
      constexpr double kExpected = kSize / 4 / 256.0;
      for (const double n : counts) chi2 += (n - kExpected) * (n - kExpected) / kExpected;
      EXPECT_NEAR(chi2, 255.0, 4.5 * std::sqrt(2 * 255.0)) << "byte " << from << " of the words";
    }
    const auto correlation = [&](const std::vector<std::uint8_t>& b, std::size_t lag) {
      double sum = 0.0;
      for (std::size_t i = lag; i < kSize; ++i) sum += (a[i - lag] - 127.5) * (b[i] - 127.5);
      return sum / (kSize * (65'536 - 1) / 12.0);
    };
    for (const std::size_t lag : {1U, 2U, 3U, 4U, 6U, 1920U}) {
      EXPECT_LT(std::abs(correlation(a, lag)), limit) << "lag " << lag;
    }
    EXPECT_LT(std::abs(correlation(drawn({key.added + 1000, key.mixed_in}), 0)), limit);
    EXPECT_LT(std::abs(correlation(drawn({key.added, key.mixed_in ^ 1U}), 0)), limit);
    EXPECT_LT(std::abs(correlation(drawn({key.added, key.mixed_in ^ 1U << 31U}), 0)), limit);
  }
}

}  // namespace
}  // namespace tether::sim
