#include "external/motor_layout.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace tether::autopilot {
namespace {

/// At these angles, counter-clockwise from ahead [degrees], which turn so in turn.
std::vector<uav::Rotor> rotors(std::size_t count, double first_deg, int first_direction) {
  std::vector<uav::Rotor> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = (first_deg + 360.0 * static_cast<double>(i) / static_cast<double>(count)) *
                         std::numbers::pi / 180.0;
    all.push_back({{0.2 * std::cos(angle), 0.2 * std::sin(angle), 0.0},
                   i % 2 == 0 ? first_direction : -first_direction});
  }
  return all;
}

using Motors = std::vector<std::size_t>;

TEST(MotorLayout, TheHummingbirdIsAQuadInPlusConfiguration) {
  const auto layout = motor_layout(uav::hummingbird().rotors);
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->frame_class, 1);
  EXPECT_EQ(layout->frame_type, 0);
  EXPECT_EQ(layout->motors, (Motors{2, 1, 3, 0})) << "front, left, back, right";
}

TEST(MotorLayout, AQuadInXConfigurationMayTurnEitherWay) {
  // From front left on.
  const auto layout = motor_layout(rotors(4, 45.0, -1));
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->frame_type, 1);
  EXPECT_EQ(layout->motors, (Motors{2, 1, 3, 0}));
  const auto other = motor_layout(rotors(4, 45.0, 1));
  ASSERT_TRUE(other);
  EXPECT_EQ(other->frame_type, 3);
  EXPECT_EQ(other->motors, (Motors{2, 1, 3, 0}));
  EXPECT_TRUE(motor_layout(rotors(4, 53.0, -1))) << "nearly x";
}

TEST(MotorLayout, MoreRotorsHaveFramesToo) {
  const auto hexa = motor_layout(rotors(6, 0.0, -1));
  ASSERT_TRUE(hexa);
  EXPECT_EQ(hexa->frame_class, 2);
  EXPECT_EQ(hexa->motors, (Motors{0, 4, 2, 1, 5, 3}));
  const auto hexa_x = motor_layout(rotors(6, 30.0, -1));
  ASSERT_TRUE(hexa_x);
  EXPECT_EQ(hexa_x->frame_type, 1);
  EXPECT_EQ(hexa_x->motors, (Motors{2, 1, 5, 3, 0, 4}));
  const auto octa = motor_layout(rotors(8, 0.0, -1));
  ASSERT_TRUE(octa);
  EXPECT_EQ(octa->frame_class, 3);
}

TEST(MotorLayout, OthersHaveNone) {
  EXPECT_FALSE(motor_layout(rotors(4, 20.0, -1))) << "between + and x";
  EXPECT_FALSE(motor_layout(rotors(4, 0.0, 1))) << "+ that turns the other way";
  EXPECT_FALSE(motor_layout(rotors(5, 0.0, 1)));
  EXPECT_FALSE(motor_layout({}));
  auto three = rotors(4, 45.0, -1);
  three.pop_back();
  EXPECT_FALSE(motor_layout(three));
}

}  // namespace
}  // namespace tether::autopilot
