#include "drawn_noise.h"

#include <algorithm>
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

class DrawnNoiseTest : public ::testing::TestWithParam<PixelDeltas> {};

TEST_P(DrawnNoiseTest, IsWhatKeyedRandomDrawsOnAnyProcessor) {
  constexpr RandomKey kKey{7, 11, 13};
  const PixelDeltas& deltas = GetParam();
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    for (const std::size_t size : {0U, 1U, 15U, 1023U, 1024U, 5001U}) {
      std::vector<std::uint8_t> bytes(size);
      for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(37 * i);
      std::vector<std::uint8_t> expected = bytes;
      KeyedRandom random(kKey);
      std::uint32_t bits = 0;
      for (std::size_t i = 0; i < size; ++i, bits >>= 8U) {
        if (i % 4 == 0) bits = random.bits();
        expected[i] =
            static_cast<std::uint8_t>(std::clamp(expected[i] + deltas[bits & 0xFFU], 0, 255));
      }
      add_drawn(deltas, PhiloxBlock(kKey), bytes);
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

}  // namespace
}  // namespace tether::sim
