#include "recording_events.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include <tether/link_testing/throttling_proxy.h>

namespace tether::link_testing {
namespace {

using namespace std::chrono_literals;

TEST(WireSchedule, DelayOnly) {
  WireSchedule schedule({20ms, 0.0});
  EXPECT_EQ(schedule.arrival(0ms, 1000), 20ms);
  EXPECT_EQ(schedule.arrival(0ms, 1'000'000), 20ms);
  EXPECT_EQ(schedule.arrival(5ms, 1), 25ms);
}

TEST(WireSchedule, BytesLeaveOneAfterAnother) {
  WireSchedule schedule({10ms, 1e6});  // 1 MB/s: 1 ms per 1000 bytes
  EXPECT_EQ(schedule.arrival(0ms, 1000), 11ms);
  EXPECT_EQ(schedule.arrival(0ms, 2000), 13ms);
  EXPECT_EQ(schedule.arrival(2ms, 1000), 14ms);
  EXPECT_EQ(schedule.arrival(100ms, 1000), 111ms);  // idle meanwhile
}

/// A small request, an image in return, over a wire of 3 ms and 100 MB/s: nothing is lost, and it
/// takes its time.
TEST(ThrottlingProxy, DelaysAndThrottlesBothWays) {
  link::RecordingEvents events;
  auto server = link::listen_tcp({"127.0.0.1", 0}, 10s);
  ThrottlingProxy proxy({"127.0.0.1", 0}, server->address(), {3ms, 100e6});
  const std::vector<std::uint8_t> rgb(600'000, 9);
  events.react = [&](link::PeerId peer, const link::Message&) {
    server->send(peer, link::Reply{1, ExecTime{}, uav::CameraSample{SimTime{}, 0, 500, 400, rgb}});
  };
  std::thread sut([&] {
    auto channel = link::connect_tcp(proxy.address(), 10s).value();
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_TRUE(channel->send(link::Progress{}).ok());
    const auto message = channel->receive();
    const auto took = std::chrono::steady_clock::now() - begin;
    ASSERT_TRUE(message.ok());
    EXPECT_EQ(std::get<uav::CameraSample>(*std::get<link::Reply>(*message).sample).rgb, rgb);
    EXPECT_GE(took, 12ms);  // 3 ms there, 3 ms and 6 ms of image back
  });
  EXPECT_TRUE(link::poll_until(*server, events, [&] { return !events.closed.empty(); }));
  sut.join();
}

TEST(ThrottlingProxy, TellsTheClientThatTheTargetIsGone) {
  link::RecordingEvents events;
  const link::Address gone = link::listen_tcp({"127.0.0.1", 0}, 10s)->address();
  ThrottlingProxy proxy({"127.0.0.1", 0}, gone, {});
  auto channel = link::connect_tcp(proxy.address(), 10s).value();
  EXPECT_EQ(channel->receive().failure().kind, Failure::Kind::kDisconnected);
}

}  // namespace
}  // namespace tether::link_testing
