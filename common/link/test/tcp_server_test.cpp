#include "raw_client.h"
#include "recording_events.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/link/server.h>

namespace tether::link {
namespace {

using namespace std::chrono_literals;

const Hello kHello{1, "sut", "", ClockKind::kWall, 1.0, "token"};

Reply image_reply(int side_px, std::uint64_t sequence = 1) {
  uav::CameraSample sample{SimTime{}, 0, side_px, side_px, {}};
  sample.rgb.resize(static_cast<std::size_t>(3 * side_px * side_px), 42);
  return {sequence, ExecTime{}, std::move(sample)};
}

class TcpServer : public testing::Test {
 protected:
  void listen(Duration hello_timeout = 10s) {
    server_ = listen_tcp({"127.0.0.1", 0}, hello_timeout);
  }
  RawClient connect() { return RawClient(server_->address()); }
  bool poll_until(const std::function<bool()>& done) {
    return link::poll_until(*server_, events_, done);
  }

  /// One peer that is welcome, to see that others' misdeeds do it no harm.
  void expect_served(RawClient& client) {
    const std::size_t before = events_.received.size();
    client.write(Progress{from_ns<ExecTime>(7)});
    ASSERT_TRUE(poll_until([&] { return events_.received.size() == before + 1; }));
  }
  /// The client is told why, and the server hears of its end.
  void expect_refused(RawClient& client, const std::string& text, Failure::Kind kind) {
    ASSERT_TRUE(poll_until([&] { return !events_.closed.empty() && client.has_input(); }));
    const auto message = client.read_last_message();
    ASSERT_TRUE(message.ok()) << message.failure().message;
    const auto& refusal = std::get<Refusal>(*message);
    EXPECT_EQ(refusal.reason, Refusal::Reason::kBadMessage);
    EXPECT_NE(refusal.message.find(text), std::string::npos) << refusal.message;
    ASSERT_EQ(events_.closed.size(), 1u);
    EXPECT_EQ(events_.closed[0].failure.kind, kind);
    EXPECT_NE(events_.closed[0].failure.message.find(text), std::string::npos);
  }
  /// What the client reads up to the end of the stream.
  Result<Message> read_while_polling(RawClient& client) {
    std::atomic<bool> read_all = false;
    std::thread pump([&] { link::poll_until(*server_, events_, [&] { return read_all.load(); }); });
    Result<Message> message = client.read_last_message();
    read_all = true;
    pump.join();
    return message;
  }

