#include "server_fixture.h"

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include <tether/base_testing/no_more_handles.h>

/// Hostile peers: the resources that they can use are bounded, and other peers are served
/// meanwhile.
namespace tether::link {
namespace {

using namespace std::chrono_literals;

class Attack : public ServerFixture {
 protected:
  void crowd(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) crowd_.push_back(connect());
  }
  std::size_t received_from(PeerId peer) { return events_.received_from[peer]; }

  std::vector<RawClient> crowd_;
};

std::string progress_frames(std::size_t count) {
  const std::string frame = frame_bytes(Progress{});
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) bytes += frame;
  return bytes;
}

// ---- Strangers

TEST_F(Attack, SilentStrangersTakeLimitedPlacesAndMakeWayForOthers) {
  listen();
  crowd(3 * kMaxStrangers);
  ASSERT_TRUE(poll_until([&] { return events_.connected.size() == kMaxStrangers; }));
  EXPECT_TRUE(events_.closed.empty());
  RawClient honest = connect();
  expect_served(honest);
  EXPECT_LE(events_.connected.size() - events_.closed.size(), kMaxStrangers + 1);
}

TEST_F(Attack, EachNewConnectionIsAcceptedByTheNextPoll) {
  listen();
  for (std::size_t count = 1; count <= 3; ++count) {
    crowd(1);
    EXPECT_TRUE(events_.poll(*server_, 10s));
    ASSERT_EQ(events_.connected.size(), count);
    while (events_.poll(*server_, Duration(0))) continue;
  }
}

TEST_F(Attack, StrangersThatHaveAPlaceMayStayAndGreetedPeersNeedNone) {
  listen();
  crowd(kMaxStrangers);
  ASSERT_TRUE(poll_until([&] { return events_.connected.size() == kMaxStrangers; }));
  EXPECT_FALSE(events_.poll(*server_, kCrowdedStay + 50ms));
  EXPECT_TRUE(events_.closed.empty());
  for (RawClient& client : crowd_) client.write(Progress{});
  ASSERT_TRUE(poll_until([&] { return events_.received.size() == kMaxStrangers; }));
  const RawClient silent = connect();
  RawClient honest = connect();
  expect_served(honest);
  expect_served(crowd_.front());
}

/// Otherwise they would take up the places of others for as long as they may drain.
TEST_F(Attack, RefusedPeersThatStayMakeWayForOthers) {
  listen();
  events_.react = [this](PeerId peer, const Message& message) {
    if (!std::holds_alternative<Hello>(message)) return;
    server_->send(peer, Refusal{Refusal::Reason::kToken, "wrong token"});
    server_->close(peer);
  };
  crowd(2 * kMaxStrangers);
  for (RawClient& client : crowd_) client.write(Hello{});
  RawClient honest = connect();
  honest.write(Progress{});
  ASSERT_TRUE(poll_until([&] {
    return !events_.received.empty() &&
           std::holds_alternative<Progress>(events_.received.back().message);
  }));
}

TEST_F(Attack, DrippingBytesDoNotMoveTheDeadline) {
  listen(30ms);
  RawClient slow = connect();
  const std::string frame = progress_frames(1);
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; events_.closed.empty() && i + 1 < frame.size(); ++i) {
    slow.write(frame.substr(i, 1));
    events_.poll(*server_, 5ms);
  }
  ASSERT_TRUE(wait_for_closed());
  EXPECT_EQ(events_.closed[0].failure.kind, Failure::Kind::kTimeout);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 30ms);
  EXPECT_TRUE(events_.received.empty());
}

TEST_F(Attack, LongestHelloFitsAndLongerFramesMayFollow) {
  listen();
  const std::string longest(kMaxNameBytes, 'x');
  RawClient client = connect();
  client.write(Hello{.sut = longest, .uav = longest, .token = longest});
  client.write(Annotation{ExecTime{}, "topic", "{\"x\": \"" + std::string(500'000, 'x') + "\"}"});
  ASSERT_TRUE(poll_until([&] { return events_.received.size() == 2; }));
  EXPECT_EQ(std::get<Hello>(events_.received[0].message).token, longest);
  EXPECT_EQ(std::get<Annotation>(events_.received[1].message).json.size(), 500'009u);
}

TEST_F(Attack, ConnectionsThatComeAndGoLeaveNothing) {
  listen();
  for (std::size_t i = 0; i < 5 * kMaxStrangers; ++i) {
    connect();
    events_.poll(*server_, Duration(0));
  }
  {
    RawClient honest = connect();
    expect_served(honest);
  }
  ASSERT_TRUE(poll_until([&] { return events_.closed.size() == events_.connected.size(); }));
}

// ---- Floods

TEST_F(Attack, FloodIsHandledInBoundedPartsAndOthersBetweenThem) {
  listen();
  RawClient flooding = connect(), honest = connect();
  expect_served(flooding);
  expect_served(honest);
  constexpr std::size_t kFlood = 100'000;
  const std::string frames = progress_frames(kFlood);
  std::thread flood([&] { flooding.write(frames); });
  ASSERT_TRUE(poll_until([&] { return received_from(1) > 1000; }));
  honest.write(Progress{});
  // A peer is polled at most 16 times in a row before the others.
  for (int i = 0; i < 20 && received_from(2) == 1; ++i) events_.poll(*server_, 1ms);
  EXPECT_EQ(received_from(2), 2u);
  EXPECT_LT(received_from(1), kFlood);

  std::size_t most = 0, before = received_from(1);
  EXPECT_TRUE(poll_until([&] {
    most = std::max(most, received_from(1) - before);
    before = received_from(1);
    return before == kFlood + 1;
  }));
  flood.join();
  EXPECT_LE(most * (frames.size() / kFlood), kMaxRequestBytes + kMaxHelloBytes);
}

TEST_F(Attack, DestructorDoesNotWaitForAPeerThatKeepsSending) {
  listen();
  RawClient flooding = connect();
  expect_served(flooding);
  const std::string frames = progress_frames(1000);
  std::atomic<bool> over = false;
  std::thread flood([&] {
    while (!over) flooding.write(frames);
  });
  ASSERT_TRUE(poll_until([&] { return received_from(1) > 1000; }));
  server_.reset();
  over = true;
  flood.join();
}

// ---- Out of descriptors

TEST_F(Attack, WithoutDescriptorsConnectedPeersAreServedAndOthersLater) {
  listen();
  RawClient inside = connect();
  expect_served(inside);
  RawClient outside = connect();
  {
    const NoMoreHandles none;
    expect_served(inside);
    // Nobody can be accepted; that must not keep the loop turning.
    int turns = 0;
    const auto end = std::chrono::steady_clock::now() + 50ms;
    for (; std::chrono::steady_clock::now() < end; ++turns) events_.poll(*server_, 50ms);
    EXPECT_LT(turns, 10);
    EXPECT_EQ(events_.connected.size(), 1u);
  }
  expect_served(outside);
}

}  // namespace
}  // namespace tether::link
