#include "sut_script.h"

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/os/child_process.h>

namespace tether::board {
namespace {

constexpr Duration kScriptLimit = std::chrono::seconds(60);

std::string said_by(const std::string& script) {
  return os::run_captured({"sh"}, script, kScriptLimit).out;
}

TEST(Assign, AssignsAnyValue) {
  for (const std::string value : {"plain", "", "two words", "it's $HOME `id`\n\"x\""})
    EXPECT_EQ(said_by(assign("name", value) + "printf %s \"$name\""), value);
}

const BoardSut kSut{.uav = "uav 1",
                    .words = {"printf", "%s|", "it's", "$HOME", "two words"},
                    .program = 0,
                    .supervisor = 0,
                    .environment = {{"TETHER_TOKEN", "a 'b' $c"}},
                    .log = {}};

TEST(SutPrologue, RunsTheProgramWithUnchangedArguments) {
  const ScratchFolder folder;
  EXPECT_EQ(said_by(assign("folder", folder.path()) + sut_prologue(kSut) + "run_sut"),
            "it's|$HOME|two words|");
  EXPECT_TRUE(std::filesystem::exists(folder.path("pid.uav 1")));
}

TEST(SutPrologue, ExportsTheEnvironmentInJoin) {
  const std::string show = "sh -c 'printf %s \"${TETHER_TOKEN-none}\"'\n";
  EXPECT_EQ(said_by(sut_prologue(kSut) + show), "none");
  EXPECT_EQ(said_by(sut_prologue(kSut) + "join\n" + show), "a 'b' $c");
}

TEST(SutPrologue, NamesProgramSupervisorAndLauncher) {
  const std::string show = "printf '%s|%s|%s' \"$program\" \"$supervisor\" \"$launcher\"\n";
  EXPECT_EQ(said_by(sut_prologue(kSut) + show), "printf||");
  BoardSut sut = kSut;
  sut.words = {"tether-exec", "taskset", "1", "fly", "task"};
  sut.program = 3;
  sut.supervisor = 1;
  EXPECT_EQ(said_by(sut_prologue(sut) + show), "fly|tether-exec|taskset");
  sut.words = {"tether-exec", "fly", "task"};
  sut.program = 1;
  EXPECT_EQ(said_by(sut_prologue(sut) + show), "fly|tether-exec|");
  sut.words = {"tether-exec", "--group", "/s", "taskset", "1", "fly", "task"};
  sut.program = 5;
  sut.supervisor = 3;
  EXPECT_EQ(said_by(sut_prologue(sut) + show), "fly|tether-exec|taskset");
}

}  // namespace
}  // namespace tether::board
