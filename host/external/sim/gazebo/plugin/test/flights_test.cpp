#include <gtest/gtest.h>

#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {
namespace {

sim::protocol::Open open_with_uav() {
  sim::protocol::Open open;
  open.step = std::chrono::milliseconds(1);
  open.uavs.push_back({"uav1", "", {{0, 0, 1}, {}}, uav::hummingbird()});
  return open;
}

uav::BodyState at_rest() {
  return {{0, 0, 1}, {}, {}, {}};
}

TEST(Flights, HoverThenFollowTheLastCommandUntilAReset) {
  Flights flights(open_with_uav());
  const uav::Wrench first = flights.step(0, at_rest());
  EXPECT_NEAR(first.force_B.z, uav::hummingbird().mass_kg * 9.81, 1e-6);
  flights.set_setpoint(0, uav::to_setpoint({{0, 0, 1}, 0}));
  for (int i = 0; i < 20; ++i) (void)flights.step(0, at_rest());
  EXPECT_GT(flights.step(0, at_rest()).force_B.z, uav::hummingbird().mass_kg * 9.9);
  flights.reset();
  EXPECT_EQ(flights.step(0, at_rest()), first);
}

}  // namespace
}  // namespace tether::gazebo_plugin
