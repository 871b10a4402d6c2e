#include "recording_events.h"

#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include <tether/link_testing/memory_channel.h>

namespace tether::link_testing {
namespace {

using namespace std::chrono_literals;
using link::Progress;
using link::RecordingEvents;
using link::Refusal;
using link::Welcome;

TEST(MemoryServer, CarriesMessagesBothWays) {
  RecordingEvents events;
  MemoryServer server;
  EXPECT_FALSE(events.poll(server, Duration(0)));
  auto channel = server.connect();
  ASSERT_TRUE(channel->send(Progress{from_ns<ExecTime>(5)}).ok());
  EXPECT_TRUE(events.poll(server, Duration(0)));  // connected
  EXPECT_TRUE(events.poll(server, Duration(0)));  // the message
  ASSERT_EQ(events.received.size(), 1u);
  EXPECT_EQ(to_ns(std::get<Progress>(events.received[0].message).reached), 5);

  server.send(events.connected[0], Welcome{});
  EXPECT_TRUE(channel->receive().ok());
  const auto nothing = channel->receive_within(Duration(0));
  ASSERT_FALSE(nothing.ok());
  EXPECT_EQ(nothing.failure().kind, Failure::Kind::kTimeout);
}

TEST(MemoryServer, WhatWasSentBeforeClosingArrives) {
  RecordingEvents events;
  MemoryServer server;
  auto channel = server.connect();
  ASSERT_TRUE(channel->send(Progress{}).ok());
  channel.reset();
  while (events.poll(server, Duration(0))) {
  }
  EXPECT_EQ(events.received.size(), 1u);
  ASSERT_EQ(events.closed.size(), 1u);
  EXPECT_EQ(events.closed[0].peer, events.connected[0]);
  EXPECT_EQ(events.closed[0].failure.kind, Failure::Kind::kDisconnected);

  auto refused = server.connect();
  events.poll(server, Duration(0));
  server.send(2, Refusal{Refusal::Reason::kToken, "wrong token"});
  server.close(2);
  const auto refusal = refused->receive();
  ASSERT_TRUE(refusal.ok());
  EXPECT_EQ(std::get<Refusal>(*refusal).message, "wrong token");
  EXPECT_EQ(refused->receive().failure().kind, Failure::Kind::kDisconnected);
  EXPECT_FALSE(refused->send(Progress{}).ok());
  refused.reset();
  EXPECT_FALSE(events.poll(server, Duration(0)));
  EXPECT_EQ(events.closed.size(), 1u);
}

TEST(MemoryServer, ChannelsMayLiveInOtherThreadsAndOutliveIt) {
  RecordingEvents events;
  auto server = std::make_unique<MemoryServer>();
  events.react = [&](link::PeerId peer, const link::Message&) { server->send(peer, Welcome{}); };
  std::thread sut([channel = server->connect()] {
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(channel->send(Progress{}).ok());
      ASSERT_TRUE(channel->receive().ok());
    }
    EXPECT_EQ(channel->receive().failure().kind, Failure::Kind::kDisconnected);
  });
  EXPECT_TRUE(link::poll_until(*server, events, [&] { return events.received.size() == 100; }));
  server.reset();
  sut.join();
}

}  // namespace
}  // namespace tether::link_testing
