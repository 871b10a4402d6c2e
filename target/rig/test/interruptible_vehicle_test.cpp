#include <csignal>

#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/rig/device_arguments.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::rig {
namespace {

using tasks::testing::PlanarVehicle;

TEST(InterruptibleVehicle, EndsEveryInteractionOnceInterrupted) {
  bool over = false;
  const auto vehicle = make_interruptible(std::make_unique<PlanarVehicle>(PlanarVehicle::Options{}),
                                          [&over] { return over; });
  EXPECT_EQ(vehicle->catalogue().uav, "uav");
  EXPECT_TRUE(vehicle->read<uav::RangeSample>("range"));
  EXPECT_TRUE(vehicle->sleep_for(Duration(1)));
  EXPECT_GT(vehicle->now(), ExecTime());
  over = true;
  const ExecTime at = vehicle->now();
  const auto reading = vehicle->read<uav::RangeSample>("range");
  ASSERT_FALSE(reading);
  EXPECT_EQ(reading.failure().kind, Failure::Kind::kRunEnded);
  EXPECT_FALSE(vehicle->read<uav::CameraSample>("camera"));
  EXPECT_FALSE(vehicle->read<uav::ImuSample>("imu"));
  EXPECT_FALSE(vehicle->command_velocity({}));
  EXPECT_FALSE(vehicle->sleep_for(Duration(1)));
  EXPECT_FALSE(vehicle->sleep_until(ExecTime()));
  EXPECT_TRUE(vehicle->annotate("task", "{}"));
  EXPECT_EQ(vehicle->now(), at) << "nothing reached the vehicle";
}

TEST(InterruptibleVehicle, IsInterruptedByAClosedTerminalUnlessItIsIgnored) {
  const auto hang_up = [](void (*before)(int)) {
    signal(SIGHUP, before);
    catch_interrupts();
    for (int i = 0; i < 2; ++i) raise(SIGHUP);
    _exit(interrupted() ? 1 : 0);
  };
  EXPECT_EXIT(hang_up(SIG_DFL), testing::ExitedWithCode(1), "");
  EXPECT_EXIT(hang_up(SIG_IGN), testing::ExitedWithCode(0), "");
}

TEST(InterruptibleVehicle, FinishSucceedsAfterInterrupt) {
  auto inner = std::make_unique<PlanarVehicle>(PlanarVehicle::Options{});
  const PlanarVehicle& told = *inner;
  const auto vehicle = make_interruptible(std::move(inner), [] { return true; });
  EXPECT_TRUE(vehicle->finish(true, "goal reached", "{}"));
  ASSERT_TRUE(told.finished());
  EXPECT_TRUE(told.finished()->reached_goal);
}

TEST(InterruptibleVehicle, ReportsFailureCausedByInterruptAsInterrupt) {
  int asked = 0;
  const auto vehicle = make_interruptible(
      std::make_unique<PlanarVehicle>(PlanarVehicle::Options{.disconnect_at = 0}),
      [&asked] { return ++asked > 1; });
  EXPECT_EQ(vehicle->read<uav::RangeSample>("range").failure().kind, Failure::Kind::kRunEnded);
  const auto other = make_interruptible(
      std::make_unique<PlanarVehicle>(PlanarVehicle::Options{.disconnect_at = 0}),
      [] { return false; });
  EXPECT_EQ(other->read<uav::RangeSample>("range").failure().kind, Failure::Kind::kDisconnected);
}

}  // namespace
}  // namespace tether::rig
