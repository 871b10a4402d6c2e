#include "drawn_noise.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace tether::sim {
namespace {

TEST(DrawnNoise, IsWhatKeyedRandomDrawsOnAnyProcessor) {
  constexpr RandomKey kKey{7, 11, 13};
  PixelDeltas deltas{};
  for (int i = 0; i < 256; ++i) {
    deltas[static_cast<std::size_t>(i)] = i < 8 ? (i - 4) * 16384 : 97 * (i - 128);
  }
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
        expected[i] = static_cast<std::uint8_t>(
            std::clamp((expected[i] * 256 + deltas[bits & 0xFFU] + 128) >> 8, 0, 255));
      }
      add_drawn(deltas, PhiloxBlock(kKey), bytes);
      EXPECT_EQ(bytes, expected) << hwy::TargetName(target) << ", " << size << " bytes";
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace
}  // namespace tether::sim
