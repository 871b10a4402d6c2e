#include "local_program.h"

#include "sut_environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::runner {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const scenario::Sut kSut{{"fly", "task"}, {{"max_frames", "5"}, {"to", "box"}}};

scenario::Target target(const std::vector<std::string>& launcher, const std::string& folder) {
  scenario::Target target;
  target.file = std::filesystem::path("/targets/t.toml");
  target.name = std::string("t");
  target.launcher = launcher;
  target.program_folder = folder;
  return target;
}

TEST(ProgramOnTarget, MakesParametersOptions) {
  EXPECT_THAT(sut_command(kSut, {}).words,
              ElementsAre("fly", "task", "--max-frames", "5", "--to", "box"));
}

TEST(ProgramOnTarget, BeginsWithTheLauncherAndFindsTheProgramInTheTargetsFolder) {
  EXPECT_THAT(
      sut_command({{"fly", "task"}, {}}, target({"emulate", "-L", "/root"}, "/arm/bin")).words,
      ElementsAre("emulate", "-L", "/root", "/arm/bin/fly", "task"));
  EXPECT_THAT(sut_command({{"/own/fly"}, {}}, target({}, "/arm/bin")).words,
              ElementsAre("/own/fly"));
}

TEST(ProgramOnTarget, StartsAConcurrentProgramUnderTetherExecBeforeAnythingElse) {
  const scenario::Sut concurrent{{"fly", "task"}, {}, true};
  EXPECT_THAT(sut_command(concurrent, {}).words, ElementsAre("tether-exec", "fly", "task"));
  const auto command = sut_command(concurrent, target({"emulate"}, "/arm/bin"));
  EXPECT_THAT(command.words, ElementsAre("tether-exec", "emulate", "/arm/bin/fly", "task"));
  EXPECT_EQ(command.words[command.program], "/arm/bin/fly");
}

TEST(LocalProgram, TakesProgramsThatAreNoneOfThisMachine) {
  const ScratchFolder scratch;
  const std::string program = scratch.write("bin/fly", "not for this machine");
  const auto command = local_sut_command({{"fly"}, {}}, target({"/bin/sh"}, scratch.path("bin")));
  EXPECT_THAT(command.words, ElementsAre("/bin/sh", program));
  EXPECT_THAT(command.programs, ElementsAre("/bin/sh", program));
}

TEST(LocalProgram, GivesALauncherTheWholePath) {
  const auto command = local_sut_command({{"sh"}, {}}, target({"/bin/sh"}, ""));
  EXPECT_TRUE(std::filesystem::path(command.words[1]).is_absolute()) << command.words[1];
  EXPECT_THAT(local_sut_command({{"sh"}, {}}, {}).words, ElementsAre("sh")) << "as the user wrote";
}

TEST(LocalProgram, NamesTheProgramThatIsMissing) {
  const auto error = [](const std::vector<std::string>& launcher, const std::string& folder) {
    return error_message(ErrorCode::kSetup, [&] {
      local_sut_command({{"fly"}, {}}, target(launcher, folder));
    });
  };
  EXPECT_THAT(error({"/bin/sh"}, "/nowhere/bin"),
              HasSubstr("no program /nowhere/bin/fly, which the target \"t\" of /targets/t.toml"));
  EXPECT_THAT(error({}, "/nowhere/bin"), HasSubstr("\"/nowhere/bin/fly\""));
  EXPECT_THAT(error({"no-such-launcher"}, "/bin"), HasSubstr("/bin/fly"));
  EXPECT_THAT(error_message(ErrorCode::kSetup,
                            [&] {
                              local_sut_command({{"sh"}, {}}, target({"no-such-launcher"}, ""));
                            }),
              HasSubstr("\"no-such-launcher\""));
}

TEST(CpusFor, TakesTheLastOnesAndGivesEachSutItsOwn) {
  const std::vector<int> allowed{0, 1, 4, 5, 9};
  EXPECT_THAT(cpus_for(allowed, 2, 0), ElementsAre(9, 5));
  EXPECT_THAT(cpus_for(allowed, 2, 1), ElementsAre(4, 1));
  EXPECT_THAT(cpus_for(allowed, 5, 0), ElementsAre(9, 5, 4, 1, 0));
  EXPECT_THAT(cpus_for(allowed, 2, 2), IsEmpty());
  EXPECT_THAT(cpus_for(allowed, 0, 3), IsEmpty());
}

}  // namespace
}  // namespace tether::runner
