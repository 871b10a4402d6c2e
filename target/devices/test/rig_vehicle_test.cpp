#include "rig_vehicle.h"

#include "manual_clock.h"
#include "system.h"

#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::devices {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A rig of one rangefinder, "down", on a manual clock.
class RigVehicleTest : public testing::Test {
 protected:
  RigVehicleTest() {
    scratch_.write("in_distance_input", "0.5\n");
    auto clock = std::make_unique<ManualClock>();
    clock_ = clock.get();
    const Timeline time(*clock);
    auto range = RangeDevice::open(real_system(), time, "rangefinder x", scratch_.path(), {});
    EXPECT_TRUE(range);
    uav::Catalogue catalogue{"bench", {{"down", {}, 0.0, uav::RangeProperties{}}}, {}};
    std::vector<Device> devices;
    devices.emplace_back(std::move(*range));
    vehicle_ = std::make_unique<RigVehicle>(std::move(clock), time, std::move(catalogue),
                                            std::move(devices));
  }

  ScratchFolder scratch_;
  ManualClock* clock_ = nullptr;
  std::unique_ptr<client::Vehicle> vehicle_;
};

TEST_F(RigVehicleTest, ReadsItsSensors) {
  clock_->advance(std::chrono::milliseconds(7));
  const auto sample = vehicle_->read<uav::RangeSample>("down");
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->range_m, 0.5);
  EXPECT_EQ(sample->sampled_at, same_instant(vehicle_->now()));
  EXPECT_EQ(vehicle_->catalogue().uav, "bench");
}

TEST_F(RigVehicleTest, RefusesUnknownSensorsPollingAndFlight) {
  for (const Failure& failure :
       {vehicle_->read<uav::RangeSample>("up").failure(),
        vehicle_->read<uav::CameraSample>("down").failure(),
        vehicle_->read<uav::ImuSample>("down").failure(),
        vehicle_->read<uav::RangeSample>("down", client::Read::kIfAvailable).failure(),
        vehicle_->command_velocity({}).failure()}) {
    EXPECT_EQ(failure.kind, Failure::Kind::kInvalid);
  }
  EXPECT_THAT(vehicle_->read<uav::RangeSample>("up").failure().message,
              AllOf(HasSubstr("\"up\""), HasSubstr("\"down\"")));
  EXPECT_TRUE(vehicle_->annotate("topic", "{}"));
  EXPECT_TRUE(vehicle_->finish(true, "done", "{}"));
}

TEST_F(RigVehicleTest, SleepsOnItsClock) {
  EXPECT_TRUE(vehicle_->sleep_for(std::chrono::seconds(2)));
  EXPECT_EQ(vehicle_->now(), ExecTime(std::chrono::seconds(2)));
  EXPECT_TRUE(vehicle_->sleep_until(ExecTime(std::chrono::seconds(3))));
  EXPECT_EQ(vehicle_->now(), ExecTime(std::chrono::seconds(3)));
  EXPECT_TRUE(vehicle_->sleep_until(ExecTime(std::chrono::seconds(1))));
  EXPECT_TRUE(vehicle_->sleep_for(Duration::min()));
  EXPECT_TRUE(vehicle_->sleep_for(std::chrono::seconds(-1)));
  EXPECT_EQ(vehicle_->now(), ExecTime(std::chrono::seconds(3)));
}

TEST_F(RigVehicleTest, LongestSleepDoesNotOverflow) {
  clock_->advance(std::chrono::seconds(1));
  EXPECT_TRUE(vehicle_->sleep_for(Duration::max()));
  EXPECT_TRUE(vehicle_->sleep_until(ExecTime::max()));
  EXPECT_GT(vehicle_->now(), ExecTime(std::chrono::hours(24 * 365 * 100)));
}

}  // namespace
}  // namespace tether::devices
