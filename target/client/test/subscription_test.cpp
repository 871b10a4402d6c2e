#include "cancellation.h"

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <tether/client/subscription.h>

namespace tether::client {
namespace {

const Failure kRunEnded{Failure::Kind::kRunEnded, "the time is up"};

/// A concurrent vehicle whose rangefinder "down" delivers what the test gives it.
class FakeVehicle final : public Vehicle {
 public:
  FakeVehicle() {
    catalogue_.sensors = {{"nose", {}, 30.0, uav::CameraProperties{}},
                          {"down", {}, 10.0, uav::RangeProperties{}},
                          {"side", {}, 0.0, uav::RangeProperties{}}};
  }
  void give(Result<uav::RangeSample> sample) {
    const std::lock_guard lock(mutex_);
    next_ = std::move(sample);
    changed_.notify_all();
  }
  void wait_until_read() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_ && !next_; });
  }
  bool concurrent = true;

  ExecTime now() const override { return {}; }
  const uav::Catalogue& catalogue() const override { return catalogue_; }
  bool is_concurrent() const override { return concurrent; }
  Result<uav::CameraSample> read_camera(std::string_view, Read) override { return kRunEnded; }
  Result<uav::ImuSample> read_imu(std::string_view, Read) override { return kRunEnded; }
  Result<uav::RangeSample> read_range(std::string_view, Read read) override {
    EXPECT_EQ(read, Read::kNext);
    bool cancelled = false;
    const Cancellation::Wait wait(Cancellation::of_this_thread(), [&] {
      const std::lock_guard lock(mutex_);
      cancelled = true;
      changed_.notify_all();
    });
    std::unique_lock lock(mutex_);
    waiting_ = true;
    changed_.notify_all();
    changed_.wait(lock, [&] { return next_ || cancelled; });
    waiting_ = false;
    if (!next_) return Failure{Failure::Kind::kInvalid, "cancelled"};
    auto sample = std::move(*next_);
    next_.reset();
    changed_.notify_all();
    return sample;
  }
  Status command_velocity(const uav::VelocityCommand&) override { return kRunEnded; }
  Status sleep_for(Duration) override { return kRunEnded; }
  Status sleep_until(ExecTime) override { return kRunEnded; }
  Status annotate(std::string_view, std::string_view) override { return kRunEnded; }
  Status finish(bool, std::string_view, std::string_view) override { return kRunEnded; }

 private:
  uav::Catalogue catalogue_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Result<uav::RangeSample>> next_;
  bool waiting_ = false;
};

TEST(Subscription, CallsBackWithEachMeasurementUntilTheRunEnds) {
  FakeVehicle vehicle;
  std::vector<std::uint64_t> indices;
  const auto subscription = subscribe_range(
      vehicle, "down", [&](const uav::RangeSample& sample) { indices.push_back(sample.index); });
  ASSERT_TRUE(subscription.ok());
  for (std::uint64_t i = 0; i < 20; ++i) {
    vehicle.wait_until_read();
    vehicle.give(uav::RangeSample{{}, i, 1.0});
  }
  vehicle.wait_until_read();
  EXPECT_EQ((*subscription)->ended(), std::nullopt);
  vehicle.give(kRunEnded);
  while (!(*subscription)->ended()) std::this_thread::yield();
  EXPECT_EQ((*subscription)->ended()->kind, Failure::Kind::kRunEnded);
  EXPECT_EQ(indices.size(), 20u);
}

TEST(Subscription, EndsWhileItsThreadWaitsForAMeasurement) {
  FakeVehicle vehicle;
  std::atomic<int> calls = 0;
  auto subscription = subscribe_range(vehicle, "down", [&](const uav::RangeSample&) { ++calls; });
  ASSERT_TRUE(subscription.ok());
  vehicle.wait_until_read();
  subscription->reset();
  EXPECT_EQ(calls, 0);
}

TEST(Subscription, MayEndFromWithinItsCallback) {
  FakeVehicle vehicle;
  std::unique_ptr<Subscription> subscription;
  std::mutex mutex;
  std::condition_variable gone;
  bool is_gone = false;
  std::unique_lock lock(mutex);
  auto made = subscribe_range(vehicle, "down", [&](const uav::RangeSample&) {
    const std::lock_guard inner(mutex);
    subscription.reset();
    is_gone = true;
    gone.notify_all();
  });
  ASSERT_TRUE(made.ok());
  subscription = std::move(*made);
  vehicle.give(uav::RangeSample{});
  gone.wait(lock, [&] { return is_gone; });
  EXPECT_EQ(subscription, nullptr);
}

TEST(Subscription, SaysWhyItCannotBe) {
  FakeVehicle vehicle;
  const auto expect_invalid = [&](const std::string& sensor, const std::string& why) {
    const auto made = subscribe_range(vehicle, sensor, [](const uav::RangeSample&) {});
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.failure().kind, Failure::Kind::kInvalid);
    EXPECT_NE(made.failure().message.find(why), std::string::npos) << made.failure().message;
  };
  expect_invalid("up", "has no range");
  expect_invalid("nose", "has no range");
  expect_invalid("side", "only when it is read");
  vehicle.concurrent = false;
  expect_invalid("down", "start the program with tether-exec");
  EXPECT_FALSE(subscribe_imu(vehicle, "down", [](const uav::ImuSample&) {}).ok());
  EXPECT_FALSE(subscribe_camera(vehicle, "down", [](const uav::CameraSample&) {}).ok());
}

}  // namespace
}  // namespace tether::client
