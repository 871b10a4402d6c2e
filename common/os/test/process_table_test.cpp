#include <algorithm>
#include <csignal>
#include <ctime>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/os/process_table.h>

namespace tether::os {
namespace {

/// A child that stops, having done as told.
template <class Before>
pid_t stopped_child(const Before& before) {
  const pid_t child = fork();
  if (child == 0) {
    before();
    raise(SIGSTOP);
    _exit(0);
  }
  siginfo_t info{};
  waitid(P_PID, static_cast<id_t>(child), &info, WSTOPPED);
  return child;
}

class ProcessTable : public testing::Test {
 protected:
  ~ProcessTable() override { end(); }
  static void end() {
    for (const pid_t child : children_of(getpid())) kill(child, SIGKILL);
    while (waitpid(-1, nullptr, 0) > 0) continue;
  }
};

bool contains(const std::vector<pid_t>& processes, pid_t process) {
  return std::find(processes.begin(), processes.end(), process) != processes.end();
}

TEST_F(ProcessTable, ShowsAChild) {
  const pid_t child = stopped_child([] { setpgid(0, 0); });
  const auto stat = process_stat(child);
  ASSERT_TRUE(stat);
  EXPECT_EQ(stat->state, 'T');
  EXPECT_EQ(stat->parent, getpid());
  EXPECT_EQ(stat->group, child);
  EXPECT_EQ(stat->waited_children, Duration(0));
  EXPECT_FALSE(stat->ignores_child_end);
  EXPECT_TRUE(contains(all_processes(), child));
  EXPECT_EQ(children_of(getpid()), std::vector<pid_t>{child});
  EXPECT_EQ(children_of(child), std::vector<pid_t>{});
  end();
  EXPECT_FALSE(process_stat(child));
  EXPECT_EQ(children_of(getpid()), std::vector<pid_t>{});
}

TEST_F(ProcessTable, ShowsWhatAProcessKnowsOfItsChildren) {
  const pid_t child = stopped_child([] {
    const pid_t grandchild = fork();
    if (grandchild == 0) {
      const auto begin = std::clock();
      while (std::clock() - begin < CLOCKS_PER_SEC / 10) continue;
      _exit(0);
    }
    waitpid(grandchild, nullptr, 0);
    signal(SIGCHLD, SIG_IGN);
  });
  const auto stat = process_stat(child);
  ASSERT_TRUE(stat);
  EXPECT_GE(stat->waited_children, std::chrono::milliseconds(80));
  EXPECT_LE(stat->waited_children, std::chrono::milliseconds(200));
  EXPECT_TRUE(stat->ignores_child_end);
}

TEST_F(ProcessTable, FindsTheChildrenOfEveryThread) {
  pid_t child = 0;
  std::thread([&child] {
    child = stopped_child([] {});
    EXPECT_EQ(children_of(getpid()), std::vector<pid_t>{child});
  }).join();
  EXPECT_EQ(children_of(getpid()), std::vector<pid_t>{child});
}

}  // namespace
}  // namespace tether::os
