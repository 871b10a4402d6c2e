#include "fake_exec.h"
#include "scripted_coordinator.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include <gtest/gtest.h>

#include <tether/client/vehicle.h>

namespace tether::client {
namespace {

TEST(Subscription, CallsBackWithEachMeasurementUntilTheRunEnds) {
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  std::atomic<std::uint64_t> calls = 0;
  const auto subscription = subscribe<uav::RangeSample>(
      *vehicle, "down", [&](const uav::RangeSample& sample) { EXPECT_EQ(sample.index, ++calls); });
  ASSERT_TRUE(subscription.ok());
  wait_for([&] { return calls >= 20; });
  EXPECT_EQ((*subscription)->ended(), std::nullopt);
  exec.end(link::Refusal{link::Refusal::Reason::kRunEnded, "the time is up"});
  wait_for([&] { return (*subscription)->ended().has_value(); });
  EXPECT_EQ((*subscription)->ended()->kind, Failure::Kind::kRunEnded);
}

TEST(Subscription, EndsWhileItsThreadWaitsForAMeasurement) {
  FakeExec exec(all_but_the_rangefinder);
  const auto vehicle = exec.connect();
  std::atomic<int> calls = 0;
  auto subscription =
      subscribe<uav::RangeSample>(*vehicle, "down", [&](const uav::RangeSample&) { ++calls; });
  ASSERT_TRUE(subscription.ok());
  wait_for([&] { return exec.requests() == 1; });
  subscription->reset();
  EXPECT_EQ(calls, 0);
  EXPECT_TRUE(vehicle->read<uav::ImuSample>("imu").ok());
}

TEST(Subscription, CanEndWithinItsCallback) {
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  std::unique_ptr<Subscription> subscription;
  std::mutex mutex;
  std::condition_variable gone;
  bool is_gone = false;
  std::unique_lock lock(mutex);
  auto made = subscribe<uav::RangeSample>(*vehicle, "down", [&](const uav::RangeSample&) {
    const std::lock_guard inner(mutex);
    subscription.reset();
    is_gone = true;
    gone.notify_all();
  });
  ASSERT_TRUE(made.ok());
  subscription = std::move(*made);
  gone.wait(lock, [&] { return is_gone; });
  EXPECT_EQ(subscription, nullptr);
}

TEST(Subscription, NeedsAPeriodicSensorOfItsKindAndTetherExec) {
  const auto expect_invalid = [](const auto& made) {
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.failure().kind, Failure::Kind::kInvalid);
  };
  const auto on_range = [](const uav::RangeSample&) {};
  FakeExec exec(grant);
  const auto vehicle = exec.connect();
  for (const char* sensor : {"up", "imu", "side"}) {
    expect_invalid(subscribe<uav::RangeSample>(*vehicle, sensor, on_range));
  }
  expect_invalid(subscribe<uav::ImuSample>(*vehicle, "down", [](const uav::ImuSample&) {}));
  expect_invalid(subscribe<uav::CameraSample>(*vehicle, "down", [](const uav::CameraSample&) {}));
  ScriptedCoordinator coordinator(welcome_with_sensors());
  ConnectOptions options;
  options.time = make_wall_source();
  const auto serial = connect(coordinator.connect(), std::move(options)).value();
  expect_invalid(subscribe<uav::RangeSample>(*serial, "down", on_range));
}

}  // namespace
}  // namespace tether::client
