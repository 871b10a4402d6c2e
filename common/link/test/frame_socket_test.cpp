#include <array>
#include <chrono>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <tether/link/socket.h>

namespace tether::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Bytes = std::vector<std::uint8_t>;

std::pair<Descriptor, Descriptor> connected() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// A frame of one byte, which is `content`.
Bytes frame_of(std::uint8_t content) {
  return {1, 0, 0, 0, content};
}

TEST(LookOutTest, PausesAfterSeveralInVainAndGoesOnAfterOneInTime) {
  LookOut look_out(true);
  for (int i = 0; i < LookOut::kMostMisses; ++i) {
    ASSERT_TRUE(look_out.is_due());
    look_out.done(false);
  }
  for (const bool in_time : {false, true}) {
    for (int i = 0; i < LookOut::kPause; ++i) ASSERT_FALSE(look_out.is_due());
    ASSERT_TRUE(look_out.is_due());
    look_out.done(in_time);
  }
  EXPECT_TRUE(look_out.is_due());
  EXPECT_FALSE(LookOut(false).is_due()) << "one core only";
}

TEST(FrameSocketTest, ReportsATimeoutThenAFrameThenTheEnd) {
  auto [a, b] = connected();
  FrameSocket here(std::move(a), "there", 100);
  {
    FrameSocket there(std::move(b), "here", 100);
    EXPECT_EQ(here.receive_within(milliseconds(1)).failure().kind, Failure::Kind::kTimeout);
    const Bytes first = frame_of(8);
    ASSERT_TRUE(there.send({std::span(first).first(2), {}, std::span(first).subspan(2)}).ok());
    const auto received = here.receive_within(seconds(10));
    EXPECT_EQ(Bytes(received->begin(), received->end()), first);
  }
  EXPECT_EQ(here.receive().failure().kind, Failure::Kind::kDisconnected);
  const Bytes frame = frame_of(7);
  EXPECT_EQ(here.send({frame, {}, {}}).failure().kind, Failure::Kind::kDisconnected);
}

TEST(FrameSocketTest, StopsSendingToAPeerThatDoesNotRead) {
  auto [a, b] = connected();
  limit_sending(a.get(), milliseconds(1));
  FrameSocket here(std::move(a), "there", 100);
  const Bytes more_than_the_system_keeps(16u << 20);
  const Status sent = here.send({more_than_the_system_keeps, {}, {}});
  ASSERT_FALSE(sent.ok());
  EXPECT_EQ(sent.failure().kind, Failure::Kind::kTimeout);
}

}  // namespace
}  // namespace tether::link
