#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/uav/multirotor.h>

namespace tether::uav {
namespace {

/// n rotors on a circle, spinning in alternate directions.
MultirotorParameters ring(int count, double first_rad) {
  MultirotorParameters p = hummingbird();
  p.rotors.clear();
  for (int i = 0; i < count; ++i) {
    const double angle = first_rad + 2 * std::numbers::pi * i / count;
    p.rotors.push_back({{0.2 * std::cos(angle), 0.2 * std::sin(angle), 0}, i % 2 == 0 ? 1 : -1});
  }
  return p;
}

RotorThrusts mix(const MultirotorParameters& p, const Demand& demand) {
  return Mixer(p).mix(demand, max_rotor_thrust_N(p));
}

/// The thrust and torque of these thrusts: the inverse of `mix` within the limits.
Demand unmix(const MultirotorParameters& p, const RotorThrusts& thrusts) {
  Demand sum;
  for (std::size_t i = 0; i < p.rotors.size(); ++i) {
    const auto& [p_BR, direction] = p.rotors[i];
    const Vec3 lever{p_BR.y, -p_BR.x, -direction * p.moment_coefficient_m};
    sum.thrust_N += thrusts[i];
    sum.torque_B_N_m = sum.torque_B_N_m + thrusts[i] * lever;
  }
  return sum;
}

struct Layout {
  const char* name;
  MultirotorParameters parameters;
};

std::vector<Layout> layouts() {
  MultirotorParameters lopsided = hummingbird();
  lopsided.rotors[0].p_BR = {0.21, 0.03, 0};
  return {{"plus", hummingbird()},
          {"cross", ring(4, std::numbers::pi / 4)},
          {"hexa", ring(6, 0)},
          {"octo", ring(8, 0.1)},
          {"lopsided", lopsided}};
}

TEST(Mixer, GivesTheDemandWithinTheLimitsAndNeverExceedsThem) {
  KeyedRandom random({1, 0, 0});
  const auto spread = [&random](double limit) { return limit * (2 * random.uniform() - 1); };
  for (const Layout& layout : layouts()) {
    SCOPED_TRACE(layout.name);
    const double limit = max_rotor_thrust_N(layout.parameters);
    for (int i = 0; i < 2000; ++i) {
      const Demand demand{8.0 + spread(2), {spread(0.1), spread(0.1), spread(0.02)}};
      const Demand got = unmix(layout.parameters, mix(layout.parameters, demand));
      EXPECT_NEAR(got.thrust_N, demand.thrust_N, 1e-9);
      EXPECT_LT(norm(got.torque_B_N_m - demand.torque_B_N_m), 1e-9);

      const Demand wild{40 * random.normal(),
                        {3 * random.normal(), 3 * random.normal(), random.normal()}};
      for (const double thrust : mix(layout.parameters, wild))
        EXPECT_TRUE(thrust >= 0.0 && thrust <= limit) << thrust;
    }
  }
}

TEST(Mixer, YawGivesWayToRollAndPitchAndTheseToThrust) {
  const MultirotorParameters p = hummingbird();
  const auto got = [&p](const Demand& demand) { return unmix(p, mix(p, demand)); };
  const Demand yaw = got({7.0, {0.3, -0.2, 5.0}});
  EXPECT_NEAR(yaw.thrust_N, 7.0, 1e-9);
  EXPECT_NEAR(yaw.torque_B_N_m.x, 0.3, 1e-9);
  EXPECT_NEAR(yaw.torque_B_N_m.y, -0.2, 1e-9);
  EXPECT_GT(yaw.torque_B_N_m.z, 0.0);
  EXPECT_LT(yaw.torque_B_N_m.z, 0.2);
  const Demand roll_and_pitch = got({7.0, {6.0, 3.0, 0.0}});
  EXPECT_NEAR(roll_and_pitch.thrust_N, 7.0, 1e-9);
  EXPECT_NEAR(roll_and_pitch.torque_B_N_m.x, 2 * roll_and_pitch.torque_B_N_m.y, 1e-9);
  EXPECT_GT(roll_and_pitch.torque_B_N_m.x, 0.3);
  EXPECT_NEAR(got({100.0, {}}).thrust_N, 4 * max_rotor_thrust_N(p), 1e-9);
  EXPECT_EQ(got({-100.0, {}}).thrust_N, 0.0);
}

TEST(Mixer, ClockwiseRotorsPushTheYawCounterClockwise) {
  const MultirotorParameters p = hummingbird();
  const RotorThrusts thrusts = mix(p, {7.0, {0, 0, 0.05}});
  for (std::size_t i = 0; i < p.rotors.size(); ++i) {
    EXPECT_EQ(thrusts[i] > 7.0 / 4, p.rotors[i].direction < 0) << i;
  }
}

}  // namespace
}  // namespace tether::uav
