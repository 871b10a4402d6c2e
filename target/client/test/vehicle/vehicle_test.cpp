#include <gtest/gtest.h>

#include <tether/client/vehicle.h>

namespace tether::client {
namespace {

struct Deaf final : Vehicle {
  ExecTime now() const override { return {}; }
  const uav::Catalogue& catalogue() const override { return catalogue_; }
  Result<uav::Sample> read_any(std::string_view, uav::SensorKind, Read) override { return none(); }
  Status command_velocity(const uav::VelocityCommand&) override { return none(); }
  Status sleep_for(Duration) override { return none(); }
  Status sleep_until(ExecTime) override { return none(); }
  Status annotate(std::string_view, std::string_view) override { return none(); }
  Status finish(bool, std::string_view, std::string_view) override { return none(); }

 private:
  static Failure none() { return {Failure::Kind::kDisconnected, ""}; }
  uav::Catalogue catalogue_;
};

TEST(Vehicle, HasNoBatteryByDefault) {
  EXPECT_EQ(Deaf().read_battery().failure().kind, Failure::Kind::kInvalid);
}

TEST(Vehicle, HasNoRadioByDefault) {
  Deaf vehicle;
  EXPECT_TRUE(vehicle.peers().empty());
  EXPECT_EQ(vehicle.send("", {}).failure().kind, Failure::Kind::kInvalid);
  EXPECT_EQ(vehicle.receive(Duration(1)).failure().kind, Failure::Kind::kInvalid);
}

}  // namespace
}  // namespace tether::client
