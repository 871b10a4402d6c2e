#include "server_fixture.h"

#include <thread>

#include <tether/link_testing/throttling_proxy.h>

namespace tether::link_testing {
namespace {

using namespace std::chrono_literals;

TEST(WireSchedule, AddsTheDelayToTheTimeOfSending) {
  WireSchedule unlimited({20ms, 0.0});
  EXPECT_EQ(unlimited.arrival(0ms, 1'000'000), 20ms);
  EXPECT_EQ(unlimited.arrival(5ms, 1), 25ms);
  WireSchedule limited({10ms, 1e6});  // 1 MB/s: 1 ms per 1000 bytes
  EXPECT_EQ(limited.arrival(0ms, 1000), 11ms);
  EXPECT_EQ(limited.arrival(0ms, 2000), 13ms);
  EXPECT_EQ(limited.arrival(2ms, 1000), 14ms);
  EXPECT_EQ(limited.arrival(100ms, 1000), 111ms);  // idle meanwhile
}

using ThrottlingProxyTest = link::ServerFixture;

/// A small request and an image in return, over a wire of 3 ms and 100 MB/s: nothing is lost, and
/// it takes at least the time of the wire.
TEST_F(ThrottlingProxyTest, DelaysAndThrottlesBothWays) {
  listen();
  const ThrottlingProxy proxy({"127.0.0.1", 0}, server_->address(), {3ms, 100e6});
  const std::vector<std::uint8_t> rgb(600'000, 9);
  events_.react = [&](link::PeerId peer, const link::Message&) {
    server_->send(peer, link::Reply{1, ExecTime{}, uav::CameraSample{SimTime{}, 0, 500, 400, rgb}});
  };
  std::jthread sut([&] {
    auto channel = link::connect_tcp(proxy.address(), 10s).value();
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_TRUE(channel->send(link::Progress{}).ok());
    const auto message = channel->receive();
    EXPECT_GE(std::chrono::steady_clock::now() - begin, 12ms);  // 3 ms; 3 ms and 6 ms of image
    ASSERT_TRUE(message.ok());
    EXPECT_EQ(std::get<uav::CameraSample>(*std::get<link::Reply>(*message).sample).rgb, rgb);
  });
  EXPECT_TRUE(wait_for_closed());
}

TEST_F(ThrottlingProxyTest, DisconnectsTheClientWhenTheTargetIsGone) {
  const link::Address gone = link::listen_tcp({"127.0.0.1", 0}, 10s)->address();
  const ThrottlingProxy proxy({"127.0.0.1", 0}, gone, {});
  auto channel = link::connect_tcp(proxy.address(), 10s).value();
  EXPECT_EQ(channel->receive().failure().kind, Failure::Kind::kDisconnected);
}

}  // namespace
}  // namespace tether::link_testing
