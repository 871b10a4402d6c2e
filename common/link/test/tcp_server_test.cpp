#include "server_fixture.h"

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::link {
namespace {

using namespace std::chrono_literals;

Reply image_reply(int side_px) {
  uav::CameraSample sample{SimTime{}, 0, side_px, side_px, {}};
  sample.rgb.resize(static_cast<std::size_t>(3 * side_px * side_px), 42);
  return {1, ExecTime{}, std::move(sample)};
}

class TcpServer : public ServerFixture {
 protected:
  /// The client receives a Refusal with the reason that the server reports.
  void expect_refused(RawClient& client, Failure::Kind kind) {
    ASSERT_TRUE(poll_until([&] { return !events_.closed.empty() && client.has_input(); }));
    const auto message = client.read_last_message();
    ASSERT_TRUE(message.ok()) << message.failure().message;
    const auto& refusal = std::get<Refusal>(*message);
    EXPECT_EQ(refusal.reason, Refusal::Reason::kBadMessage);
    ASSERT_EQ(events_.closed.size(), 1u);
    EXPECT_EQ(events_.closed[0].failure.kind, kind);
    EXPECT_EQ(events_.closed[0].failure.message, refusal.message);
  }
  /// What the client reads up to the end of the stream.
  Result<Message> read_while_polling(RawClient& client) {
    std::atomic<bool> read_all = false;
    std::thread pump([&] { poll_until([&] { return read_all.load(); }); });
    Result<Message> message = client.read_last_message();
    read_all = true;
    pump.join();
    return message;
  }
};

TEST_F(TcpServer, DeliversMessagesInOrderAndReportsTheEnd) {
  listen();
  EXPECT_FALSE(events_.poll(*server_, Duration(0)));
  {
    RawClient client = connect();
    for (std::int64_t i = 0; i < 100; ++i) client.write(Progress{from_ns<ExecTime>(i)});
    ASSERT_TRUE(poll_until([&] { return events_.received.size() == 100; }));
  }
  for (std::size_t i = 0; i < 100; ++i)
    EXPECT_EQ(to_ns(std::get<Progress>(events_.received[i].message).reached),
              static_cast<std::int64_t>(i));
  ASSERT_TRUE(wait_for_closed());
  EXPECT_EQ(events_.closed[0].failure.kind, Failure::Kind::kDisconnected);
  EXPECT_EQ(events_.closed[0].peer, events_.connected[0]);
}

TEST_F(TcpServer, RefusesBadInputAndServesOthers) {
  const std::string zero_length(4, '\0'), too_long("\x01\x00\x10\x00", 4);
  const std::string longer_than_a_hello("\x01\x80\x00\x00", 4);
  const std::string damaged = std::string("\x40\x00\x00\x00", 4) + std::string(64, '\x5a');
  const auto refuse = [this](const std::string& input, bool is_greeted) {
    SCOPED_TRACE(testing::PrintToString(input) + (is_greeted ? " of a greeted peer" : ""));
    listen();
    RawClient good = connect(), bad = connect();
    expect_served(good);
    if (is_greeted) expect_served(bad);
    const std::size_t before = events_.received.size();
    bad.write(input);
    expect_refused(bad, Failure::Kind::kProtocol);
    EXPECT_EQ(events_.received.size(), before);
    expect_served(good);
  };
  for (const bool is_greeted : {false, true}) {
    refuse("GET / HTTP/1.1\r\nHost: tether\r\n\r\n", is_greeted);
    refuse(zero_length + frame_bytes(Progress{}), is_greeted);
    refuse(too_long, is_greeted);
    refuse(damaged, is_greeted);
    refuse(frame_bytes(Progress{from_ns<ExecTime>(-5)}), is_greeted);
  }
  refuse(longer_than_a_hello, false);
}

TEST_F(TcpServer, CountsBytesOfLargeFramesInTransit) {
  listen();
  RawClient client = connect();
  expect_served(client);
  const auto moved = [&] { return server_->moved_bytes(events_.connected.at(0)); };
  EXPECT_EQ(moved(), 0u);
  server_->send(events_.connected.at(0), Due{1, {}});
  EXPECT_TRUE(poll_until([&] { return moved() > 0; })) << "acknowledged";

  const std::uint64_t before = moved();
  RawClient other = connect();
  const std::string small = frame_bytes(Progress{});
  const std::string large =
      frame_bytes(Annotation{{}, "x", "{\"x\": \"" + std::string(2000, 'x') + "\"}"});
  client.write(small.substr(0, 8));
  expect_served(other);
  EXPECT_EQ(moved(), before);
  client.write(small.substr(8) + large.substr(0, 1500));
  EXPECT_TRUE(poll_until([&] { return moved() == before + 1500; }));
  client.write(large.substr(1500));
  EXPECT_TRUE(poll_until([&] { return events_.received.size() == 4; }));
  EXPECT_EQ(moved(), before);
}

TEST_F(TcpServer, RefusesAPeerWithoutAWholeHelloInTime) {
  for (const std::string& part : {std::string(), std::string("\x40\x00", 2)}) {
    listen(20ms);
    RawClient greeted = connect();
    expect_served(greeted);
    RawClient slow = connect();
    slow.write(part);
    expect_refused(slow, Failure::Kind::kTimeout);
    expect_served(greeted);
  }
}

TEST_F(TcpServer, ClosesAPeerThatDoesNotRead) {
  // Images exceed the limit on bytes, small frames that on frames, whatever socket buffers take.
  for (const auto& [reply, count] :
       {std::pair{image_reply(2000), 6}, {Reply{1, ExecTime{}, std::nullopt}, 500'000}}) {
    listen();
    RawClient good = connect();
    expect_served(good);
    RawClient stuck = connect();
    expect_served(stuck);
    const PeerId peer = events_.received.back().peer;
    for (int i = 0; i < count && events_.closed.empty(); ++i) {
      server_->send(peer, reply);
      if (i % 1000 == 0) events_.poll(*server_, Duration(0));
    }
    ASSERT_TRUE(wait_for_closed());
    EXPECT_EQ(events_.closed[0].peer, peer);
    EXPECT_EQ(events_.closed[0].failure.kind, Failure::Kind::kDisconnected);
    expect_served(good);
  }
  EXPECT_THAT(events_.closed[0].failure.message, testing::HasSubstr(" 1024 "));
}

TEST_F(TcpServer, ReportsAPeerThatIsResetWhileFramesWaitForIt) {
  listen();
  RawClient client = connect();
  expect_served(client);
  for (int i = 0; i < 2; ++i) server_->send(1, image_reply(2000));
  client.close();
  ASSERT_TRUE(wait_for_closed());
  EXPECT_EQ(events_.closed[0].failure.kind, Failure::Kind::kDisconnected);
}

TEST_F(TcpServer, ReportsNothingOfAPeerThatWasClosedForItsMessage) {
  listen();
  RawClient client = connect();
  expect_served(client);
  events_.react = [this](PeerId peer, const Message&) { server_->close(peer); };
  client.write(frame_bytes(Progress{}) + frame_bytes(Progress{}));
  ASSERT_TRUE(poll_until([&] { return events_.received.size() == 2; }));
  EXPECT_FALSE(events_.poll(*server_, 1ms));
}

TEST_F(TcpServer, CloseAndDestructorSendQueuedFramesFirst) {
  const Reply reply = image_reply(1200);  // more than a socket takes at once
  listen();
  RawClient closed = connect();
  expect_served(closed);
  server_->send(1, reply);
  server_->close(1);
  EXPECT_TRUE(read_while_polling(closed).ok());
  EXPECT_TRUE(events_.closed.empty());

  RawClient left = connect();
  expect_served(left);
  server_->send(2, reply);
  std::thread end([this] { server_.reset(); });
  EXPECT_TRUE(left.read_last_message().ok());
  end.join();
}

class HalfClosed : public TcpServer {
 protected:
  /// Connects, closes the sending side, and waits until the server has seen it.
  RawClient half_closed() {
    listen();
    events_.keeps_half_closed = true;
    RawClient client = connect();
    expect_served(client);
    client.close_half();
    EXPECT_TRUE(poll_until([&] { return events_.half_closed == std::vector<PeerId>{1}; }));
    return client;
  }
};

TEST_F(HalfClosed, PeerCostsNothingAndCanReadUntilItIsClosed) {
  RawClient client = half_closed();
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(events_.poll(*server_, 5ms));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 15ms);
  EXPECT_EQ(events_.half_closed.size(), 1u);
  server_->send(1, image_reply(2000));
  server_->close(1);
  const auto message = read_while_polling(client);
  ASSERT_TRUE(message.ok()) << message.failure().message;
  EXPECT_TRUE(std::holds_alternative<Reply>(*message));
  EXPECT_TRUE(events_.closed.empty());
}

TEST_F(HalfClosed, PeerThatHangsUpIsForgotten) {
  RawClient client = half_closed();
  client.close();
  server_->send(1, Welcome{});  // is answered by a reset
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(events_.poll(*server_, 10s));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
  server_->send(1, Welcome{});
  server_->close(1);
  EXPECT_FALSE(events_.poll(*server_, 1ms));
  EXPECT_TRUE(events_.closed.empty());
}

TEST_F(HalfClosed, StrangersAndPeersThatAreNotKeptAreClosed) {
  for (const bool is_greeted : {false, true}) {
    listen();
    events_.keeps_half_closed = !is_greeted;
    RawClient client = connect();
    if (is_greeted) expect_served(client);
    client.close_half();
    ASSERT_TRUE(wait_for_closed());
    EXPECT_EQ(events_.closed[0].failure.kind, Failure::Kind::kDisconnected);
    EXPECT_TRUE(events_.half_closed.empty());
  }
}

TEST_F(TcpServer, IgnoresUnknownPeersAndForbidsInvalidMessages) {
  listen();
  server_->send(99, Welcome{});
  server_->close(99);
  RawClient client = connect();
  expect_served(client);
  thrown_error(ErrorCode::kInternal, [&] { server_->send(1, Progress{from_ns<ExecTime>(-1)}); });
}

TEST_F(TcpServer, RefusesAnAddressThatCannotBeBound) {
  listen();
  for (const Address& address : {server_->address(), Address{"203.0.113.1", 0}}) {
    const Error error = thrown_error(ErrorCode::kSetup, [&] { listen_tcp(address, 1s); });
    EXPECT_EQ(error.subject(), to_string(address));
  }
}

TEST_F(TcpServer, ListensOnIPv6) {
  try {
    server_ = listen_tcp({"::1", 0}, 10s);
  } catch (const Error&) {
    GTEST_SKIP() << "no IPv6 on this machine";
  }
  const auto parsed = parse_address(to_string(server_->address()));
  EXPECT_EQ(parsed->host, "::1");
  auto channel = connect_tcp(*parsed, 10s).value();
  ASSERT_TRUE(channel->send(Progress{}).ok());
  EXPECT_TRUE(poll_until([&] { return events_.received.size() == 1; }));
}

}  // namespace
}  // namespace tether::link
