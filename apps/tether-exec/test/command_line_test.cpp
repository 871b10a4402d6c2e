#include "command_line.h"

#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::exec {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(CommandLine, OptionsEndWhereTheCommandBegins) {
  const Parsed parsed =
      parse_command_line({"--verbose", "--freezer", "signal", "fly", "--verbose", "-x"});
  ASSERT_FALSE(parsed.notice);
  EXPECT_TRUE(parsed.settings.verbose);
  EXPECT_EQ(parsed.settings.freezer, supervisor::FreezerChoice::kSignal);
  EXPECT_THAT(parsed.settings.command, ElementsAre("fly", "--verbose", "-x"));
}

TEST(CommandLine, TheCommandMayLookLikeAnOption) {
  const Parsed parsed = parse_command_line({"--freezer=cgroup", "--", "-fly"});
  ASSERT_FALSE(parsed.notice);
  EXPECT_EQ(parsed.settings.freezer, supervisor::FreezerChoice::kCgroup);
  EXPECT_FALSE(parsed.settings.verbose);
  EXPECT_THAT(parsed.settings.command, ElementsAre("-fly"));
}

TEST(CommandLine, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(parse_command_line({"--help"}).notice->exit_code, 0);
  EXPECT_THAT(parse_command_line({"--help"}).notice->text, HasSubstr("Examples:"));
  EXPECT_THAT(parse_command_line({"--version"}).notice->text, HasSubstr("tether-exec "));
}

TEST(CommandLine, SaysWhatIsWrong) {
  const auto expect = [](const std::vector<std::string>& arguments, const std::string& words) {
    const Parsed parsed = parse_command_line(arguments);
    ASSERT_TRUE(parsed.notice) << words;
    EXPECT_EQ(parsed.notice->exit_code, 2);
    EXPECT_THAT(parsed.notice->text, HasSubstr(words));
  };
  expect({}, "no command");
  expect({"--verbose"}, "no command");
  expect({"--"}, "no command");
  expect({"--loud", "fly"}, "no option --loud");
  expect({"--freezer", "ice", "fly"}, "'ice'; allowed are auto, cgroup and signal");
  expect({"--freezer"}, "--freezer needs a value: auto, cgroup or signal");
}

class ExecEnvironment : public testing::Test {
 protected:
  void SetUp() override {
    ::setenv("TETHER_ADDRESS", "127.0.0.1:5200", 1);
    ::setenv("TETHER_TOKEN", "secret", 1);
  }
  void TearDown() override {
    for (const char* name : {"TETHER_ADDRESS", "TETHER_TOKEN", "TETHER_UAV", "TETHER_CLOCK"}) {
      ::unsetenv(name);
    }
  }
  supervisor::Settings settings_;
};

TEST_F(ExecEnvironment, GivesCoordinatorAndClock) {
  ::setenv("TETHER_UAV", "uav2", 1);
  ::setenv("TETHER_CLOCK", "wall*2.5", 1);
  ASSERT_TRUE(read_environment(settings_).ok());
  EXPECT_EQ(settings_.coordinator, (link::Address{"127.0.0.1", 5200}));
  EXPECT_EQ(settings_.token, "secret");
  EXPECT_EQ(settings_.uav, "uav2");
  EXPECT_EQ(settings_.factor, 2.5);
}

TEST_F(ExecEnvironment, OnlyTheWallClockIsATimeLineOfThreads) {
  for (const char* clock : {"cpu", "cpu*4", "scripted*5"}) {
    ::setenv("TETHER_CLOCK", clock, 1);
    const Status read = read_environment(settings_);
    ASSERT_FALSE(read.ok()) << clock;
    EXPECT_THAT(read.failure().message, HasSubstr("TETHER_CLOCK"));
  }
}

TEST_F(ExecEnvironment, SaysWhatIsMissing) {
  ::unsetenv("TETHER_ADDRESS");
  EXPECT_THAT(read_environment(settings_).failure().message,
              HasSubstr("TETHER_ADDRESS is not set"));
}

}  // namespace
}  // namespace tether::exec
