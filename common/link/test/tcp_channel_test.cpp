#include "server_fixture.h"

#include <memory>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <sys/socket.h>

#include <tether/link/socket.h>

namespace tether::link {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// A channel that is connected to the server.
class TcpChannel : public ServerFixture {
 protected:
  TcpChannel() {
    listen();
    channel_ = connect_tcp(server_->address(), 10s).value();
  }

  std::unique_ptr<Channel> channel_;
};

TEST(ConnectTcp, FailsWithTheAddress) {
  const Address closed = listen_tcp({"127.0.0.1", 0}, 10s)->address();
  for (const Address& address : {closed, Address{"no-such-host.invalid", 5200}}) {
    const auto channel = connect_tcp(address, 10s);
    ASSERT_FALSE(channel.ok());
    EXPECT_EQ(channel.failure().kind, Failure::Kind::kDisconnected);
    EXPECT_THAT(channel.failure().message, HasSubstr(to_string(address)));
  }
}

TEST(ConnectTcp, TimesOut) {
  // With its backlog full, a listener ignores further connections, as an unreachable host would.
  const Descriptor listener = listen_on_tcp({"127.0.0.1", 0}).value();
  ::listen(listener.get(), 0);
  std::vector<std::unique_ptr<Channel>> fill;
  for (int i = 0; i < 10; ++i) {
    auto channel = connect_tcp(local_address(listener.get()), 20ms);
    if (!channel) {
      EXPECT_EQ(channel.failure().kind, Failure::Kind::kTimeout);
      return;
    }
    fill.push_back(std::move(channel).value());
  }
  FAIL() << "the backlog never filled";
}

TEST_F(TcpChannel, TriesTheAddressesOfAName) {
  // Where the name has an IPv6 address as well, nobody listens there, and the next one answers.
  const auto channel = connect_tcp({"localhost", server_->address().port}, 10s);
  ASSERT_TRUE(channel.ok()) << channel.failure().message;
  EXPECT_TRUE(poll_until([&] { return events_.connected.size() == 2; }));
}

TEST_F(TcpChannel, CanReceiveAfterATimeout) {
  const auto nothing = channel_->receive_within(1ms);
  ASSERT_FALSE(nothing.ok());
  EXPECT_EQ(nothing.failure().kind, Failure::Kind::kTimeout);
  ASSERT_TRUE(poll_until([&] { return events_.connected.size() == 1; }));
  server_->send(1, Welcome{});
  EXPECT_TRUE(channel_->receive_within(10s).ok());
}

TEST_F(TcpChannel, ReceivesWhatWasSentBeforeTheEnd) {
  ASSERT_TRUE(poll_until([&] { return events_.connected.size() == 1; }));
  // Input that the server never reads must not make the end a reset, which would discard this.
  ASSERT_TRUE(channel_->send(Progress{}).ok());
  server_->send(1, Refusal{Refusal::Reason::kRunEnded, "time limit"});
  server_.reset();
  const auto refusal = channel_->receive();
  ASSERT_TRUE(refusal.ok()) << refusal.failure().message;
  EXPECT_EQ(std::get<Refusal>(*refusal).message, "time limit");
  EXPECT_EQ(channel_->receive().failure().kind, Failure::Kind::kDisconnected);
}

TEST(SlowMessage, IsReportedWhileItArrives) {
  const std::string frame = frame_bytes(Refusal{Refusal::Reason::kRunEnded, "time limit"});
  const Descriptor listener = listen_on_tcp({"127.0.0.1", 0}).value();
  const auto channel = connect_tcp(local_address(listener.get()), 10s).value();
  const Accepted accepted = accept_tcp(listener.get());
  const int other = accepted.socket.get();
  const std::jthread receiver([&] { EXPECT_TRUE(channel->receive().ok()); });
  ASSERT_EQ(::send(other, frame.data(), 10, 0), 10);
  FrameBuffer input(kMaxRequestBytes);
  ASSERT_TRUE(wait_readable(other, 10s));
  input.commit(receive_some(other, input.space()).bytes);
  const auto progress = decode(*input.next());
  EXPECT_EQ(std::get<Progress>(*progress).received_bytes, 10u);
  ::send(other, frame.data() + 10, frame.size() - 10, 0);
}

TEST_F(TcpChannel, CloseUnblocksReceive) {
  std::thread closer([&] { channel_->close(); });
  const auto message = channel_->receive();
  closer.join();
  ASSERT_FALSE(message.ok());
  EXPECT_EQ(message.failure().kind, Failure::Kind::kDisconnected);
  EXPECT_FALSE(channel_->send(Progress{}).ok());
}

TEST_F(TcpChannel, RefusesToSendInvalidMessages) {
  const Status sent = channel_->send(Annotation{ExecTime{}, "roi", "not json"});
  ASSERT_FALSE(sent.ok());
  EXPECT_EQ(sent.failure().kind, Failure::Kind::kInvalid);
}

TEST_F(TcpChannel, ManyThreadsSendWholeFrames) {
  std::vector<std::jthread> senders;
  for (int t = 0; t < 4; ++t) {
    senders.emplace_back([this] {
      for (int i = 0; i < 500; ++i)
        ASSERT_TRUE(channel_->send(Annotation{ExecTime{}, "topic", "{\"a\": 1}"}).ok());
    });
  }
  EXPECT_TRUE(poll_until([&] { return events_.received.size() == 2000; }));
  EXPECT_TRUE(events_.closed.empty());
}

TEST_F(TcpChannel, LargeImagesArriveIntact) {
  uav::CameraSample sample{from_ns<SimTime>(1), 2, 1000, 700, {}};
  sample.rgb.resize(2'100'000);
  for (std::size_t i = 0; i < sample.rgb.size(); ++i)
    sample.rgb[i] = static_cast<std::uint8_t>(i * 7 >> 3);
  events_.react = [&](PeerId peer, const Message&) {
    for (const std::uint64_t sequence : {1u, 2u})
      server_->send(peer, Reply{sequence, ExecTime{}, sample});
  };
  std::jthread sut([&] {
    ASSERT_TRUE(channel_->send(Progress{}).ok());
    for (const std::uint64_t sequence : {1u, 2u}) {
      const auto message = channel_->receive();
      ASSERT_TRUE(message.ok());
      const auto& reply = std::get<Reply>(*message);
      EXPECT_EQ(reply.sequence, sequence);
      EXPECT_EQ(std::get<uav::CameraSample>(*reply.sample).rgb, sample.rgb);
    }
    channel_.reset();
  });
  EXPECT_TRUE(wait_for_closed());
}

}  // namespace
}  // namespace tether::link