  RecordingEvents events_;
  std::unique_ptr<Server> server_;
};

TEST_F(TcpServer, TakesAFreePortOnLoopback) {
  listen();
  EXPECT_EQ(server_->address().host, "127.0.0.1");
  EXPECT_NE(server_->address().port, 0);
}

TEST_F(TcpServer, PollReturnsAtOnceWhenNothingIsThere) {
  listen();
  EXPECT_FALSE(events_.poll(*server_, Duration(0)));
}

TEST_F(TcpServer, DeliversMessagesInOrderAndReportsTheEnd) {
  listen();
  {
    RawClient client = connect();
    client.write(kHello);
    for (std::int64_t i = 0; i < 100; ++i) client.write(Progress{from_ns<ExecTime>(i)});
    ASSERT_TRUE(poll_until([&] { return events_.received.size() == 101; }));
  }
  for (std::size_t i = 0; i < 100; ++i) {
    const auto& progress = std::get<Progress>(events_.received[i + 1].message);
    EXPECT_EQ(to_ns(progress.reached), static_cast<std::int64_t>(i));
  }
  ASSERT_TRUE(poll_until([&] { return !events_.closed.empty(); }));
  EXPECT_EQ(events_.closed[0].failure.kind, Failure::Kind::kDisconnected);
  EXPECT_EQ(events_.closed[0].peer, events_.connected[0]);
}

TEST_F(TcpServer, RepliesFromWithinOnMessage) {
  listen();
  events_.react = [this](PeerId peer, const Message&) { server_->send(peer, Welcome{}); };
  auto channel = connect_tcp(server_->address(), 10s).value();
  ASSERT_TRUE(channel->send(kHello).ok());
  ASSERT_TRUE(poll_until([&] { return events_.received.size() == 1; }));
  const auto reply = channel->receive();
  ASSERT_TRUE(reply.ok());
  EXPECT_TRUE(std::holds_alternative<Welcome>(*reply));
}

TEST_F(TcpServer, RefusesGarbage) {
  listen();
  RawClient good = connect();
  RawClient bad = connect();
  expect_served(good);
  bad.write("GET / HTTP/1.1\r\nHost: tether\r\n\r\n");
  expect_refused(bad, "is the peer a Tether program?", Failure::Kind::kProtocol);
  expect_served(good);
}

TEST_F(TcpServer, RefusesAnOversizedLengthAtOnce) {
  listen();
  RawClient good = connect();
  RawClient bad = connect();
  expect_served(good);
  expect_served(bad);
  bad.write(std::string("\x00\x00\x20\x00", 4));
  expect_refused(bad, "frame of 2097152 bytes announced, at most 1048576",
                 Failure::Kind::kProtocol);
  expect_served(good);
}

TEST_F(TcpServer, RefusesLengthZero) {
  listen();
  RawClient bad = connect();
  bad.write(std::string(4, '\0'));
  expect_refused(bad, "length 0", Failure::Kind::kProtocol);
}

TEST_F(TcpServer, RefusesADamagedFrame) {
  listen();
  RawClient good = connect();
  RawClient bad = connect();
  expect_served(good);
  std::string frame(68, '\x5a');
  frame.replace(0, 4, std::string("\x40\x00\x00\x00", 4));
  bad.write(frame);
  expect_refused(bad, "not a Tether message, or damaged", Failure::Kind::kProtocol);
  expect_served(good);
}

TEST_F(TcpServer, RefusesBadValues) {
  listen();
  RawClient bad = connect();
  bad.write(Progress{from_ns<ExecTime>(-5)});
  expect_refused(bad, "reached is negative", Failure::Kind::kProtocol);
}

TEST_F(TcpServer, HandlesNothingAfterABadFrame) {
  listen();
  RawClient bad = connect();
  bad.write(std::string(4, '\0'));
  bad.write(Progress{});
  expect_refused(bad, "length 0", Failure::Kind::kProtocol);
  EXPECT_TRUE(events_.received.empty());
}

TEST_F(TcpServer, RefusesAPeerThatNeverSpeaks) {
  listen(20ms);
  RawClient silent = connect();
  expect_refused(silent, "no whole Hello came", Failure::Kind::kTimeout);
}

TEST_F(TcpServer, APartOfAHelloIsNoHello) {
  listen(20ms);
  RawClient slow = connect();
  slow.write(std::string("\x40\x00", 2));
  expect_refused(slow, "no whole Hello came", Failure::Kind::kTimeout);
}

TEST_F(TcpServer, AGreetedPeerMayBeSilent) {
  listen(20ms);
  RawClient client = connect();
  expect_served(client);
  RawClient silent = connect();
  expect_refused(silent, "no whole Hello came", Failure::Kind::kTimeout);
  expect_served(client);
}

TEST_F(TcpServer, ClosesAPeerThatDoesNotRead) {
  listen();
  RawClient good = connect();
  expect_served(good);
  RawClient stuck = connect();
  expect_served(stuck);
  const PeerId peer = events_.received.back().peer;
  // 12 MB each: the bound is passed while nobody reads, whatever the socket buffers take.
  for (int i = 0; i < 6; ++i) server_->send(peer, image_reply(2000));
  ASSERT_TRUE(poll_until([&] { return !events_.closed.empty(); }));
  EXPECT_EQ(events_.closed[0].peer, peer);
  EXPECT_EQ(events_.closed[0].failure.kind, Failure::Kind::kDisconnected);
  EXPECT_NE(events_.closed[0].failure.message.find("does not read"), std::string::npos);
  expect_served(good);
}

TEST_F(TcpServer, ReportsAPeerThatIsResetWhileFramesWaitForIt) {
  listen();
  RawClient client = connect();
  expect_served(client);
  for (int i = 0; i < 2; ++i) server_->send(1, image_reply(2000));
  client.close();
  ASSERT_TRUE(poll_until([&] { return events_.closed.size() == 1; }));
  EXPECT_EQ(events_.closed[0].failure.kind, Failure::Kind::kDisconnected);
}

TEST_F(TcpServer, ReportsNothingOfAPeerThatWasClosedForItsMessage) {
  listen();
  RawClient client = connect();
  expect_served(client);
  events_.react = [this](PeerId peer, const Message&) { server_->close(peer); };
  Encoder encoder;
  const auto frame = encoder.encode(Progress{});
  client.write(std::string(frame.begin(), frame.end()) + std::string(frame.begin(), frame.end()));
  ASSERT_TRUE(poll_until([&] { return events_.received.size() == 2; }));
  EXPECT_FALSE(events_.poll(*server_, 1ms));
}

TEST_F(TcpServer, CloseSendsWhatIsQueuedFirst) {
  listen();
  RawClient client = connect();
  expect_served(client);
  server_->send(1, image_reply(2000));
  server_->close(1);
  const auto message = read_while_polling(client);
  client.close();
  ASSERT_TRUE(message.ok()) << message.failure().message;
  EXPECT_EQ(std::get<uav::CameraSample>(*std::get<Reply>(*message).sample).rgb.size(), 12'000'000u);
  EXPECT_TRUE(events_.closed.empty());
}

class HalfClosed : public TcpServer {
 protected:
  /// Until the server, which keeps it, has seen the end of its input.
  void half_close(RawClient& client) {
    events_.keeps_half_closed = true;
    expect_served(client);
    client.close_half();
    EXPECT_TRUE(poll_until([&] { return events_.half_closed == std::vector<PeerId>{1}; }));
  }
};

TEST_F(HalfClosed, APeerReadsWhatItIsSentUpToTheClose) {
  listen();
  RawClient client = connect();
  half_close(client);
  server_->send(1, image_reply(2000));  // more than a socket takes at once
  server_->close(1);
  const auto message = read_while_polling(client);
  ASSERT_TRUE(message.ok()) << message.failure().message;
  EXPECT_TRUE(std::holds_alternative<Reply>(*message));
  EXPECT_TRUE(events_.closed.empty());
}

TEST_F(HalfClosed, APeerCostsNothingWhileItIsKept) {
  listen();
  RawClient client = connect();
  half_close(client);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(events_.poll(*server_, 5ms));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 15ms);
  EXPECT_EQ(events_.half_closed.size(), 1u);
}

TEST_F(HalfClosed, APeerThatHangsUpIsForgotten) {
  listen();
  RawClient client = connect();
  half_close(client);
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

TEST_F(HalfClosed, APeerThatNobodyKeepsIsClosed) {
  listen();
  RawClient client = connect();
  expect_served(client);
  client.close_half();
  ASSERT_TRUE(poll_until([&] { return events_.closed.size() == 1; }));
  EXPECT_NE(events_.closed[0].failure.message.find("closed the connection"), std::string::npos);
}

TEST_F(HalfClosed, AStrangerIsNotKept) {
  listen();
  events_.keeps_half_closed = true;
  RawClient client = connect();
  client.close_half();
  ASSERT_TRUE(poll_until([&] { return events_.closed.size() == 1; }));
  EXPECT_TRUE(events_.half_closed.empty());
}

TEST_F(TcpServer, TheDestructorSendsWhatIsQueued) {
  listen();
  RawClient client = connect();
  expect_served(client);
  server_->send(1, image_reply(1000));
  std::thread end([this] { server_.reset(); });
  const auto message = client.read_last_message();
  end.join();
  EXPECT_TRUE(message.ok());
}

TEST_F(TcpServer, IgnoresUnknownPeersAndForbidsInvalidMessages) {
  listen();
  server_->send(99, Welcome{});
  server_->close(99);
  RawClient client = connect();
  expect_served(client);
  EXPECT_THROW(server_->send(1, Progress{from_ns<ExecTime>(-1)}), Error);
}

TEST_F(TcpServer, SaysWhatCannotBeBound) {
  listen();
  try {
    listen_tcp(server_->address(), 1s);
    FAIL() << "bound twice";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kSetup);
    EXPECT_NE(std::string(error.what()).find(to_string(server_->address())), std::string::npos);
  }
  EXPECT_THROW(listen_tcp({"203.0.113.1", 0}, 1s), Error);
}

TEST_F(TcpServer, ListensOnIPv6) {
  RecordingEvents events;
  std::unique_ptr<Server> server;
  try {
    server = listen_tcp({"::1", 0}, 10s);
  } catch (const Error&) {
    GTEST_SKIP() << "no IPv6 on this machine";
  }
  EXPECT_EQ(to_string(server->address()).rfind("[::1]:", 0), 0u);
  const auto parsed = parse_address(to_string(server->address()));
  auto channel = connect_tcp(*parsed, 10s).value();
  ASSERT_TRUE(channel->send(kHello).ok());
  EXPECT_TRUE(link::poll_until(*server, events, [&] { return events.received.size() == 1; }));
}

}  // namespace
}  // namespace tether::link
