#include "scripted_coordinator.h"

#include <chrono>

#include <gtest/gtest.h>

#include <tether/client/simulated_vehicle.h>
#include <tether/client_testing/manual_time_source.h>
#include <tether/link/server.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;
using client_testing::ManualTimeSource;

ConnectOptions options_with(double factor = 1.0) {
  ConnectOptions options;
  options.token = "secret";
  options.sut_name = "sut 1";
  options.uav = "uav";
  options.time = std::make_unique<ManualTimeSource>(computer::ClockKind::kCpu, factor);
  return options;
}

TEST(Connect, SaysHelloAndStartsWithTheWelcome) {
  link::Welcome welcome = welcome_with_sensors();
  welcome.start = from_ns<ExecTime>(5000);
  ScriptedCoordinator coordinator(welcome);
  const auto vehicle = connect(coordinator.connect(), options_with(2.0));
  ASSERT_TRUE(vehicle.ok()) << vehicle.failure().message;
  EXPECT_EQ(to_ns((*vehicle)->now()), 5000);
  EXPECT_EQ((*vehicle)->catalogue().sensors.size(), 3u);
  const auto heard = coordinator.heard();
  const auto& hello = std::get<link::Hello>(heard.at(0));
  EXPECT_EQ(hello.protocol_version, link::kProtocolVersion);
  EXPECT_EQ(hello.sut, "sut 1");
  EXPECT_EQ(hello.uav, "uav");
  EXPECT_EQ(hello.token, "secret");
  EXPECT_EQ(hello.clock, (computer::Clock{computer::ClockKind::kCpu, 2.0}));
}

TEST(Connect, ReportsAnAnswerOtherThanWelcome) {
  const auto failure_after = [](link::Message answer) {
    ScriptedCoordinator coordinator(std::move(answer));
    return connect(coordinator.connect(), options_with()).failure();
  };
  constexpr auto kToken = link::Refusal::Reason::kToken;
  const Failure refused = failure_after(link::Refusal{kToken, "wrong token"});
  EXPECT_EQ(refused.kind, Failure::Kind::kRefused);
  EXPECT_EQ(refused.message, "wrong token");
  EXPECT_GT(failure_after(link::Refusal{kToken, " "}).message.size(), 1u);
  EXPECT_EQ(failure_after(link::Reply{1, ExecTime{}, std::nullopt}).kind, Failure::Kind::kProtocol);
}

TEST(Connect, DoesNotWaitForeverForAWelcome) {
  const auto server = link::listen_tcp({"127.0.0.1", 0}, std::chrono::seconds(20));
  ConnectOptions options = options_with();
  options.welcome_timeout = 1ms;
  const auto vehicle = connect(
      link::connect_tcp(server->address(), std::chrono::seconds(20)).value(), std::move(options));
  ASSERT_FALSE(vehicle.ok());
  EXPECT_EQ(vehicle.failure().kind, Failure::Kind::kTimeout);
}

TEST(Connect, RefusesUnusableOptions) {
  link::Welcome welcome;
  welcome.free_running = true;  // where a faster machine cannot be imitated
  for (const bool is_faster : {true, false}) {
    ScriptedCoordinator coordinator(welcome);
    ConnectOptions options = options_with(is_faster ? 0.5 : 1.0);
    if (!is_faster) options.token = std::string(1000, 'x');
    const auto vehicle = connect(coordinator.connect(), std::move(options));
    ASSERT_FALSE(vehicle.ok());
    EXPECT_EQ(vehicle.failure().kind, Failure::Kind::kInvalid);
  }
}

}  // namespace
}  // namespace tether::client
