#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/link/socket.h>

namespace tether::link {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes frame_of(std::size_t payload, std::uint8_t fill) {
  Bytes frame(4 + payload, fill);
  for (std::size_t i = 0; i < 4; ++i) frame[i] = static_cast<std::uint8_t>(payload >> 8 * i);
  return frame;
}

/// Hands `bytes` over in one receive, as many as fit. Returns how many.
std::size_t feed(FrameBuffer& buffer, std::span<const std::uint8_t> bytes) {
  const auto space = buffer.space();
  const std::size_t count = std::min(space.size(), bytes.size());
  std::copy_n(bytes.begin(), count, space.begin());
  buffer.commit(count);
  return count;
}

/// Frames of many sizes, in one stream cut at random places, come out whole and in order.
TEST(FrameBuffer, FramesComeOutWholeHoweverTheStreamIsCut) {
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    KeyedRandom random({1, 2, trial});
    std::vector<Bytes> frames;
    Bytes stream;
    for (std::uint8_t i = 0; i < 40; ++i) {
      const std::size_t limit = i % 10 == 0 ? 300'000 : 200;
      frames.push_back(frame_of(1 + random.bits() % limit, i));
      stream.insert(stream.end(), frames.back().begin(), frames.back().end());
    }
    FrameBuffer buffer(1 << 20);
    std::size_t got = 0;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t cut = std::min<std::size_t>(stream.size() - at, 1 + random.bits() % 50'000);
      at += feed(buffer, std::span(stream).subspan(at, cut));
      for (auto frame = buffer.next();; frame = buffer.next()) {
        ASSERT_TRUE(frame.ok());
        if (frame->empty()) break;
        ASSERT_TRUE(
            std::equal(frame->begin(), frame->end(), frames[got].begin(), frames[got].end()));
        ++got;
      }
    }
    EXPECT_EQ(got, frames.size());
  }
}

TEST(FrameBuffer, KnowsWhatIsMissing) {
  FrameBuffer buffer(1 << 20);
  EXPECT_EQ(buffer.missing(), 0u);
  const Bytes frame = frame_of(200'000, 1);
  feed(buffer, std::span(frame).first(1004));
  ASSERT_TRUE(buffer.next()->empty());
  EXPECT_EQ(buffer.missing(), 199'000u);
  EXPECT_GE(buffer.space().size(), 199'000u);
  feed(buffer, std::span(frame).subspan(1004));
  EXPECT_EQ(buffer.next()->size(), frame.size());
  EXPECT_EQ(buffer.missing(), 0u);
}

TEST(FrameBuffer, RefusesAnOversizedLengthBeforeItsBytesCome) {
  FrameBuffer buffer(1000);
  const Bytes frame_bytes = frame_of(1001, 0);
  feed(buffer, std::span(frame_bytes).first(4));
  const auto frame = buffer.next();
  ASSERT_FALSE(frame.ok());
  EXPECT_EQ(frame.failure().kind, Failure::Kind::kProtocol);
}

}  // namespace
}  // namespace tether::link
