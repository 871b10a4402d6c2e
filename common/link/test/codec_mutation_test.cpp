#include "random_message.h"

#include <gtest/gtest.h>

#include <tether/base_testing/damage.h>
#include <tether/link/codec.h>

namespace tether::link {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A heap block of exactly the frame's size, so that the address sanitizer sees any read outside.
Bytes exact(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

/// Whatever comes out of a damaged frame is refused, or is a message that may be sent.
void expect_refused_or_valid(const Bytes& frame) {
  const auto decoded = decode(frame);
  if (decoded.ok()) {
    EXPECT_TRUE(validate(*decoded).ok());
  } else {
    EXPECT_EQ(decoded.failure().kind, Failure::Kind::kProtocol);
  }
}

TEST(CodecMutation, DamagedFramesAreRefusedOrValid) {
  Encoder encoder;
  for (std::uint64_t i = 0; i < 40'000; ++i) {
    KeyedRandom random({11, 1, i});
    Bytes frame = exact(encoder.encode(RandomMessage(i % 200).draw()));
    damage(frame, random);
    expect_refused_or_valid(frame);
  }
}

TEST(CodecMutation, TruncatedFramesAreRefused) {
  Encoder encoder;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const Bytes whole = exact(encoder.encode(RandomMessage(i).draw()));
    for (std::size_t size = 0; size < whole.size(); ++size) {
      Bytes frame = exact(std::span(whole).first(size));
      ASSERT_FALSE(decode(frame).ok()) << i << " at " << size;
      if (size < 4) continue;
      for (std::size_t b = 0; b < 4; ++b) frame[b] = static_cast<std::uint8_t>((size - 4) >> 8 * b);
      expect_refused_or_valid(frame);
    }
  }
}

TEST(CodecMutation, NoiseIsRefused) {
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    KeyedRandom random({13, 1, i});
    Bytes noise(random.bits() % 200);
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.bits());
    ASSERT_FALSE(decode(noise).ok());
  }
}

}  // namespace
}  // namespace tether::link
