#include "random_message.h"

#include <gtest/gtest.h>

#include <tether/base_testing/damage.h>
#include <tether/sim_protocol/codec.h>

namespace tether::sim::protocol {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class Message>
void expect_refused_or_valid(const Result<Message>& decoded) {
  if (decoded.ok()) {
    EXPECT_TRUE(validate(*decoded).ok());
  } else {
    EXPECT_EQ(decoded.failure().kind, Failure::Kind::kProtocol);
  }
}
/// Whatever comes out of a damaged frame is refused, or is a message that may be sent.
void expect_refused_or_valid(const Bytes& frame) {
  expect_refused_or_valid(decode_request(frame));
  expect_refused_or_valid(decode_reply(frame));
}

Bytes random_frame(Encoder& encoder, std::uint64_t i) {
  RandomMessage random(i / 2);
  return i % 2 == 0 ? frame_of(encoder, random.request()) : frame_of(encoder, random.reply());
}

TEST(CodecMutation, DamagedFramesAreRefusedOrValid) {
  Encoder encoder;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    KeyedRandom random({19, 1, i});
    Bytes frame = random_frame(encoder, i % 400);
    damage(frame, random);
    expect_refused_or_valid(frame);
  }
}

TEST(CodecMutation, TruncatedFramesAreRefused) {
  Encoder encoder;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Bytes frame = random_frame(encoder, i);
    for (std::size_t size = 0; size < frame.size(); ++size) {
      const Bytes part(frame.data(), frame.data() + size);
      ASSERT_FALSE(decode_request(part).ok()) << i << " at " << size;
      ASSERT_FALSE(decode_reply(part).ok()) << i << " at " << size;
    }
  }
}

TEST(CodecMutation, TruncatedFramesWithMatchingLengthDoNotCrash) {
  Encoder encoder;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Bytes whole = random_frame(encoder, i);
    for (std::size_t size = 4; size < whole.size(); ++size) {
      Bytes frame(whole.data(), whole.data() + size);
      for (std::size_t b = 0; b < 4; ++b) frame[b] = static_cast<std::uint8_t>((size - 4) >> 8 * b);
      expect_refused_or_valid(frame);
    }
  }
}

}  // namespace
}  // namespace tether::sim::protocol
