#include "support/companion_flight.h"

#include <algorithm>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/mavlink/frame.h>
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

using SwarmWithFlightControllers = FlightControllerTest;

TEST_F(SwarmWithFlightControllers, TenCompanionsFlyEachItsSquare) {
  uavs_ = 10;
  ASSERT_EQ(fly("0.01"), 0) << said_;
  EXPECT_TRUE(result_["audit"]["passed"]) << result_["audit"]["summary"];
  ASSERT_EQ(result_["suts"].size(), 10U);
  for (const auto& sut : result_["suts"])
    for (const auto& error_m : sut["details"]["errors_m"]) EXPECT_LT(error_m.get<double>(), 0.05);
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

/// Looks on from a thread, and sends a command to land for each fiftieth datagram that it sees:
/// answers are datagrams, too.
class Viewer {
 public:
  Viewer() {
    const sockaddr_in any{
        .sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(INADDR_LOOPBACK)}, .sin_zero = {}};
    ::bind(socket_, reinterpret_cast<const sockaddr*>(&any), sizeof any);
    sockaddr_in own{};
    socklen_t size = sizeof own;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
    port_ = ntohs(own.sin_port);
    thread_ = std::thread([this] { look(); });
  }
  ~Viewer() { end(); }
  /// How many datagrams it has seen.
  int end() {
    ::shutdown(socket_, SHUT_RDWR);  // wakes it
    if (thread_.joinable()) thread_.join();
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
    return seen_;
  }
  std::string settings(const std::string& what) const {
    return R"({ kind = "built-in", ground_station = ")" + what +
           "\", ground_station_port = " + std::to_string(port_) + " }";
  }

 private:
  void look() {
    constexpr int kLand = 21;
    const auto land = mavlink::encode(
        mavlink::Message("COMMAND_LONG").set("command", kLand).set("target_system", 1), {255, 190},
        0);
    std::uint8_t bytes[4096];
    sockaddr_in from{};
    socklen_t size = sizeof from;
    while (::recvfrom(socket_, bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size) >
           0) {
      if (++seen_ % 50 != 0) continue;
      ::sendto(socket_, land.data(), land.size(), 0, reinterpret_cast<const sockaddr*>(&from),
               size);
    }
  }

  int socket_ = ::socket(AF_INET, SOCK_DGRAM, 0);
  std::uint16_t port_ = 0;
  int seen_ = 0;
  std::thread thread_;
};

TEST_F(FlightControllerTest, AGroundStationThatLooksOnChangesNoByteOfTheRecord) {
  ASSERT_EQ(fly("0.01"), 0) << said_;
  const std::string alone = read_text(folder_ / "out/record.mcap");
  Viewer viewer;
  ASSERT_EQ(fly("0.01", viewer.settings("looks")), 0) << said_;
  EXPECT_GT(viewer.end(), 100);
  EXPECT_TRUE(read_text(folder_ / "out/record.mcap") == alone);
}

TEST_F(FlightControllerTest, AGroundStationThatMayCommandIsNoted) {
  Viewer viewer;
  EXPECT_LE(fly("0.01", viewer.settings("commands")), 1) << said_;  // it may have landed in time
  EXPECT_NE(result_.dump().find("a ground station could command"), std::string::npos);
  const record::Record record = read_record(folder_ / "out");
  EXPECT_NE(record.header.machine, "") << "it need not repeat";
  EXPECT_TRUE(std::ranges::any_of(record.autopilot, [](const auto& entry) {
    return entry.message.of_station && entry.message.name == "COMMAND_LONG";
  }));
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
