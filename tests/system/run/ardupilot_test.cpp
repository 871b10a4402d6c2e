#include "support/companion_flight.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Flights by ArduPilot, or by a peer that behaves as it does (programs/fake_ardupilot.cpp).
namespace tether::system_test {
namespace {

using testing::HasSubstr;

class ArduPilotFlight : public CompanionFlight {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "build/bin");
    std::filesystem::copy_file(FAKE_ARDUPILOT_PROGRAM, folder_ / "build/bin/arducopter");
  }
  /// Returns the exit code.
  int fly(const std::string& settings, const std::string& out = "out") {
    return CompanionFlight::fly("{ kind = \"ardupilot\", " + settings + " }", "0.01", out);
  }
};

TEST_F(ArduPilotFlight, ACompanionFliesASquareAndTwoFlightsAreTheSame) {
  ASSERT_EQ(fly("path = \"build\""), 0) << said_;
  EXPECT_TRUE(result_["audit"]["passed"]) << result_["audit"]["summary"];
  for (const auto& error_m : result_["suts"][0]["details"]["errors_m"])
    EXPECT_LT(error_m.get<double>(), 0.2);
  EXPECT_THAT(read_record(folder_ / "out").header.suts[0].controller->name, "ArduPilot 4.6.0");
  const auto digest = result_["flight_digest"];
  ASSERT_EQ(fly("path = \"build\"", "again"), 0) << said_;
  EXPECT_EQ(result_["flight_digest"], digest);
}

TEST_F(ArduPilotFlight, AFailureIsOneLineAndWhatToDo) {
  EXPECT_EQ(fly("path = \"nowhere\""), 3);
  EXPECT_THAT(said_, HasSubstr("has no bin/arducopter. 'path' must be the folder of ArduPilot's "
                               "build"));
  EXPECT_EQ(fly("path = \"build\", parameters = { FAKE_END = 1 }"), 3);
  EXPECT_THAT(said_, HasSubstr("ArduPilot of UAV 'uav1' exited with code 7: \"ERROR [fake] the end "
                               "that was asked for\""));
  EXPECT_EQ(fly("path = \"build\", parameters = { FAKE_END = 4 }"), 3);
  EXPECT_THAT(said_, HasSubstr("exited with code 7"));
  EXPECT_EQ(fly("path = \"build\", boot_s = 5, parameters = { FAKE_UNFIT = 1 }"), 3);
  EXPECT_THAT(said_, HasSubstr("ArduPilot of UAV 'uav1' is not ready to arm after 5 s of its time: "
                               "\"PreArm: unfit, as asked for\""));
  // 4.4.1
  EXPECT_EQ(fly("path = \"build\", parameters = { FAKE_VERSION = 67371264 }"), 3);
  EXPECT_THAT(said_, HasSubstr("ArduPilot of UAV 'uav1' is version 4.4.1. Use 4.5 or later"));
  EXPECT_EQ(fly("path = \"build\", parameters = { FAKE_SERVOS = 32 }"), 3);
  EXPECT_THAT(said_, HasSubstr("sends servos in a format that is not known (72 bytes)"));
}

}  // namespace
}  // namespace tether::system_test
