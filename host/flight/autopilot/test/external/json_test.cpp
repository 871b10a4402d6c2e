#include "external/json.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tether::autopilot {
namespace {

using std::chrono::milliseconds;
using testing::DoubleNear;
using testing::ElementsAre;

Bytes servos(std::uint16_t magic, std::size_t count) {
  Bytes bytes = {static_cast<std::uint8_t>(magic & 0xff),
                 static_cast<std::uint8_t>(magic >> 8),
                 0xb0,
                 0x04,
                 0x05,
                 0x00,
                 0x01,
                 0x00};
  for (std::size_t i = 0; i < count; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(0xe8 + i));
    bytes.push_back(0x03);
  }
  return bytes;
}

TEST(Json, ServosHaveTheirStepAndPulses) {
  const auto decoded = decode_servos(servos(18458, 16));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->step, 65541U);
  EXPECT_EQ(decoded->pwm[0], 1000);
  EXPECT_EQ(decoded->pwm[3], 1003);
  EXPECT_EQ(decoded->pwm[15], 1015);
}

TEST(Json, OtherDatagramsAreNoServos) {
  EXPECT_FALSE(decode_servos({}));
  EXPECT_FALSE(decode_servos(servos(18458, 15)));
  EXPECT_FALSE(decode_servos(servos(29569, 32))) << "of 32 servos";
  EXPECT_FALSE(decode_servos(servos(29569, 16)));
}

// Looks north-west, 2 m east and 3 m north, climbs, and turns to the left.
TEST(Json, TheStateIsInNedAndFrd) {
  const uav::BodyState truth{{2.0, 3.0, 1.5},
                             uav::from_axis_angle({0.0, 0.0, 1.0}, 0.75 * std::numbers::pi),
                             {0.1, 0.2, 0.4},
                             {}};
  const Readings readings{
      .specific_force_B_m_s2 = {0.5, 0.25, 9.8}, .w_WB_B_rad_s = {0.0, 0.0, 0.5}, .field_B_T = {}};
  const std::string text = json_state(milliseconds(12), {}, truth, readings);
  EXPECT_EQ(text.front(), '\n') << "a line begins and ends";
  EXPECT_EQ(text.back(), '\n');
  const auto json = nlohmann::json::parse(text);
  const auto near = [&](const nlohmann::json& list, double x, double y, double z) {
    EXPECT_THAT(list.get<std::vector<double>>(),
                ElementsAre(DoubleNear(x, 1e-8), DoubleNear(y, 1e-8), DoubleNear(z, 1e-8)));
  };
  near(json["position"], 3.0, 2.0, -1.5);
  near(json["velocity"], 0.2, 0.1, -0.4);
  near(json["imu"]["accel_body"], 0.5, -0.25, -9.8);
  near(json["imu"]["gyro"], 0.0, 0.0, -0.5);
  // 45 degrees to the left of north.
  EXPECT_NEAR(json["quaternion"][0].get<double>(), std::cos(std::numbers::pi / 8), 1e-8);
  EXPECT_NEAR(json["quaternion"][3].get<double>(), -std::sin(std::numbers::pi / 8), 1e-8);
}

TEST(Json, NorthIsThatOfThePlace) {
  sim::Place place;
  place.heading_rad = std::numbers::pi / 2.0;  // north is along -x of W
  const uav::BodyState truth{{-1.0, 0.0, 0.0}, {}, {}, {}};
  const auto json = nlohmann::json::parse(json_state({}, place, truth, {}));
  EXPECT_NEAR(json["position"][0].get<double>(), 1.0, 1e-8);
  EXPECT_NEAR(std::abs(json["quaternion"][3].get<double>()), 1.0, 1e-8) << "it looks south";
}

// As ArduPilot counts: whole microseconds of each step.
TEST(Json, NoMicrosecondIsLostInManySteps) {
  std::int64_t clock_us = 0;
  double last_s = 0.0;
  for (std::int64_t step = 1; step <= 100'000; ++step) {
    const std::string text = json_state(step * milliseconds(1), {}, {}, {});
    const double now_s = std::strtod(text.c_str() + text.find(':') + 1, nullptr);
    clock_us += static_cast<std::int64_t>((now_s - last_s) * 1e6);
    last_s = now_s;
  }
  EXPECT_EQ(clock_us, 100'000'000);
}

TEST(Json, PulsesAreSharesOfTheFullSpeed) {
  EXPECT_EQ(share_of_pwm(0), 0.0) << "none yet";
  EXPECT_EQ(share_of_pwm(1000), 0.0);
  EXPECT_EQ(share_of_pwm(1250), 0.25);
  EXPECT_EQ(share_of_pwm(2000), 1.0);
  EXPECT_EQ(share_of_pwm(2200), 1.0);
}

}  // namespace
}  // namespace tether::autopilot
