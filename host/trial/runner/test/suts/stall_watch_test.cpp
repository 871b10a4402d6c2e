#include "suts/stall_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tether::runner {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

HostClocks at(Duration running, Duration suspended = Duration(0)) {
  return {WallTime(running), WallTime(running + suspended)};
}

coordinator::RunStatus status(const std::string& blocked) {
  coordinator::RunStatus status;
  status.st = SimTime(seconds(3));
  status.blocked = blocked;
  return status;
}

StallWatch quiet_watch() {
  return {[] { return std::nullopt; }, at(seconds(0))};
}

TEST(StallWatch, ReportsEachStallOnce) {
  StallWatch watch = quiet_watch();
  EXPECT_EQ(watch.check(status(""), at(milliseconds(20))), "");
  EXPECT_EQ(watch.check(status("a waits for b"), at(milliseconds(40))), "a waits for b");
  EXPECT_EQ(watch.check(status("a waits longer for b"), at(milliseconds(60))), "");
  EXPECT_EQ(watch.check(status(""), at(milliseconds(80))), "");
  EXPECT_EQ(watch.check(status("a waits for c"), at(milliseconds(100))), "a waits for c");
  EXPECT_THAT(watch.notes(at(milliseconds(100))), IsEmpty());
}

TEST(StallWatch, NotesAStoppedSutOnce) {
  int asked = 0;
  StallWatch watch(
      [&]() -> std::optional<std::string> {
        ++asked;
        return "it was stopped";
      },
      at(seconds(0)));
  EXPECT_EQ(watch.check(status("blocked"), at(milliseconds(0))), "blocked; it was stopped");
  for (int i = 1; i < 150; ++i)
    EXPECT_EQ(watch.check(status("blocked"), at(milliseconds(20 * i))), "");
  EXPECT_EQ(asked, 3);
  EXPECT_THAT(watch.notes(at(seconds(3))), ElementsAre("it was stopped at ST 3.000000 s"));
  EXPECT_EQ(watch.stopped_program(), "it was stopped at ST 3.000000 s");
}

TEST(StallWatch, NotesAStallOfTheCoordinator) {
  StallWatch watch = quiet_watch();
  watch.check(status(""), at(seconds(2)));
  EXPECT_THAT(watch.notes(at(seconds(2))), IsEmpty());
  watch.check(status(""), at(milliseconds(7'500)));
  EXPECT_THAT(watch.notes(at(milliseconds(7'500))),
              ElementsAre(AllOf(HasSubstr("5.5 s"), HasSubstr("ST 3.000 s"))));
  EXPECT_EQ(watch.stopped_program(), "");
}

TEST(StallWatch, NotesASuspendedMachine) {
  const StallWatch watch = quiet_watch();
  EXPECT_THAT(watch.notes(at(seconds(9), milliseconds(1))), IsEmpty());
  EXPECT_THAT(watch.notes(at(seconds(9), seconds(60))), ElementsAre(HasSubstr("60.0 s")));
}

TEST(StoppedProcess, IsFoundByItsGroupWithAndWithoutADebugger) {
  ASSERT_EQ(setpgid(0, 0), 0);  // a separate group, because other tests stop processes, too
  for (const bool debugged : {false, true}) {
    const pid_t child = fork();
    if (child == 0) {
      setpgid(0, 0);
      if (debugged) ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
      raise(SIGSTOP);
      _exit(0);
    }
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, WUNTRACED), child);
    EXPECT_TRUE(WIFSTOPPED(status));
    EXPECT_EQ(stopped_process(child), child);
    EXPECT_EQ(stopped_process(getpgrp()), std::nullopt);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
}

}  // namespace
}  // namespace tether::runner
