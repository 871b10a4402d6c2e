#include "support/companion_flight.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Flights by PX4, or by a peer that behaves as it does (programs/fake_px4.cpp).
namespace tether::system_test {
namespace {

using testing::HasSubstr;

class Px4Flight : public CompanionFlight {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "build/bin");
    std::filesystem::create_directories(folder_ / "build/etc");
    std::filesystem::copy_file(FAKE_PX4_PROGRAM, folder_ / "build/bin/px4");
  }
  /// Returns the exit code.
  int fly(const std::string& settings, const std::string& out = "out") {
    return CompanionFlight::fly("{ kind = \"px4\", " + settings + " }", "0.01", out);
  }
};

// The gimbal is not PX4's, which knows no such command here.
TEST_F(Px4Flight, ACompanionFliesASquareWithAGimbalAndTwoFlightsAreTheSame) {
  model_ = "hummingbird_gimbal";
  gimbal_deg_ = "40";
  ASSERT_EQ(fly("path = \"build\", boot_s = 5"), 0) << said_;
  EXPECT_TRUE(result_["audit"]["passed"]) << result_["audit"]["summary"];
  for (const auto& error_m : result_["suts"][0]["details"]["errors_m"])
    EXPECT_LT(error_m.get<double>(), 0.2);
  const record::Record record = read_record(folder_ / "out");
  EXPECT_EQ(record.header.suts[0].controller->name, "PX4 1.16.0");
  const auto& joints_rad = record.ground_truth.back().message.joints_rad;
  EXPECT_THAT(joints_rad, testing::ElementsAre(0.0, testing::DoubleNear(0.698, 0.001)));
  // What it would send some time later in real time, it sends at its step.
  std::set<Duration> parts_of_second;
  for (const auto& entry : record.autopilot)
    if (entry.message.name == "MISSION_CURRENT")
      parts_of_second.insert(entry.message.sent_at.time_since_epoch() % std::chrono::seconds(1));
  EXPECT_EQ(parts_of_second.size(), 1U);
  const auto digest = result_["flight_digest"];
  ASSERT_EQ(fly("path = \"build\", boot_s = 5", "again"), 0) << said_;
  EXPECT_EQ(result_["flight_digest"], digest);
}

using Px4Swarm = Px4Flight;

TEST_F(Px4Swarm, TenInstancesFlyEachTheSquareOfItsCompanion) {
  uavs_ = 10;
  ASSERT_EQ(fly("path = \"build\", boot_s = 5"), 0) << said_;
  EXPECT_TRUE(result_["audit"]["passed"]) << result_["audit"]["summary"];
  ASSERT_EQ(result_["suts"].size(), 10U);
  for (const auto& sut : result_["suts"])
    for (const auto& error_m : sut["details"]["errors_m"]) EXPECT_LT(error_m.get<double>(), 0.2);
}

TEST_F(Px4Flight, WithoutAControllerThereIsOneLineAndWhatToDo) {
  EXPECT_EQ(fly("path = \"nowhere\""), 3);
  EXPECT_THAT(said_, HasSubstr("has no bin/px4. 'path' must be the folder of PX4's build"));
  EXPECT_EQ(fly("path = \"build\", parameters = { FAKE_END = 3 }"), 3);
  EXPECT_THAT(said_, HasSubstr("PX4 of UAV 'uav1' exited with code 7: \"ERROR [fake] the end that "
                               "was asked for\""));
  EXPECT_EQ(fly("path = \"build\", boot_s = 3, parameters = { FAKE_END = 4 }"), 3);
  EXPECT_THAT(said_, HasSubstr("exited with code 7"));
  // 1.13.3
  EXPECT_EQ(fly("path = \"build\", boot_s = 3, parameters = { FAKE_VERSION = 17630207 }"), 3);
  EXPECT_THAT(said_, HasSubstr("PX4 of UAV 'uav1' is version 1.13.3. Use 1.14 or later: give its "
                               "build as 'path'"));
  EXPECT_EQ(fly("path = \"build\", boot_s = 3, parameters = { FAKE_VERSION = 0 }"), 3);
  EXPECT_THAT(said_, HasSubstr("has not told its version within 3 s of its time"));
  EXPECT_EQ(fly("boot_s = 3"), 2);
  EXPECT_THAT(said_, HasSubstr("path"));
}

}  // namespace
}  // namespace tether::system_test
