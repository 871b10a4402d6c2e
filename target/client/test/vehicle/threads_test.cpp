#include "clocks/fake_wall_timer.h"
#include "scripted_coordinator.h"
#include "vehicle/simulated_vehicle_impl.h"

#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/client_testing/manual_time_source.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;
using client_testing::ManualTimeSource;

constexpr int kThreads = 4;
constexpr int kRounds = 50;

std::vector<link::Message> answer(const link::Request& request) {
  link::Reply reply{request.sequence, request.issued_at + 1ms, std::nullopt};
  const auto* read = std::get_if<link::ReadSensor>(&request.body);
  if (read != nullptr && !read->only_if_available) {
    reply.sample = uav::ImuSample{same_instant(request.issued_at), request.sequence, {}, {}, {}};
  }
  return {reply};
}

/// Calls of every kind, in turn with the other threads.
void call_a_lot(Vehicle& vehicle, ManualTimeSource source, std::mutex& turn) {
  for (int i = 0; i < kRounds; ++i) {
    const std::lock_guard lock(turn);
    source.advance(1us);
    EXPECT_TRUE(vehicle.read<uav::ImuSample>("imu").ok());
    const ExecTime before = vehicle.now();
    EXPECT_TRUE(vehicle.sleep_for(1ms).ok());
    EXPECT_TRUE(vehicle.annotate("task", "{}").ok());
    EXPECT_TRUE(vehicle.command_velocity({}).ok());
    EXPECT_EQ(vehicle.read<uav::RangeSample>("down", Read::kIfAvailable).failure().kind,
              Failure::Kind::kNothingYet);
    EXPECT_GE(vehicle.now(), before + 3ms);
  }
}

TEST(SerialVehicle, ThreadsCanTakeTurns) {
  const link::Welcome welcome = welcome_with_sensors();
  ScriptedCoordinator coordinator(welcome, answer);
  ManualTimeSource source(computer::ClockKind::kCpu);
  SimulatedVehicle vehicle(coordinator.connect(), welcome,
                           std::make_unique<ManualTimeSource>(source),
                           std::make_unique<FakeWallTimer>(), Duration::zero());
  std::mutex turn;
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i)
    threads.emplace_back([&] { call_a_lot(vehicle, source, turn); });
  for (auto& thread : threads) thread.join();

  const auto requests = coordinator.requests();
  ASSERT_EQ(requests.size(), 4u * kThreads * kRounds);
  for (std::size_t i = 1; i < requests.size(); ++i) {
    ASSERT_EQ(requests[i].sequence, requests[i - 1].sequence + 1);
    // Every reply moves ET by 1 ms, so a request from within another's interaction would show.
    ASSERT_GE(requests[i].issued_at, requests[i - 1].issued_at + 1ms);
  }
}

// How long one thread waits for the other one's call depends on the simulation, not on the board.
TEST(SerialVehicle, ACallDuringTheCallOfAnotherThreadEndsTheRun) {
  const link::Welcome welcome = welcome_with_sensors();
  std::promise<void> has_begun;
  std::promise<void> may_end;
  ScriptedCoordinator coordinator(welcome, [&](const link::Request& request) {
    has_begun.set_value();
    may_end.get_future().wait();
    return answer(request);
  });
  SimulatedVehicle vehicle(coordinator.connect(), welcome,
                           std::make_unique<ManualTimeSource>(computer::ClockKind::kCpu),
                           std::make_unique<FakeWallTimer>(), Duration::zero());
  std::thread first([&] { EXPECT_TRUE(vehicle.read<uav::ImuSample>("imu").ok()); });
  has_begun.get_future().wait();
  std::thread release([&] {
    std::this_thread::sleep_for(50ms);
    may_end.set_value();
  });
  const Status second = vehicle.command_velocity({});
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.failure().kind, Failure::Kind::kRefused);
  EXPECT_THAT(second.failure().message, testing::HasSubstr("concurrent = true"));
  first.join();
  release.join();
}

// Both would speak on one connection, and the parent's sequence would be broken.
TEST(SerialVehicle, ForkedChildCannotUseIt) {
  const link::Welcome welcome = welcome_with_sensors();
  ScriptedCoordinator coordinator(welcome, answer);
  auto vehicle = std::make_unique<SimulatedVehicle>(
      coordinator.connect(), welcome, std::make_unique<ManualTimeSource>(computer::ClockKind::kCpu),
      std::make_unique<FakeWallTimer>(), 1ms);
  EXPECT_TRUE(vehicle->command_velocity({}).ok());
  const pid_t child = ::fork();
  if (child == 0) {
    const auto is_refused = [](const Status& status) {
      return !status && status.failure().kind == Failure::Kind::kInvalid;
    };
    const bool refused =
        is_refused(vehicle->command_velocity({})) && is_refused(vehicle->sleep_for(1ms)) &&
        is_refused(vehicle->annotate("task", "{}")) && is_refused(vehicle->finish(true, "", ""));
    vehicle.reset();
    ::_exit(refused ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(vehicle->command_velocity({}).ok());
  EXPECT_EQ(coordinator.requests().size(), 2u);
}

}  // namespace
}  // namespace tether::client
