#include "scripted_coordinator.h"

#include <optional>

#include <gtest/gtest.h>

#include <tether/client/simulated_vehicle.h>

namespace tether::client {
namespace {

using std::chrono::milliseconds;

const uav::BatterySample kSample{from_ns<SimTime>(500'000), 12.0, 6.5, 0.8};

class BatteryOfVehicle : public testing::Test {
 protected:
  Result<uav::BatterySample> read(double capacity_C, std::optional<uav::BatterySample> answer) {
    link::Welcome welcome = welcome_with_sensors();
    welcome.catalogue.battery_capacity_C = capacity_C;
    coordinator_.emplace(welcome, [&](const link::Request& request) {
      return std::vector<link::Message>{link::Reply{.sequence = request.sequence,
                                                    .resume_at = request.issued_at,
                                                    .sample = {},
                                                    .battery = answer}};
    });
    ConnectOptions options;
    options.time = make_scripted_source(milliseconds(1));
    return connect(coordinator_->connect(), std::move(options)).value()->read_battery();
  }

  std::optional<ScriptedCoordinator> coordinator_;
};

TEST_F(BatteryOfVehicle, ReadsTheBattery) {
  const auto battery = read(7200.0, kSample);
  ASSERT_TRUE(battery);
  EXPECT_EQ(*battery, kSample);
}

TEST_F(BatteryOfVehicle, AsksNothingWithoutABattery) {
  EXPECT_EQ(read(0.0, kSample).failure().kind, Failure::Kind::kInvalid);
  EXPECT_TRUE(coordinator_->requests().empty());
}

TEST_F(BatteryOfVehicle, RefusesNoAnswerAndOneOfTheFuture) {
  EXPECT_EQ(read(7200.0, std::nullopt).failure().kind, Failure::Kind::kProtocol);
  uav::BatterySample later = kSample;
  later.sampled_at = SimTime(milliseconds(2));
  EXPECT_EQ(read(7200.0, later).failure().kind, Failure::Kind::kProtocol);
}

}  // namespace
}  // namespace tether::client
