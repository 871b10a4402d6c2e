#include <algorithm>
#include <array>
#include <csignal>
#include <ctime>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/base_testing/sanitizer.h>
#include <tether/os/file_descriptor.h>
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
  EXPECT_LE(stat->used, std::chrono::milliseconds(80));
  const Duration with_child = used_with_descendants();
  end();
  EXPECT_GE(with_child, std::chrono::milliseconds(80));
  EXPECT_GE(used_with_descendants(), std::chrono::milliseconds(80));
}

// Of this process there is the calling thread, which runs.
TEST_F(ProcessTable, CountsTheThreadsOfAProcessAndItsDescendantsByState) {
#if TETHER_THREAD_SANITIZER
  GTEST_SKIP() << "each process has a thread of the sanitizer, too";
#endif
  const ThreadStates alone = thread_states(getpid());
  EXPECT_EQ(alone.runnable, 1);
  stopped_child([] {
    if (fork() == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      pause();
    }
    const pid_t ended = fork();
    if (ended == 0) _exit(0);
    siginfo_t info{};
    waitid(P_PID, static_cast<id_t>(ended), &info, WEXITED | WNOWAIT);
  });
  ThreadStates states;
  do states = thread_states(getpid());
  while (states.waiting == alone.waiting);
  EXPECT_EQ(states.runnable, 1);
  EXPECT_EQ(states.waiting, alone.waiting + 1);
  EXPECT_EQ(states.halted, alone.halted + 1);
}

TEST_F(ProcessTable, CountsTurnsOnlyOfWhatRuns) {
  const pid_t sleeper = stopped_child([] {});
  EXPECT_GT(turns_of(sleeper), 0u);
  EXPECT_EQ(turns_of(sleeper), turns_of(sleeper)) << "it is stopped";
  const std::uint64_t before = turns_of(getpid());
  for (int i = 0; i < 3; ++i) usleep(1'000);
  EXPECT_GE(turns_of(getpid()), before + 3);
}

TEST_F(ProcessTable, LeavesOutThreadsOfAName) {
  std::array<char, 16> name{};
  pthread_getname_np(pthread_self(), name.data(), name.size());
  pthread_setname_np(pthread_self(), "odd) R (name");
  EXPECT_EQ(thread_states(getpid()).runnable, 1);
  const ThreadStates without = thread_states(getpid(), "odd) R (name");
  EXPECT_EQ(without.runnable, 0);
  EXPECT_EQ(without.left_out_runnable, 1);
  pthread_setname_np(pthread_self(), name.data());
}

std::uint16_t port_of(int descriptor, decltype(&getsockname) name) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  EXPECT_EQ(name(descriptor, reinterpret_cast<sockaddr*>(&address), &size), 0);
  return ntohs(address.sin_port);
}

TEST_F(ProcessTable, FindsAConnectionInTheProcessThatHasIt) {
  const FileDescriptor server(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(server.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(server.get(), 1), 0);
  address.sin_port = htons(port_of(server.get(), getsockname));
  const pid_t without = stopped_child([] {});
  const FileDescriptor client(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  ASSERT_EQ(connect(client.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const std::uint16_t here = port_of(client.get(), getsockname);
  const std::uint16_t there = port_of(client.get(), getpeername);
  EXPECT_TRUE(has_connection(getpid(), here, there));
  EXPECT_FALSE(has_connection(getpid(), static_cast<std::uint16_t>(here + 1), there));
  EXPECT_FALSE(has_connection(without, here, there));
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
