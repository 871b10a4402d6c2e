#include <cerrno>
#include <csignal>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/child_process.h>
#include <tether/os/machine.h>
#include <tether/os/pipe.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

using testing::HasSubstr;

constexpr Duration kLong = std::chrono::seconds(60);

class Child : public testing::Test {
 protected:
  ChildCommand shell(const std::string& script) const {
    return {.arguments = {"sh", "-c", script}, .environment = {}, .log = log_};
  }
  /// How it ended.
  ChildExit run(const ChildCommand& command) const {
    ChildProcess process(command);
    EXPECT_TRUE(process.wait(kLong));
    return process.poll().value_or(ChildExit{});
  }
  std::string output_of(const ChildCommand& command) const {
    run(command);
    return read_whole(log_);
  }

  ScratchFolder scratch_;
  const std::filesystem::path log_ = scratch_.path("log");
};

TEST_F(Child, ReportsItsExitCode) {
  EXPECT_EQ(run(shell("exit 0")).description, "exited with code 0");
  EXPECT_EQ(run(shell("exit 3")).code, 3);
}

TEST_F(Child, ReportsTheSignalThatEndedIt) {
  const ChildExit exit = run(shell("kill -SEGV $$"));
  EXPECT_EQ(exit.code, kSignalled + SIGSEGV);
  EXPECT_EQ(exit.description, "was ended by signal 11 (Segmentation fault)");
}

TEST_F(Child, ReportsTheSignalThatALauncherPassesOn) {
  const ChildExit exit = run(shell("exit 137"));
  EXPECT_EQ(exit.code, 137);
  EXPECT_EQ(exit.description, "exited with code 137, as after signal 9 (Killed)");
}

TEST_F(Child, AddsVariablesToTheEnvironmentOfThisProcess) {
  ChildCommand command = shell("echo $TETHER_TEST; echo ${PATH:+path}");
  command.environment = {{"TETHER_TEST", "two words"}};
  EXPECT_EQ(output_of(command), "two words\npath\n");
}

TEST_F(Child, WritesOutputAndErrorsIntoOneLogOrTwo) {
  EXPECT_EQ(output_of(shell("echo out; echo err >&2")), "out\nerr\n");
  ChildCommand apart = shell("echo out; echo err >&2");
  apart.errors = scratch_.path("errors");
  EXPECT_EQ(output_of(apart), "out\n");
  EXPECT_EQ(read_whole(apart.errors), "err\n");
}

TEST_F(Child, AppendsToItsLogOnlyWhenAsked) {
  ChildCommand command = shell("echo line");
  output_of(command);
  EXPECT_EQ(output_of(command), "line\n");
  command.appends = true;
  EXPECT_EQ(output_of(command), "line\nline\n");
}

TEST_F(Child, ReadsAFileAPipeOrNothing) {
  EXPECT_EQ(output_of(shell("cat")), "");
  ChildCommand of_file = shell("cat");
  of_file.input = scratch_.write("input", "of the file");
  EXPECT_EQ(output_of(of_file), "of the file");

  Pipe pipe = make_pipe();
  ASSERT_TRUE(write_all(pipe.write_end, "of the pipe"));
  pipe.write_end = FileDescriptor();
  ChildCommand of_pipe = shell("cat");
  of_pipe.input_pipe = pipe.read_end.get();
  EXPECT_EQ(output_of(of_pipe), "of the pipe");
}

TEST_F(Child, StartsInItsWorkingFolder) {
  ChildCommand command = shell("pwd -P");
  command.working_folder = scratch_.path();
  EXPECT_EQ(output_of(command), std::filesystem::canonical(scratch_.path()).string() + "\n");
}

TEST_F(Child, RunsOnTheCpusThatItIsGiven) {
  const int cpu = allowed_cpus().back();
  ChildCommand command = shell("grep Cpus_allowed_list /proc/self/status");
  command.cpus = {cpu};
  EXPECT_EQ(output_of(command), "Cpus_allowed_list:\t" + std::to_string(cpu) + "\n");
}

TEST_F(Child, BlocksNoSignalsThatThisProcessBlocks) {
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  const std::string mask = output_of(shell("grep SigBlk /proc/self/status"));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EXPECT_EQ(mask, "SigBlk:\t0000000000000000\n");
}

TEST_F(Child, EndsWithItsObject) {
  pid_t pid = 0;
  {
    const ChildProcess process(shell("exec sleep 60"));
    pid = process.pid();
    EXPECT_EQ(kill(pid, 0), 0);
  }
  EXPECT_EQ(kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

TEST_F(Child, IsKilledWhenItIgnoresTheEndSignalForLongerThanItsGrace) {
  ChildCommand command = shell("trap '' TERM; echo deaf; while :; do sleep 60; done");
  command.grace = std::chrono::milliseconds(1);
  ChildProcess process(command);
  while (read_whole(log_).empty()) process.wait(Duration(0));
  process.terminate();
  EXPECT_EQ(process.poll()->code, kSignalled + SIGKILL);
}

TEST_F(Child, GetsTheEndSignalThatItsCommandNames) {
  ChildCommand command = shell("trap 'echo asked; exit 7' INT; echo ready; while :; do :; done");
  command.end_signal = SIGINT;
  command.grace = kLong;
  ChildProcess process(command);
  while (read_whole(log_).empty()) process.wait(Duration(0));
  process.terminate();
  EXPECT_EQ(process.poll()->code, 7);
  EXPECT_EQ(read_whole(log_), "ready\nasked\n");
}

TEST_F(Child, RefusesAProgramThatCannotBeStarted) {
  const auto no_program = scratch_.write("text", "no program");
  EXPECT_THAT(error_message(
                  ErrorCode::kSetup,
                  [&] { ChildProcess({.arguments = {no_program}, .environment = {}, .log = {}}); }),
              HasSubstr("cannot start \"" + no_program.string() + "\""));
  ChildCommand nowhere = shell("true");
  nowhere.working_folder = scratch_.path("none");
  EXPECT_THAT(error_message(ErrorCode::kSetup, [&] { const ChildProcess process(nowhere); }),
              HasSubstr("No such file or directory"));
}

TEST_F(Child, RefusesALogThatCannotBeOpened) {
  ChildCommand command = shell("true");
  command.log = scratch_.path("none/log");
  EXPECT_THAT(error_message(ErrorCode::kSetup, [&] { const ChildProcess process(command); }),
              HasSubstr("none/log: cannot be opened: No such file or directory"));
}

}  // namespace
}  // namespace tether::os
