#include "raw_client.h"
#include "recording_events.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/no_more_handles.h>
#include <tether/link/server.h>

/// Peers that mean harm: what they may take up is bounded, and an honest one beside them is served.
namespace tether::link {
namespace {

using namespace std::chrono_literals;

class Attack : public testing::Test {
 protected:
  void listen(Duration hello_timeout = 10s) {
    server_ = listen_tcp({"127.0.0.1", 0}, hello_timeout);
  }
  std::unique_ptr<RawClient> connect() { return std::make_unique<RawClient>(server_->address()); }
  void crowd(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) crowd_.push_back(connect());
  }
  bool poll_until(const std::function<bool()>& done) {
    return link::poll_until(*server_, events_, done);
  }
  void expect_served(RawClient& client) {
    const std::size_t before = events_.received.size();
    client.write(Progress{from_ns<ExecTime>(7)});
    ASSERT_TRUE(poll_until([&] { return events_.received.size() > before; }));
  }
  std::size_t received_from(PeerId peer) { return events_.received_from[peer]; }

  RecordingEvents events_;
  std::unique_ptr<Server> server_;
  std::vector<std::unique_ptr<RawClient>> crowd_;
};

std::string progress_frames(std::size_t count) {
  Encoder encoder;
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto frame = encoder.encode(Progress{from_ns<ExecTime>(static_cast<std::int64_t>(i))});
    bytes.append(reinterpret_cast<const char*>(frame.data()), frame.size());
  }
  return bytes;
}

// ---- Strangers

TEST_F(Attack, SilentStrangersDoNotKeepOthersOut) {
  listen(1h);
  crowd(3 * kMaxStrangers);
  const auto honest = connect();
  expect_served(*honest);
}

TEST_F(Attack, NoMoreStrangersAreLetInThanHaveAPlace) {
  listen(1h);
  crowd(kMaxStrangers + 10);
  ASSERT_TRUE(poll_until([&] { return events_.connected.size() == kMaxStrangers; }));
  // The rest is let in only after one of those has left.
  ASSERT_TRUE(poll_until([&] { return events_.connected.size() > kMaxStrangers; }));
  EXPECT_FALSE(events_.closed.empty());
}

TEST_F(Attack, AsManyAsHaveAPlaceAreNotHurried) {
  listen(1h);
  crowd(kMaxStrangers);
  ASSERT_TRUE(poll_until([&] { return events_.connected.size() == kMaxStrangers; }));
  EXPECT_FALSE(events_.poll(*server_, kCrowdedStay + 50ms));
  EXPECT_TRUE(events_.closed.empty());
}

TEST_F(Attack, WhoComesAfterAnotherIsLetInByTheNextPoll) {
  listen(1h);
  for (std::size_t count = 1; count <= 3; ++count) {
    crowd(1);
    EXPECT_TRUE(events_.poll(*server_, 10s));
    ASSERT_EQ(events_.connected.size(), count);
    while (events_.poll(*server_, Duration(0))) continue;
  }
}

TEST_F(Attack, WhoWasGreetedTakesNoStrangersPlace) {
  listen(1h);
  crowd(kMaxStrangers);
  for (auto& client : crowd_) client->write(Progress{});
  ASSERT_TRUE(poll_until([&] { return events_.received.size() == kMaxStrangers; }));
  const auto silent = connect();
  expect_served(*connect());
  expect_served(*crowd_.front());
}

/// Refused peers that do not leave would take up the places of others for as long as they may
/// drain.
TEST_F(Attack, RefusedPeersThatStayDoNotKeepOthersOut) {
  listen(1h);
  events_.react = [this](PeerId peer, const Message& message) {
    if (!std::holds_alternative<Hello>(message)) return;
    server_->send(peer, Refusal{Refusal::Reason::kToken, "wrong token"});
    server_->close(peer);
  };
  crowd(2 * kMaxStrangers);
  for (auto& client : crowd_) client->write(Hello{});
  const auto honest = connect();
  honest->write(Progress{});
  ASSERT_TRUE(poll_until([&] {
    return std::holds_alternative<Progress>(
        events_.received.empty() ? Message{Hello{}} : events_.received.back().message);
  }));
}

TEST_F(Attack, DrippingBytesDoNotMoveTheDeadline) {
  listen(30ms);
  const auto slow = connect();
  const std::string frame = progress_frames(1);
  std::size_t dripped = 0;
  const auto begin = std::chrono::steady_clock::now();
  while (events_.closed.empty() && dripped + 1 < frame.size()) {
    slow->write(frame.substr(dripped++, 1));
    events_.poll(*server_, 5ms);
  }
  ASSERT_TRUE(poll_until([&] { return !events_.closed.empty(); }));
  EXPECT_EQ(events_.closed[0].failure.kind, Failure::Kind::kTimeout);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 30ms);
  EXPECT_TRUE(events_.received.empty());
}

