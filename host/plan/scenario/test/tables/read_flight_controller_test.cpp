#include "tables/read_flight_controller.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/autopilot/external.h>
#include <tether/autopilot/flight_controller.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using testing::HasSubstr;

std::optional<FlightController> read_one(const std::string& uav) {
  const toml::Document document = toml::Document::parse("[uav]\n" + uav, "s.toml");
  return read_flight_controller(document.root().table("uav"));
}

TEST(ReadFlightController, IsNoneByDefault) {
  EXPECT_FALSE(read_one(""));
  EXPECT_FALSE(read_one("flight_controller = \"none\""));
  EXPECT_FALSE(read_one("flight_controller = { kind = \"none\" }"));
}

TEST(ReadFlightController, IsAName) {
  const auto controller = read_one("flight_controller = \"built-in\"");
  ASSERT_TRUE(controller);
  EXPECT_EQ(controller->external, nullptr);
  EXPECT_EQ(controller->link_baud, 0.0);
  EXPECT_EQ(controller->link_latency, Duration(0));
  EXPECT_FALSE(controller->starts_in_air);
  EXPECT_EQ(controller->at.line, 2);
}

TEST(ReadFlightController, IsATableWithSettings) {
  const auto controller = read_one(R"([uav.flight_controller]
kind = "built-in"
link_baud = 921600
link_latency_ms = 2.5
starts_in_air = true
parameters = { MPC_XY_CRUISE = 3, COM_OBL_RC_ACT = 4 }
)");
  ASSERT_TRUE(controller);
  EXPECT_EQ(controller->link_baud, 921'600.0);
  EXPECT_EQ(controller->link_latency, Duration(2'500'000));
  EXPECT_TRUE(controller->starts_in_air);
  EXPECT_EQ(controller->parameters,
            (std::map<std::string, double>{{"MPC_XY_CRUISE", 3.0}, {"COM_OBL_RC_ACT", 4.0}}));
}

TEST(ReadFlightController, IsOneThatTheUserBrings) {
  for (const auto& [kind, boot_s] : {std::pair{"px4", 30.0}, {"ardupilot", 90.0}}) {
    const std::string table = "[uav.flight_controller]\nkind = \"" + std::string(kind) +
                              "\"\npath = \"builds/mine\"\nparameters = { ANY_NAME_1 = -2.5 }\n";
    const auto controller = read_one(table);
    ASSERT_TRUE(controller && controller->external);
    EXPECT_EQ(controller->external->key, kind);
    EXPECT_EQ(controller->path, "builds/mine") << "beside the file";
    EXPECT_EQ(to_seconds(controller->boot), boot_s);
    EXPECT_EQ(controller->parameters.at("ANY_NAME_1"), -2.5);
    EXPECT_EQ(to_seconds(read_one(table + "boot_s = 12.5")->boot), 12.5);
  }
}

TEST(ReadFlightController, MayHaveAGroundStation) {
  const std::string table = "[uav.flight_controller]\nkind = \"built-in\"\n";
  EXPECT_EQ(read_one(table)->ground_station, autopilot::GroundStation::kAbsent);
  EXPECT_EQ(read_one(table)->ground_station_port, 14550);
  const auto looks = read_one(table + "ground_station = \"looks\"\nground_station_port = 15000");
  EXPECT_EQ(looks->ground_station, autopilot::GroundStation::kLooks);
  EXPECT_EQ(looks->ground_station_port, 15000);
  EXPECT_EQ(read_one(table + "ground_station = \"commands\"")->ground_station,
            autopilot::GroundStation::kCommands);
}

TEST(ReadFlightController, MaySignItsLink) {
  const ScratchFolder folder;
  const std::string digits(64, '7');
  folder.write("key", digits + "\n");
  folder.write("short", "77\n");
  const auto read = [&](const std::string& file) {
    return read_one("flight_controller = { kind = \"built-in\", signing_key_file = \"" +
                    (folder.path() / file).string() + "\" }");
  };
  EXPECT_EQ(read("key")->signing_key_file, folder.path() / "key");
  EXPECT_EQ(read("key")->signing_key, digits + "\n");
  EXPECT_THAT(bad_file_error([&] { read("short"); }).what(),
              HasSubstr("s.toml:2: 'signing_key_file' of [uav.flight_controller] cannot be used: a "
                        "MAVLink signing key has 32 bytes or 64 hexadecimal digits"));
  EXPECT_THAT(bad_file_error([&] { read("none"); }).what(), HasSubstr("none"));
}

TEST(ReadFlightController, RefusesBadValuesWhereTheyAre) {
  struct Case {
    const char* text;
    int line;
    const char* reason;
  };
  for (const auto& [text, line, reason] : std::initializer_list<Case>{
           {"flight_controller = \"px5\"", 2, "built-in"},
           {"flight_controller = 3", 2, "flight_controller"},
           {"[uav.flight_controller]\nkind = \"x\"", 3, "built-in"},
           {"[uav.flight_controller]\nlink_baud = 1", 2, "kind"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nlink_baud = -1", 4, "link_baud"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nlink_latency_ms = 1e9", 4, "latency"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nlink_latency_s = 1", 4, "latency"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nparameters = { MPC_SPEED = 1 }", 4,
            "no parameter of the built-in flight controller"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nparameters = { NAV_ACC_RAD = 0 }", 4,
            "it must be from 0.05 to 200"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nparameters = { NAV_ACC_RAD = \"x\" }", 4,
            "NAV_ACC_RAD"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nparameters = { COM_OBL_RC_ACT = 1.5 }",
            4, "a whole number from 0 to 5"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nground_station = \"on\"", 4, "looks"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nground_station_port = 80", 4, "1024"},
           {"flight_controller = \"ardupilot\"", 2,
            "needs settings: write [uav.flight_controller] with kind = \"ardupilot\" and the "
            "'path' of ArduPilot's build"},
           {"[uav.flight_controller]\nkind = \"ardupilot\"", 2, "path"},
           {"[uav.flight_controller]\nkind = \"px4\"\npath = \"x\"\nstarts_in_air = true", 5,
            "is of the flight controller \"built-in\" only"},
           {"[uav.flight_controller]\nkind = \"built-in\"\nboot_s = 3", 4,
            "is of flight controllers that you bring"},
           {"[uav.flight_controller]\nkind = \"ardupilot\"\npath = \"x\"\n"
            "parameters = { \"rtl alt\" = 3 }",
            5, "is no name of a parameter of ArduPilot"},
           {"flight_controller = \"built-in\"\ncommand_latency_ms = 3", 3,
            "has no effect beside 'flight_controller'"},
           {"setpoint_timeout_ms = 3\nflight_controller = \"built-in\"", 2, "COM_OF_LOSS_T"},
           {"flight_controller = \"built-in\"\non_setpoint_loss = \"land\"", 3, "no effect"}}) {
    const Error error = bad_file_error([text = text] { read_one(text); });
    EXPECT_EQ(error.where().line, line) << text;
    EXPECT_THAT(std::string(error.what()), HasSubstr(reason)) << text;
  }
}

class WithFlightController : public testing::Test {
 protected:
  Scenario load(const std::string& keys, const std::string& name = "uav1") {
    return load_scenario(folder_.write("s.toml", R"(name = "s"
world = "room"
time_limit_s = 10
)" + keys + R"(
[sut]
command = ["true"]
[[uav]]
name = ")" + name + R"("
model = "hummingbird"
position_m = [0, 0, 0.1]
flight_controller = "built-in"
[[condition]]
name = "host"

policy = "conservative_barrier"
clock = "cpu"
)"));
  }
  ScratchFolder folder_;
};

TEST_F(WithFlightController, LandsFasterThanTaskProgramsDo) {
  EXPECT_GT(load("").max_contact_speed_m_s, 0.7) << "MPC_LAND_SPEED";
  EXPECT_EQ(load("max_contact_speed_m_s = 0.3").max_contact_speed_m_s, 0.3);
}

TEST_F(WithFlightController, ItsNameIsNotThatOfAUav) {
  const Error error = bad_file_error([&] { load("", "autopilot"); });
  EXPECT_THAT(std::string(error.what()), HasSubstr("is the name of flight controllers"));
  EXPECT_GT(error.where().line, 0);
}

}  // namespace
}  // namespace tether::scenario
