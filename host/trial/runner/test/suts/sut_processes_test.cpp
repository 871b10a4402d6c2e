#include "suts/sut_processes.h"

#include <csignal>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/os/text_file.h>

namespace tether::runner {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Suts : public testing::Test {
 protected:
  /// A SUT for each script, of uav1, uav2 …
  void start(const std::vector<std::string>& scripts) {
    for (const std::string& script : scripts) {
      scenario::UavSetup uav;
      uav.placement.name = "uav" + std::to_string(scenario_.uavs.size() + 1);
      uav.sut.command = {"sh", "-c", script};
      scenario_.uavs.push_back(uav);
    }
    suts_.start(scenario_, {"127.0.0.1:4000", "token", {}}, scratch_.path());
  }
  std::string early_end() {
    std::optional<std::string> end;
    while (!end) end = suts_.early_end();
    return *end;
  }
  std::filesystem::path log() const { return scratch_.path("sut-uav1.log"); }

  ScratchFolder scratch_;
  scenario::Scenario scenario_;
  SutProcesses suts_;
};

TEST_F(Suts, GetTheirEnvironmentAndAFolder) {
  start({"echo $TETHER_ADDRESS $TETHER_TOKEN $TETHER_UAV; echo text >\"$TETHER_OUT/left\""});
  early_end();
  EXPECT_EQ(os::read_whole(log()), "127.0.0.1:4000 token uav1\n");
  EXPECT_EQ(os::read_whole(scratch_.path("left")), "text\n");
  EXPECT_EQ(suts_.lost(), std::nullopt);
  EXPECT_EQ(suts_.stopped(), std::nullopt);
  EXPECT_THAT(suts_.bring_back(), IsEmpty()) << "without a board";
}

TEST_F(Suts, EachHaveAFolderIfThereAreSeveral) {
  const std::string leave = "echo text >\"$TETHER_OUT/left\"";
  start({leave, leave});
  EXPECT_THAT(suts_.await_exit({}), IsEmpty());
  for (const char* file : {"uav1/left", "uav2/left"})
    EXPECT_EQ(os::read_whole(scratch_.path(file)), "text\n");
}

TEST_F(Suts, ReportTheFirstEndWithTheLastLineOfItsOutput) {
  start({"exec sleep 600", "echo the reason; exit 3"});
  const std::string end = early_end();
  EXPECT_THAT(end, HasSubstr("\"uav2\""));
  EXPECT_THAT(end, HasSubstr("exited with code 3"));
  EXPECT_THAT(end, testing::EndsWith("sut-uav2.log: the reason"));
}

TEST_F(Suts, NameTheMissingCallsOfAProgramThatEndsWithoutAnError) {
  start({"exit 0"});
  EXPECT_THAT(early_end(), HasSubstr("tether_finish()"));
  EXPECT_THAT(suts_.post_mortem("lost"), HasSubstr("tether_finish()"));
}

TEST_F(Suts, ReportSignals) {
  start({"exit 0", "kill -SEGV $$"});
  EXPECT_THAT(suts_.post_mortem("lost"), testing::Not(HasSubstr("tether_finish()")));
  EXPECT_THAT(suts_.post_mortem("lost", "uav2"), testing::StartsWith("; the SUT of UAV \"uav2\""));
  EXPECT_THAT(suts_.post_mortem("lost", "uav1"), testing::StartsWith("; the SUT of UAV \"uav1\""));
  EXPECT_THAT(suts_.await_exit({}), ElementsAre(HasSubstr("\"uav2\"")));
  EXPECT_THAT(suts_.post_mortem(""),
              testing::EndsWith("was ended by signal 11 (Segmentation fault)"));
}

TEST_F(Suts, NoteAnExitCodeThatContradictsTheReportedGoal) {
  start({"exit 1", "exit 1", "exit 0"});
  const auto report = [](const char* uav, bool reached) {
    coordinator::SutReport one;
    one.uav = uav;
    one.finish.emplace().reached_goal = reached;
    return one;
  };
  EXPECT_THAT(suts_.await_exit({report("uav1", false), report("uav2", true), report("uav3", true)}),
              ElementsAre(AllOf(HasSubstr("uav2"), HasSubstr("exited with code 1"))));
}

TEST_F(Suts, RepeatNoReasonThatTheyHaveReported) {
  start({"echo 'sut: call failed: no disk: full' >&2; exit 4"});
  EXPECT_THAT(suts_.post_mortem("the SUT ended the run: no disk: full"),
              testing::EndsWith("exited with code 4"));
  EXPECT_THAT(suts_.post_mortem("the SUT ended the run: no memory"),
              testing::EndsWith("sut: call failed: no disk: full"));
}

/// A process in a session of its own without its parent or its environment, as daemons are.
TEST(SutProcesses, EndTheDaemonsOfASut) {
  const ScratchFolder scratch;
  scenario::Scenario scenario;
  scenario.uavs.resize(1);
  scenario.uavs[0].placement.name = "uav1";
  const auto number = scratch.path("number");
  scenario.uavs[0].sut.command = {
      "sh", "-c",
      "(env -i setsid sh -c 'cd /; echo $$ >\"$0\"; exec sleep 600' \"$0\" &) && exit 3",
      number.string()};
  pid_t daemon = 0;
  {
    SutProcesses suts;
    suts.start(scenario, {"127.0.0.1:4000", "token", {}}, scratch.path());
    while (daemon == 0) daemon = std::atoi(os::read_whole(number).c_str());
    while (!suts.early_end()) continue;
    EXPECT_EQ(kill(daemon, 0), 0);
  }
  EXPECT_EQ(kill(daemon, 0), -1);
}

TEST_F(Suts, HaveFailedToConnectIfTheirLastLineHasTheAddress) {
  start({"echo 'error: no connection to 192.0.2.1:4000: timed out'; exit 3"});
  early_end();
  EXPECT_TRUE(suts_.has_failed_to_connect("192.0.2.1:4000"));
  EXPECT_FALSE(suts_.has_failed_to_connect("192.0.2.2:4000"));
}

}  // namespace
}  // namespace tether::runner
