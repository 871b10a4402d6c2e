#include "recording_events.h"

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <tether/link/channel.h>
#include <tether/link/socket.h>

namespace tether::link {
namespace {

using namespace std::chrono_literals;

/// A listening socket that accepts nobody unless told to.
struct Listener {
  explicit Listener(int backlog) { ::listen(socket.get(), backlog); }
  Address address() const { return local_address(socket.get()); }
  Descriptor socket = listen_on_tcp({"127.0.0.1", 0}).value();
};

TEST(TcpChannel, SaysWhereNobodyListens) {
  Listener listener(1);
  const Address address = listener.address();
  listener.socket = Descriptor();
  const auto channel = connect_tcp(address, 10s);
  ASSERT_FALSE(channel.ok());
  EXPECT_EQ(channel.failure().kind, Failure::Kind::kDisconnected);
  EXPECT_NE(channel.failure().message.find(to_string(address)), std::string::npos);
  EXPECT_NE(channel.failure().message.find("is the coordinator running"), std::string::npos);
}

TEST(TcpChannel, SaysWhichNameIsUnknown) {
  const auto channel = connect_tcp({"no-such-host.invalid", 5200}, 10s);
  ASSERT_FALSE(channel.ok());
  EXPECT_NE(channel.failure().message.find("no-such-host.invalid:5200"), std::string::npos);
}

TEST(TcpChannel, ConnectingTimesOut) {
  // With its backlog full, a listener ignores further connections, as an unreachable host would.
  Listener listener(0);
  std::vector<std::unique_ptr<Channel>> fill;
  for (int i = 0; i < 10; ++i) {
    auto channel = connect_tcp(listener.address(), 20ms);
    if (channel.ok()) {
      fill.push_back(std::move(channel).value());
      continue;
    }
    EXPECT_EQ(channel.failure().kind, Failure::Kind::kTimeout);
    EXPECT_NE(channel.failure().message.find("no answer"), std::string::npos);
    return;
  }
  FAIL() << "the backlog never filled";
}

TEST(TcpChannel, TriesTheAddressesOfAName) {
  // Where the name has an IPv6 address as well, nobody listens there, and the next one answers.
  RecordingEvents events;
  auto server = listen_tcp({"127.0.0.1", 0}, 10s);
  const auto channel = connect_tcp({"localhost", server->address().port}, 10s);
  ASSERT_TRUE(channel.ok()) << channel.failure().message;
  EXPECT_TRUE(poll_until(*server, events, [&] { return events.connected.size() == 1; }));
}

TEST(TcpChannel, ReceivingTimesOutAndGoesOn) {
  RecordingEvents events;
  auto server = listen_tcp({"127.0.0.1", 0}, 10s);
  auto channel = connect_tcp(server->address(), 10s).value();
  const auto nothing = channel->receive_within(1ms);
  ASSERT_FALSE(nothing.ok());
  EXPECT_EQ(nothing.failure().kind, Failure::Kind::kTimeout);

  ASSERT_TRUE(poll_until(*server, events, [&] { return events.connected.size() == 1; }));
  server->send(1, Welcome{});
  EXPECT_TRUE(channel->receive_within(10s).ok());
}

TEST(TcpChannel, DeliversWhatCameBeforeTheEnd) {
  RecordingEvents events;
  auto server = listen_tcp({"127.0.0.1", 0}, 10s);
  auto channel = connect_tcp(server->address(), 10s).value();
  ASSERT_TRUE(poll_until(*server, events, [&] { return events.connected.size() == 1; }));
  // Input that the server never reads must not turn its last word into a reset.
  ASSERT_TRUE(channel->send(Progress{}).ok());
  server->send(1, Refusal{Refusal::Reason::kRunEnded, "time limit"});
  server.reset();
  const auto refusal = channel->receive();
  ASSERT_TRUE(refusal.ok()) << refusal.failure().message;
  EXPECT_EQ(std::get<Refusal>(*refusal).message, "time limit");
  const auto end = channel->receive();
  ASSERT_FALSE(end.ok());
  EXPECT_EQ(end.failure().kind, Failure::Kind::kDisconnected);
}

TEST(TcpChannel, CloseUnblocksReceive) {
  RecordingEvents events;
  auto server = listen_tcp({"127.0.0.1", 0}, 10s);
  auto channel = connect_tcp(server->address(), 10s).value();
  std::thread closer([&] { channel->close(); });
  const auto message = channel->receive();
  closer.join();
  ASSERT_FALSE(message.ok());
  EXPECT_EQ(message.failure().kind, Failure::Kind::kDisconnected);
  EXPECT_FALSE(channel->send(Progress{}).ok());
}

TEST(TcpChannel, RefusesToSendInvalidMessages) {
  RecordingEvents events;
  auto server = listen_tcp({"127.0.0.1", 0}, 10s);
  auto channel = connect_tcp(server->address(), 10s).value();
  const Status sent = channel->send(Annotation{ExecTime{}, "roi", "not json"});
  ASSERT_FALSE(sent.ok());
  EXPECT_EQ(sent.failure().kind, Failure::Kind::kInvalid);
}

TEST(TcpChannel, ManyThreadsSendWholeFrames) {
  RecordingEvents events;
  auto server = listen_tcp({"127.0.0.1", 0}, 10s);
  auto channel = connect_tcp(server->address(), 10s).value();
  std::vector<std::thread> senders;
  for (int t = 0; t < 4; ++t) {
    senders.emplace_back([&channel] {
      for (int i = 0; i < 500; ++i) {
        ASSERT_TRUE(channel->send(Annotation{ExecTime{}, "topic", "{\"a\": 1}"}).ok());
      }
    });
  }
  EXPECT_TRUE(poll_until(*server, events, [&] { return events.received.size() == 2000; }));
  for (auto& sender : senders) sender.join();
  EXPECT_TRUE(events.closed.empty());
}

TEST(TcpChannel, LargeImagesArriveIntact) {
  RecordingEvents events;
  auto server = listen_tcp({"127.0.0.1", 0}, 10s);
  uav::CameraSample sample{from_ns<SimTime>(1), 2, 1000, 700, {}};
  sample.rgb.resize(2'100'000);
  for (std::size_t i = 0; i < sample.rgb.size(); ++i)
    sample.rgb[i] = static_cast<std::uint8_t>(i * 7 >> 3);
  int sent = 0;
  events.react = [&](PeerId peer, const Message&) {
    server->send(peer, Reply{1, ExecTime{}, sample});
    server->send(peer, Reply{2, ExecTime{}, sample});
    ++sent;
  };
  std::thread sut([&, address = server->address()] {
    auto channel = connect_tcp(address, 10s).value();
    ASSERT_TRUE(channel->send(Progress{}).ok());
    for (std::uint64_t sequence = 1; sequence <= 2; ++sequence) {
      const auto message = channel->receive();
      ASSERT_TRUE(message.ok());
      const auto& reply = std::get<Reply>(*message);
      EXPECT_EQ(reply.sequence, sequence);
      EXPECT_EQ(std::get<uav::CameraSample>(*reply.sample).rgb, sample.rgb);
    }
  });
  EXPECT_TRUE(poll_until(*server, events, [&] { return sent == 1 && !events.closed.empty(); }));
  sut.join();
}

}  // namespace
}  // namespace tether::link
