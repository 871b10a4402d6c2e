#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include <tether/client/simulated_vehicle.h>

namespace tether::client {
namespace {

class Environment : public testing::Test {
 protected:
  void SetUp() override {
    set("TETHER_ADDRESS", "127.0.0.1:5200");
    set("TETHER_TOKEN", "secret");
    ::unsetenv("TETHER_UAV");
    ::unsetenv("TETHER_CLOCK");
  }
  void TearDown() override {
    for (const char* name : {"TETHER_ADDRESS", "TETHER_TOKEN", "TETHER_UAV", "TETHER_CLOCK"}) {
      ::unsetenv(name);
    }
  }
  static void set(const char* name, const std::string& value) { ::setenv(name, value.c_str(), 1); }
  static void expect_failure(const std::string& variable, const std::string& value) {
    const auto options = options_from_environment();
    ASSERT_FALSE(options.ok()) << variable << ": " << value;
    EXPECT_EQ(options.failure().kind, Failure::Kind::kInvalid);
    EXPECT_NE(options.failure().message.find(variable), std::string::npos);
    EXPECT_NE(options.failure().message.find(value), std::string::npos);
  }
};

TEST_F(Environment, GivesEverything) {
  set("TETHER_UAV", "scout");
  set("TETHER_CLOCK", "cpu*2.5");
  const auto options = options_from_environment();
  ASSERT_TRUE(options.ok()) << options.failure().message;
  EXPECT_EQ(options->address, (link::Address{"127.0.0.1", 5200}));
  EXPECT_EQ(options->token, "secret");
  EXPECT_EQ(options->uav, "scout");
  EXPECT_EQ(options->time->clock().kind, computer::ClockKind::kCpu);
  EXPECT_EQ(options->time->clock().factor, 2.5);
}

TEST_F(Environment, KnowsClocks) {
  EXPECT_EQ(options_from_environment()->uav, "");
  EXPECT_EQ(options_from_environment()->time->clock().kind, computer::ClockKind::kWall);
  for (const auto& [text, kind] :
       {std::pair{"wall", computer::ClockKind::kWall}, std::pair{"cpu", computer::ClockKind::kCpu},
        std::pair{"cpu*0.5", computer::ClockKind::kCpu},
        std::pair{"wall*4", computer::ClockKind::kWall},
        std::pair{"scripted*12.5", computer::ClockKind::kScripted}}) {
    set("TETHER_CLOCK", text);
    const auto options = options_from_environment();
    ASSERT_TRUE(options.ok()) << text;
    EXPECT_EQ(options->time->clock().kind, kind) << text;
  }
}

TEST_F(Environment, TetherExecCountsForMore) {
  set("TETHER_EXEC", "/tmp/tether-exec-1/socket");
  set("TETHER_CLOCK", "wall*4");
  const auto options = options_from_environment();
  ::unsetenv("TETHER_EXEC");
  ASSERT_TRUE(options.ok());
  EXPECT_EQ(options->exec_socket, "/tmp/tether-exec-1/socket");
  EXPECT_EQ(options->time, nullptr);
}

TEST_F(Environment, NamesTheVariableThatIsMissingOrWrong) {
  for (const std::string clock :
       {"", "clock", "cpu*", "cpu*0", "cpu*-1", "cpu*nan", "cpu*2x", "cpu*1e9", "wall*", "wall*0",
        "wall4", "cpu*2,5", "scripted", "scripted*0", "unstamped", "Wall"}) {
    set("TETHER_CLOCK", clock);
    expect_failure("TETHER_CLOCK", clock);
  }
  ::unsetenv("TETHER_CLOCK");
  set("TETHER_TOKEN", "");
  expect_failure("TETHER_TOKEN", "");
  ::unsetenv("TETHER_TOKEN");
  expect_failure("TETHER_TOKEN", "");
  set("TETHER_ADDRESS", "nowhere");
  expect_failure("TETHER_ADDRESS", "nowhere");
  ::unsetenv("TETHER_ADDRESS");
  expect_failure("TETHER_ADDRESS", "tether run");
}

}  // namespace
}  // namespace tether::client