TEST_F(Attack, AStrangersFrameIsNoLongerThanAHello) {
  listen();
  const auto stranger = connect();
  stranger->write(Annotation{ExecTime{}, "topic", "{\"x\": \"" + std::string(5000, 'x') + "\"}"});
  ASSERT_TRUE(poll_until([&] { return !events_.closed.empty(); }));
  EXPECT_NE(events_.closed[0].failure.message.find("at most 4096"), std::string::npos)
      << events_.closed[0].failure.message;
}

TEST_F(Attack, TheLongestHelloFitsAndLongerFramesMayFollow) {
  listen();
  const std::string longest(kMaxNameBytes, 'x');
  const auto client = connect();
  client->write(Hello{.sut = longest, .uav = longest, .token = longest});
  client->write(Annotation{ExecTime{}, "topic", "{\"x\": \"" + std::string(500'000, 'x') + "\"}"});
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
  expect_served(*connect());
  ASSERT_TRUE(poll_until([&] { return events_.closed.size() == events_.connected.size(); }));
}

// ---- Floods

TEST_F(Attack, AFloodIsHandledInPartsAndOthersBetweenThem) {
  listen();
  const auto flooding = connect(), honest = connect();
  expect_served(*flooding);
  expect_served(*honest);
  constexpr std::size_t kFlood = 100'000;
  std::thread flood([&] { flooding->write(progress_frames(kFlood)); });
  ASSERT_TRUE(poll_until([&] { return received_from(1) > 1000; }));
  honest->write(Progress{});
  // Not before the others is a peer looked out for again more than 16 times.
  for (int i = 0; i < 20 && received_from(2) == 1; ++i) events_.poll(*server_, 1ms);
  EXPECT_EQ(received_from(2), 2u);
  EXPECT_LT(received_from(1), kFlood);
  ASSERT_TRUE(poll_until([&] { return received_from(1) == kFlood + 1; }));
  flood.join();
}

TEST_F(Attack, OnePollHandlesABoundedPartOfAFlood) {
  listen();
  const auto flooding = connect();
  expect_served(*flooding);
  const std::string frames = progress_frames(100'000);
  std::thread flood([&] { flooding->write(frames); });
  std::size_t most = 0, before = events_.received.size();
  EXPECT_TRUE(poll_until([&] {
    most = std::max(most, events_.received.size() - before);
    before = events_.received.size();
    return before == 100'001;
  }));
  flood.join();
  const std::size_t frame_bytes = frames.size() / 100'000;
  EXPECT_LE(most * frame_bytes, kMaxRequestBytes + kMaxHelloBytes);
}

TEST_F(Attack, SmallFramesThatNobodyReadsAreCountedToo) {
  listen();
  const auto stuck = connect();
  expect_served(*stuck);
  constexpr int kFrames = 500'000;  // more than socket buffers take
  int sent = 0;
  while (events_.closed.empty() && sent++ < kFrames) {
    server_->send(1, Reply{1, ExecTime{}, std::nullopt});
    if (sent % 1000 == 0) events_.poll(*server_, Duration(0));
  }
  ASSERT_FALSE(events_.closed.empty());
  EXPECT_NE(events_.closed[0].failure.message.find("does not read"), std::string::npos);
  EXPECT_NE(events_.closed[0].failure.message.find(" in 1024 frames"), std::string::npos)
      << events_.closed[0].failure.message;
}

TEST_F(Attack, TheDestructorWaitsForNoOneThatSendsOn) {
  listen();
  const auto flooding = connect();
  expect_served(*flooding);
  const std::string frames = progress_frames(1000);
  std::atomic<bool> over = false;
  std::thread flood([&] {
    while (!over) flooding->write(frames);
  });
  ASSERT_TRUE(poll_until([&] { return received_from(1) > 1000; }));
  server_.reset();
  over = true;
  flood.join();
}

// ---- Out of descriptors

TEST_F(Attack, WithoutDescriptorsThoseInsideAreServedAndOthersLater) {
  listen();
  const auto inside = connect();
  expect_served(*inside);
  const auto outside = connect();
  {
    const NoMoreHandles none;
    expect_served(*inside);
    // Nobody can be let in; that must not keep the loop turning.
    int turns = 0;
    const auto end = std::chrono::steady_clock::now() + 50ms;
    for (; std::chrono::steady_clock::now() < end; ++turns) events_.poll(*server_, 50ms);
    EXPECT_LT(turns, 10);
    EXPECT_EQ(events_.connected.size(), 1u);
  }
  expect_served(*outside);
}

}  // namespace
}  // namespace tether::link
