#include "suts/local_sut.h"

#include "suts/sut_environment.h"

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/child_process.h>

namespace tether::runner {
namespace {

using testing::ElementsAre;
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

TEST(SutCommand, TurnsParametersIntoOptions) {
  EXPECT_THAT(sut_command(kSut, {}).words,
              ElementsAre("fly", "task", "--max-frames", "5", "--to", "box"));
}

TEST(SutCommand, StartsWithTheLauncherAndUsesTheFolderOfTheTarget) {
  EXPECT_THAT(
      sut_command({{"fly", "task"}, {}}, target({"emulate", "-L", "/root"}, "/arm/bin")).words,
      ElementsAre("emulate", "-L", "/root", "/arm/bin/fly", "task"));
  EXPECT_THAT(sut_command({{"/own/fly"}, {}}, target({}, "/arm/bin")).words,
              ElementsAre("/own/fly"));
}

TEST(SutCommand, StartsAConcurrentProgramUnderTetherExec) {
  const scenario::Sut concurrent{{"fly", "task"}, {}, true};
  EXPECT_THAT(sut_command(concurrent, {}).words, ElementsAre("tether-exec", "fly", "task"));
  const auto command = sut_command(concurrent, target({"emulate"}, "/arm/bin"));
  EXPECT_THAT(command.words, ElementsAre("tether-exec", "emulate", "/arm/bin/fly", "task"));
  EXPECT_EQ(command.words[command.program], "/arm/bin/fly");
}

TEST(SutCommand, JoinsTheGroupOfItsBoard) {
  const auto command = sut_command(kSut, target({"emulate"}, "/arm/bin"), "/s");
  EXPECT_THAT(command.words, ElementsAre("tether-exec", "--group", "/s", "emulate", "/arm/bin/fly",
                                         "task", "--max-frames", "5", "--to", "box"));
  EXPECT_EQ(command.program, 4u);
  EXPECT_EQ(command.supervisor, 3u);
  EXPECT_THAT(group_command({"board", {1, 4}, "/s"}),
              ElementsAre("tether-exec", "--group", "/s", "--members", "2"));
}

// For a user who starts the programs: the group comes before its first program.
TEST(SutInstructions, HaveOneGroupForTheProgramsOfABoard) {
  scenario::Scenario scenario;
  scenario.uavs.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    scenario.uavs[i].placement.name = "uav" + std::to_string(i);
    scenario.uavs[i].sut.command = {"fly"};
  }
  const SutRun run{"127.0.0.1:4000", "token", {}, {}, {}, {{"board", {1, 2}, "/s"}}};
  EXPECT_EQ(group_of(run, 0), nullptr);
  ASSERT_NE(group_of(run, 2), nullptr);
  std::vector<std::string> commands;
  std::istringstream lines(sut_instructions(scenario, run));
  for (std::string line; std::getline(lines, line);) commands.push_back(line);
  using testing::EndsWith;
  EXPECT_THAT(commands,
              ElementsAre(EndsWith(" fly"), EndsWith(" tether-exec --group /s --members 2"),
                          EndsWith(" tether-exec --group /s fly"),
                          EndsWith(" tether-exec --group /s fly")));
  EXPECT_THAT(commands.front(), testing::Not(testing::HasSubstr("--group")));
}

// Emulators do not search for programs in PATH, and Tether also finds those beside itself.
TEST(SutInstructions, HaveThePathsOfACountedProgramAndItsEmulator) {
  scenario::Scenario scenario;
  scenario.uavs.resize(2);
  scenario.uavs[0].sut.command = scenario.uavs[1].sut.command = {"sh", "task"};
  SutRun run{"127.0.0.1:4000", "token", {}};
  run.condition.computers = {{.name = "counted", .target = target({"sh"}, ""), .by_hand = true},
                             {.name = "board", .target = target({"sh"}, "")}};
  run.condition.computers[0].target->emulator.emplace().program = "sh";
  run.condition.seats = {{.computer = 0}, {.computer = 1}};
  const std::string shell = os::find_program("sh").string();
  EXPECT_THAT(sut_instructions(scenario, run, false),
              testing::EndsWith(" " + shell + " " + shell + " task\n"))
      << "only what is started by hand";
}

TEST(LocalSut, AcceptsAProgramOfAnotherMachineWithALauncher) {
  const ScratchFolder scratch;
  const std::string program = scratch.write("bin/fly", "not for this machine");
  const auto command = local_sut_command({{"fly"}, {}}, target({"/bin/sh"}, scratch.path("bin")));
  EXPECT_THAT(command.words, ElementsAre("/bin/sh", program));
  EXPECT_THAT(command.programs, ElementsAre("/bin/sh", program));
}

TEST(LocalSut, GivesALauncherTheAbsolutePath) {
  const auto command = local_sut_command({{"sh"}, {}}, target({"/bin/sh"}, ""));
  EXPECT_TRUE(std::filesystem::path(command.words[1]).is_absolute()) << command.words[1];
  EXPECT_THAT(local_sut_command({{"sh"}, {}}, {}).words, ElementsAre("sh")) << "as the user wrote";
}

TEST(LocalSut, NamesAProgramThatDoesNotExist) {
  const auto expect_missing = [](const std::string& missing, const std::string& program,
                                 const std::vector<std::string>& launcher,
                                 const std::string& folder) {
    const Error error = thrown_error(ErrorCode::kSetup, [&] {
      local_sut_command({{program}, {}}, target(launcher, folder));
    });
    EXPECT_THAT(error.what(), testing::HasSubstr(missing));
  };
  expect_missing("/nowhere/bin/fly", "fly", {"/bin/sh"}, "/nowhere/bin");
  expect_missing("/nowhere/bin/fly", "fly", {}, "/nowhere/bin");
  expect_missing("/bin/fly", "fly", {"no-such-launcher"}, "/bin");
}

TEST(LocalSut, NamesTheLineOfALauncherThatDoesNotExist) {
  const ScratchFolder scratch;
  scenario::Scenario scenario;
  scenario.uavs.resize(1);
  scenario.uavs[0].sut.command = {"sh"};
  scenario::Condition condition;
  condition.computers[0].target = target({"no-such-launcher"}, "");
  condition.computers[0].target->file =
      scratch.write("t.toml", "name = \"t\"\nlauncher = [\"no-such-launcher\"]\n");
  const Error error = bad_file_error([&] { sut_programs(scenario, condition); });
  EXPECT_EQ(error.where(), (FileLocation{scratch.path("t.toml"), 2}));
  EXPECT_EQ(error.subject(), "launcher");
  EXPECT_THAT(error.what(), testing::HasSubstr("no-such-launcher"));
}

// The error has the scenario's file, and that of `cores` the target's.
TEST(LocalSut, ChecksTheProgramsAndCoresOfAScenario) {
  scenario::Scenario scenario;
  scenario.file = "/s.toml";
  scenario.uavs.resize(2);
  for (auto& uav : scenario.uavs) uav.sut.command = {"sh"};
  EXPECT_EQ(sut_programs(scenario, {}).size(), 1u);
  EXPECT_NO_THROW(require_sut_programs(scenario, {}));

  scenario::Condition condition;
  condition.computers[0].target = target({}, "");
  condition.computers[0].target->cores = 1 << 20;
  Error error = bad_file_error([&] { require_sut_programs(scenario, condition); });
  EXPECT_EQ(error.where().file, "/targets/t.toml");
  EXPECT_EQ(error.subject(), "cores");
  EXPECT_THAT(error.what(), testing::HasSubstr("'cores' is 1048576 for each of 2 SUTs, but"));

  scenario.uavs[1].placement.name = "uav2";
  scenario.uavs[1].sut.command = {"no-such-program-of-tether"};
  error = bad_file_error([&] { sut_programs(scenario, {}); });
  EXPECT_EQ(error.where().file, "/s.toml");
  EXPECT_EQ(error.subject(), "uav2");
}

// Its counts are in this machine's memory; others may run anywhere.
TEST(LocalSut, ChecksAProgramThatTheUserStartsOnlyIfItIsCounted) {
  scenario::Scenario scenario;
  scenario.file = "/s.toml";
  scenario.uavs.resize(1);
  scenario.uavs[0].placement.name = "uav1";
  scenario.uavs[0].sut.command = {"no-such-program-of-tether"};
  scenario::Condition by_hand;
  by_hand.computers = {{.name = "c", .target = target({"sh"}, ""), .by_hand = true}};
  by_hand.computers[0].target->cores = 1 << 20;
  by_hand.seats = {{.computer = 0}};
  EXPECT_NO_THROW(require_sut_programs(scenario, by_hand));
  by_hand.computers[0].target->emulator.emplace().program = "sh";
  EXPECT_EQ(bad_file_error([&] { require_sut_programs(scenario, by_hand); }).subject(), "uav1");

  scenario::Condition waiting;
  waiting.computers[0].target = target({"sh"}, "");
  EXPECT_NO_THROW(require_sut_programs(scenario, waiting, true));
  waiting.computers[0].target->emulator.emplace().program = "sh";
  EXPECT_EQ(bad_file_error([&] { require_sut_programs(scenario, waiting, true); }).subject(),
            "uav1");
}

TEST(LocalSut, RefusesACpuModelThatTheEmulatorLacks) {
  const ScratchFolder scratch;
  const std::string emulator =
      scratch.write("emulator", "#!/bin/sh\necho 'x86 Haswell  (Intel)'\n");
  std::filesystem::permissions(emulator, std::filesystem::perms::owner_all);
  scenario::Scenario scenario;
  scenario.uavs.resize(1);
  scenario.uavs[0].sut.command = {"/bin/true"};
  scenario::Condition condition;
  condition.computers[0].target = target({emulator}, "");
  os::Emulator& counts = condition.computers[0].target->emulator.emplace();
  counts.program = emulator;
  counts.cpu_model = "Haswell,+avx";
  EXPECT_NO_THROW(try_suts(scenario, condition));
  counts.cpu_model = "Haswel";
  const Error error = bad_file_error([&] { try_suts(scenario, condition); });
  EXPECT_EQ(error.subject(), "cpu_model");
  EXPECT_THAT(error.what(), testing::HasSubstr("did you mean \"Haswell\""));
}

TEST(LocalSut, NeedsThePluginForACountedTarget) {
  const ScratchFolder scratch;
  scenario::Scenario scenario;
  scenario.uavs.resize(1);
  scenario.uavs[0].sut.command = {"sh"};
  scenario::Condition condition;
  condition.computers[0].target = target({"sh"}, "");
  condition.computers[0].target->emulator.emplace().program = "sh";
  const std::string plugin = scratch.write("plugin.so", "");
  ::setenv("TETHER_COUNTER_PLUGIN", plugin.c_str(), 1);
  EXPECT_EQ(sut_programs(scenario, condition).back(), plugin);
  ::setenv("TETHER_COUNTER_PLUGIN", scratch.path("none").c_str(), 1);
  const Error error =
      thrown_error(ErrorCode::kSetup, [&] { require_sut_programs(scenario, condition); });
  EXPECT_EQ(error.subject(), "TETHER_COUNTER_PLUGIN");
  ::unsetenv("TETHER_COUNTER_PLUGIN");
}

TEST(CpusFor, TakesTheLastCpusAndDifferentOnesForEachSut) {
  const std::vector<int> allowed{0, 1, 4, 5, 9};
  EXPECT_THAT(cpus_for(allowed, 2, 0), ElementsAre(9, 5));
  EXPECT_THAT(cpus_for(allowed, 2, 2), ElementsAre(4, 1));
  EXPECT_THAT(cpus_for(allowed, 5, 0), ElementsAre(9, 5, 4, 1, 0));
  EXPECT_THAT(cpus_for(allowed, 2, 4), IsEmpty());
  EXPECT_THAT(cpus_for(allowed, 0, 3), IsEmpty());
}

}  // namespace
}  // namespace tether::runner
