#include "stall_watch.h"

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

TEST(StallWatch, SaysEachStallOnce) {
  StallWatch watch = quiet_watch();
  EXPECT_EQ(watch.look(status(""), at(milliseconds(20))), "");
  EXPECT_EQ(watch.look(status("a waits for b"), at(milliseconds(40))), "a waits for b");
  EXPECT_EQ(watch.look(status("a waits longer for b"), at(milliseconds(60))), "");
  EXPECT_EQ(watch.look(status(""), at(milliseconds(80))), "");
  EXPECT_EQ(watch.look(status("a waits for c"), at(milliseconds(100))), "a waits for c");
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
  EXPECT_EQ(watch.look(status("blocked"), at(milliseconds(0))), "blocked; it was stopped");
  for (int i = 1; i < 150; ++i)
    EXPECT_EQ(watch.look(status("blocked"), at(milliseconds(20 * i))), "");
  EXPECT_EQ(asked, 3);
  EXPECT_THAT(watch.notes(at(seconds(3))), ElementsAre("it was stopped at ST 3.000000 s"));
}

TEST(StallWatch, NotesThatTheCoordinatorItselfStoodStill) {
  StallWatch watch = quiet_watch();
  watch.look(status(""), at(seconds(2)));
  EXPECT_THAT(watch.notes(at(seconds(2))), IsEmpty());
  watch.look(status(""), at(milliseconds(7'500)));
  EXPECT_THAT(watch.notes(at(milliseconds(7'500))),
              ElementsAre(HasSubstr("stalled for 5.5 s up to ST 3.000 s")));
}

TEST(StallWatch, NotesASuspendedMachine) {
  const StallWatch watch = quiet_watch();
  EXPECT_THAT(watch.notes(at(seconds(9), milliseconds(1))), IsEmpty());
  EXPECT_THAT(watch.notes(at(seconds(9), seconds(60))),
              ElementsAre("this machine was suspended for 60.0 s during the run"));
}

class StoppedProcess : public testing::Test {
 protected:
  ~StoppedProcess() override {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  /// A child in a group of its own, that stops; returns when it has.
  template <class Stop>
  void start(Stop stop) {
    child_ = fork();
    if (child_ == 0) {
      setpgid(0, 0);
      stop();
      raise(SIGSTOP);
      _exit(0);
    }
    int how = 0;
    ASSERT_EQ(waitpid(child_, &how, WUNTRACED), child_);
    ASSERT_TRUE(WIFSTOPPED(how));
  }
  pid_t child_ = 0;
};

TEST_F(StoppedProcess, IsFoundByItsGroup) {
  ASSERT_EQ(setpgid(0, 0), 0);  // of its own: tests beside this one stop processes, too
  start([] {});
  EXPECT_EQ(stopped_process(child_), child_);
  EXPECT_EQ(stopped_process(getpgrp()), std::nullopt);
}

TEST_F(StoppedProcess, IsFoundUnderADebugger) {
  start([] { ptrace(PTRACE_TRACEME, 0, nullptr, nullptr); });
  EXPECT_EQ(stopped_process(child_), child_);
}

}  // namespace
}  // namespace tether::runner
