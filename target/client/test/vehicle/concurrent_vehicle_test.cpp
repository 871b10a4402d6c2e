#include "fake_exec.h"

#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/client/simulated_vehicle.h>
#include <tether/client/vehicle.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;

TEST(ConcurrentVehicle, EachThreadUsesItsOwnConnection) {
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  EXPECT_TRUE(vehicle->is_concurrent());
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (int k = 0; k < 50; ++k) {
        const ExecTime before = vehicle->now();
        ASSERT_GE(before, ExecTime(1s));
        const auto reading = vehicle->read<uav::ImuSample>("imu");
        ASSERT_TRUE(reading.ok()) << reading.failure().message;
        ASSERT_GE(reading->sampled_at, same_instant(before));
        ASSERT_TRUE(vehicle->command_velocity({}).ok());
        ASSERT_TRUE(vehicle->annotate("topic", "{}").ok());
        ASSERT_TRUE(vehicle->sleep_for(1ms).ok());
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_LE(exec.connections(), 4u);
  EXPECT_EQ(exec.requests(), 4u * 50 * 3);
}

TEST(ConcurrentVehicle, WaitingCallBlocksNoOtherAndEndsWithTheConnection) {
  for (const bool is_refused : {true, false}) {
    const auto kind = is_refused ? Failure::Kind::kRunEnded : Failure::Kind::kDisconnected;
    FakeExec exec(all_but_the_rangefinder);
    const auto vehicle = exec.connect();
    std::thread waiting(
        [&] { EXPECT_EQ(vehicle->read<uav::RangeSample>("down").failure().kind, kind); });
    wait_for([&] { return exec.requests() == 1; });
    EXPECT_TRUE(vehicle->read<uav::ImuSample>("imu").ok());
    if (is_refused) {
      exec.end(link::Refusal{link::Refusal::Reason::kRunEnded, "the time is up"});
    } else {
      exec.end(std::nullopt);
    }
    waiting.join();
    EXPECT_EQ(vehicle->command_velocity({}).failure().kind, kind);
  }
}

// The end may come together with a reply: the call has succeeded then, on a connection that has
// just been shut down.
TEST(ConcurrentVehicle, EndOfSubscriptionDoesNotAffectOtherCalls) {
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  for (int i = 0; i < 100; ++i) {
    std::atomic<int> count = 0;
    auto subscription =
        subscribe<uav::ImuSample>(*vehicle, "imu", [&](const uav::ImuSample&) { ++count; });
    ASSERT_TRUE(subscription.ok());
    wait_for([&] { return count > 0; });
    subscription->reset();
    ASSERT_TRUE(vehicle->command_velocity({}).ok()) << i;
  }
}

TEST(ConcurrentVehicle, ForkedChildMustConnectForItself) {
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  const pid_t child = ::fork();
  if (child == 0) {
    const bool refused = vehicle->command_velocity({}).failure().kind == Failure::Kind::kInvalid;
    ConnectOptions options;
    options.exec_socket = exec.path();
    auto own = connect(std::move(options));
    ::_exit(refused && own.ok() && (*own)->command_velocity({}).ok() ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(vehicle->command_velocity({}).ok());
}

TEST(ConcurrentVehicle, SleepsAtTheCoordinatorInFreeRunningAndRefusesCallsAfterFinish) {
  std::mutex mutex;
  std::vector<link::Request> asked;
  FakeExec exec(
      [&](const link::Request& request) {
        const std::lock_guard lock(mutex);
        asked.push_back(request);
        return grant(request);
      },
      true);
  const auto vehicle = exec.connect();
  EXPECT_TRUE(vehicle->sleep_for(2ms).ok());
  EXPECT_TRUE(vehicle->sleep_until(ExecTime(5s)).ok());
  {
    const std::lock_guard lock(mutex);
    const auto& relative = std::get<link::Sleep>(asked.at(0).body);
    EXPECT_TRUE(relative.is_relative);
    EXPECT_EQ(relative.until, asked[0].issued_at + 2ms);
    const auto& absolute = std::get<link::Sleep>(asked.at(1).body);
    EXPECT_FALSE(absolute.is_relative);
    EXPECT_EQ(absolute.until, ExecTime(5s));
  }
  EXPECT_TRUE(vehicle->finish(true, "done", "").ok());
  EXPECT_EQ(vehicle->read<uav::ImuSample>("imu").failure().kind, Failure::Kind::kInvalid);
}

TEST(ConcurrentVehicle, ReportsWhyItCannotConnect) {
  for (const bool has_clock : {false, true}) {  // tether-exec has the clock
    ConnectOptions options;
    options.exec_socket = "/nowhere/socket";
    if (has_clock) options.time = make_cpu_source(2.0);
    EXPECT_EQ(connect(std::move(options)).failure().kind,
              has_clock ? Failure::Kind::kInvalid : Failure::Kind::kDisconnected);
  }
}

}  // namespace
}  // namespace tether::client
