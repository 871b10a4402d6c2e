#include "sut_processes.h"

#include "local_sut.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
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

TEST_F(Suts, AreToldHowToJoinAndWhereToLeaveFiles) {
  start({"echo $TETHER_ADDRESS $TETHER_TOKEN $TETHER_UAV; echo text >\"$TETHER_OUT/left\""});
  early_end();
  EXPECT_EQ(os::read_whole(log()), "127.0.0.1:4000 token uav1\n");
  EXPECT_EQ(os::read_whole(scratch_.path("left")), "text\n");
}

TEST_F(Suts, HaveAFolderEachWhereThereAreSeveral) {
  const std::string leave = "echo text >\"$TETHER_OUT/left\"";
  start({leave, leave});
  EXPECT_THAT(suts_.let_leave(), IsEmpty());
  for (const char* file : {"uav1/left", "uav2/left"})
    EXPECT_EQ(os::read_whole(scratch_.path(file)), "text\n");
}

TEST_F(Suts, TellHowTheFirstOneEnded) {
  start({"exec sleep 600", "echo the reason; exit 3"});
  const std::string end = early_end();
  EXPECT_THAT(end, HasSubstr("the SUT of UAV \"uav2\" ("));
  EXPECT_THAT(end, HasSubstr("exited with code 3; its last words in "));
  EXPECT_THAT(end, testing::EndsWith("sut-uav2.log: the reason"));
}

TEST_F(Suts, LeaveOutLastWordsWhereThereAreNone) {
  start({"exit 3"});
  EXPECT_THAT(early_end(), testing::EndsWith("exited with code 3"));
}

TEST_F(Suts, AreAskedAfterALossHowTheyEnded) {
  start({"kill -SEGV $$"});
  early_end();
  EXPECT_THAT(suts_.post_mortem(), testing::StartsWith("; the SUT of UAV \"uav1\""));
  EXPECT_THAT(suts_.post_mortem(), HasSubstr("was ended by signal 11 (Segmentation fault)"));
}

TEST_F(Suts, AreNotedWhenASignalEndsThemAfterTheirTask) {
  start({"exit 0", "kill -SEGV $$"});
  EXPECT_THAT(suts_.let_leave(),
              ElementsAre(HasSubstr("after it had finished: the SUT of UAV \"uav2\"")));
}

TEST_F(Suts, HaveFailedToConnectIfTheirLastWordsSaySo) {
  start({"echo 'error: cannot connect to 192.0.2.1:4000: timed out'; exit 3"});
  early_end();
  EXPECT_TRUE(suts_.has_failed_to_connect("192.0.2.1:4000"));
  EXPECT_FALSE(suts_.has_failed_to_connect("192.0.2.2:4000"));
}

TEST_F(Suts, AreNeitherLostNorBroughtBackWithoutABoard) {
  start({"exit 0"});
  EXPECT_EQ(suts_.lost(), std::nullopt);
  EXPECT_EQ(suts_.stopped(), std::nullopt);
  EXPECT_THAT(suts_.bring_back(), IsEmpty());
}

TEST_F(Suts, NeedProgramsThatAreThere) {
  scenario_.file = scratch_.path("s.toml");
  scenario_.uavs.resize(1);
  scenario_.uavs[0].placement.name = "uav1";
  scenario_.uavs[0].sut.command = {"no-such-program-of-tether"};
  EXPECT_THAT(error_message(ErrorCode::kBadFile, [&] { sut_programs(scenario_, {}); }),
              HasSubstr("s.toml: the SUT of UAV \"uav1\": cannot start \"no-such-program"));
  scenario_.uavs[0].sut.command = {"sh"};
  EXPECT_EQ(sut_programs(scenario_, {}).size(), 1u);
  EXPECT_NO_THROW(require_sut_programs(scenario_, {}));
}

}  // namespace
}  // namespace tether::runner
