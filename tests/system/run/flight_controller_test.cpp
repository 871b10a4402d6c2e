#include "support/companion_flight.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <tether/record/messages.h>

/// A companion flies a square through the built-in flight controller.
namespace tether::system_test {
namespace {

class FlightControllerTest : public CompanionFlight {
 protected:
  /// Its program computes `computing_ms` for each call. Returns the exit code.
  int fly(const std::string& computing_ms, const std::string& controller = "\"built-in\"") {
    return CompanionFlight::fly(controller, computing_ms);
  }
};

TEST_F(FlightControllerTest, FliesACompanionsSquareAndTheRecordHasTheirMessages) {
  ASSERT_EQ(fly("0.01"), 0) << said_;
  EXPECT_TRUE(result_["audit"]["passed"]) << result_["audit"]["summary"];
  const auto& details = result_["suts"][0]["details"];
  for (const auto& error_m : details["errors_m"]) EXPECT_LT(error_m.get<double>(), 0.05);
  EXPECT_GT(details["messages"].get<int>(), 5'000);
  const record::Record record = read_record(folder_ / "out");
  std::set<std::string> topics;
  for (const auto& entry : record.autopilot)
    topics.insert(std::string(entry.message.direction()) + "/" + entry.message.name);
  for (const char* topic :
       {"to/COMMAND_LONG", "to/SET_POSITION_TARGET_LOCAL_NED", "from/HEARTBEAT", "from/COMMAND_ACK",
        "from/LOCAL_POSITION_NED", "from/STATUSTEXT", "from/EXTENDED_SYS_STATE"})
    EXPECT_TRUE(topics.contains(topic)) << topic;
  EXPECT_NE(read_text(folder_ / "out/record.mcap").find("/autopilot/uav1/from/HEARTBEAT"),
            std::string::npos)
      << "a topic for each message, for Foxglove";
}

// The program sends a set-point each 50 ms.
TEST_F(FlightControllerTest, SetPointsThatComeTooLateEndOffboard) {
  ASSERT_EQ(fly("0.01", R"({ kind = "built-in", parameters = { COM_OF_LOSS_T = 0.03 } })"), 0)
      << said_;
  const auto& details = result_["suts"][0]["details"];
  EXPECT_NE(details["said"].get<std::string>().find("no set-points: AUTO.LOITER"),
            std::string::npos);
  EXPECT_GT(details["errors_m"][0].get<double>(), 0.5) << "it holds instead";
  EXPECT_TRUE(result_["audit"]["passed"]) << result_["audit"]["summary"];
}

// It cannot read its telemetry as fast as this comes, and what waits for it is older and older.
TEST_F(FlightControllerTest, ASlowComputerMissesTheGoal) {
  EXPECT_EQ(fly("4"), 1) << said_;
  EXPECT_TRUE(result_["audit"]["passed"]) << result_["audit"]["summary"];
  const record::Record record = read_record(folder_ / "out");
  EXPECT_TRUE(std::ranges::any_of(record.autopilot, [](const auto& entry) {
    return entry.message.outcome == record::kInboxFull;
  }));
}

}  // namespace
}  // namespace tether::system_test
