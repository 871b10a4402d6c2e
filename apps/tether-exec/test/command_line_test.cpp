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
  const Parsed separated = parse_command_line({"--freezer=cgroup", "--", "-fly"});
  ASSERT_FALSE(separated.notice);
  EXPECT_EQ(separated.settings.freezer, supervisor::FreezerChoice::kCgroup);
  EXPECT_FALSE(separated.settings.verbose);
  EXPECT_THAT(separated.settings.command, ElementsAre("-fly"));
}

TEST(CommandLine, HasTheGroupOfSeveralPrograms) {
  const Parsed group = parse_command_line({"--group=s", "--members", "3", "--verbose"});
  ASSERT_FALSE(group.notice);
  EXPECT_EQ(group.settings.group, "s");
  EXPECT_EQ(group.settings.members, 3);
  const Parsed member = parse_command_line({"--group", "s", "fly", "--members"});
  ASSERT_FALSE(member.notice);
  EXPECT_EQ(member.settings.members, 0);
  EXPECT_THAT(member.settings.command, ElementsAre("fly", "--members"));
}

TEST(CommandLine, HasProgramsThatFlyAsTheyAre) {
  const Parsed one = parse_command_line({"--as-is", "fly"});
  EXPECT_TRUE(one.is_as_is && !one.has_all_processes && !one.notice);
  const Parsed all = parse_command_line({"--as-is", "--all-processes", "fly", "--as-is"});
  EXPECT_TRUE(all.is_as_is && all.has_all_processes && !all.notice);
  EXPECT_THAT(all.settings.command, ElementsAre("fly", "--as-is"));
}

TEST(CommandLine, PrintsHelpVersionAndErrors) {
  struct Case {
    std::vector<std::string> arguments;
    int exit_code;
    const char* text;
  };
  const Case cases[] = {{{"--help"}, 0, "Examples:"},
                        {{"--version"}, 0, "tether-exec "},
                        {{}, 2, "command"},
                        {{"--verbose"}, 2, "command"},
                        {{"--"}, 2, "command"},
                        {{"--loud", "fly"}, 2, "--loud"},
                        {{"--freezer", "ice", "fly"}, 2, "'ice'"},
                        {{"--freezer"}, 2, "--freezer"},
                        {{"--group"}, 2, "--group"},
                        {{"--group", "s"}, 2, "command"},
                        {{"--members", "2"}, 2, "--group"},
                        {{"--group", "s", "--members", "0"}, 2, "'0'"},
                        {{"--group", "s", "--members", "2x"}, 2, "'2x'"},
                        {{"--group", "s", "--members=2", "fly"}, 2, "--group"},
                        {{"--verbose", "--group=s", "fly"}, 2, "--verbose"},
                        {{"--freezer=auto", "--group=s", "fly"}, 2, "--freezer"},
                        {{"--all-processes", "fly"}, 2, "--as-is"},
                        {{"--as-is", "--all-processes"}, 2, "command"}};
  for (const Case& c : cases) {
    const Parsed parsed = parse_command_line(c.arguments);
    ASSERT_TRUE(parsed.notice) << c.text;
    EXPECT_EQ(parsed.notice->exit_code, c.exit_code);
    EXPECT_THAT(parsed.notice->text, HasSubstr(c.text));
  }
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

TEST_F(ExecEnvironment, HasTheCoordinatorAndTheClock) {
  ::setenv("TETHER_UAV", "uav2", 1);
  EXPECT_TRUE(is_wall_clock()) << "unless another one is named";
  ::setenv("TETHER_CLOCK", "wall*2.5", 1);
  EXPECT_TRUE(is_wall_clock());
  ASSERT_TRUE(read_environment(settings_).ok());
  EXPECT_EQ(settings_.coordinator, (link::Address{"127.0.0.1", 5200}));
  EXPECT_EQ(settings_.token, "secret");
  EXPECT_EQ(settings_.uav, "uav2");
  EXPECT_EQ(settings_.factor, 2.5);
}

TEST_F(ExecEnvironment, MustHaveAnAddressAndAWallClock) {
  for (const char* clock : {"cpu", "cpu*4", "scripted*5"}) {
    ::setenv("TETHER_CLOCK", clock, 1);
    EXPECT_THAT(read_environment(settings_).failure().message, HasSubstr("TETHER_CLOCK")) << clock;
    EXPECT_FALSE(is_wall_clock()) << clock;
  }
  ::unsetenv("TETHER_CLOCK");
  ::unsetenv("TETHER_ADDRESS");
  EXPECT_THAT(read_environment(settings_).failure().message, HasSubstr("TETHER_ADDRESS"));
}

}  // namespace
}  // namespace tether::exec
