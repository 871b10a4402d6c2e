#include "command.h"
#include "freezer.h"
#include "process_tree.h"
#include "waiting.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

namespace tether::supervisor {
namespace {

/// 'R', 'S', 'T', …: the third field of /proc/PID/stat.
char state_of(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return text.at(text.rfind(')') + 2);
}

TEST(SignalFreezer, StopsACommandThatComputesAndLetsItGoOn) {
  const auto command = start_command({.words = {"sh", "-c", "while :; do :; done"}},
                                     "/nowhere/socket", std::nullopt);
  ASSERT_TRUE(command);
  const auto freezer = make_signal_freezer(0);
  ASSERT_TRUE(freezer) << freezer.failure().message;
  (*freezer)->add(*command);
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE((*freezer)->freeze());
    EXPECT_EQ(state_of(*command), 'T');
    (*freezer)->thaw();
    EXPECT_TRUE(wait_until([&] { return state_of(*command) != 'T'; }, std::chrono::seconds(10)));
  }
  ::kill(*command, SIGKILL);
  ::waitpid(*command, nullptr, 0);
}

// The group's SIGSTOP may reach a process that is just about to leave the group: it stops outside,
// where the group's SIGCONT does not reach it.
TEST(SignalFreezer, LetsAProcessGoOnThatLeftItsGroupWhileItWasStopped) {
  const auto command =
      start_command({.words = {"sh", "-c", "setsid sh -c 'kill -STOP $$; exit 7' & wait $!"}},
                    "/nowhere/socket", std::nullopt);
  ASSERT_TRUE(command);
  const auto freezer = make_signal_freezer(0);
  ASSERT_TRUE(freezer) << freezer.failure().message;
  (*freezer)->add(*command);
  const ProcessTree tree(0);
  const auto is_stopped_outside = [&](const ProcessState& process) {
    return process.group != *command && state_of(process.id) == 'T';
  };
  ASSERT_TRUE(wait_until([&] { return std::ranges::any_of(tree.look(), is_stopped_outside); },
                         std::chrono::seconds(10)));
  ASSERT_TRUE((*freezer)->freeze());
  (*freezer)->thaw();
  int status = 0;
  EXPECT_TRUE(wait_until([&] { return ::waitpid(*command, &status, WNOHANG) == *command; },
                         std::chrono::seconds(10)));
  EXPECT_EQ(WEXITSTATUS(status), 7);
  tree.kill_all();
}

}  // namespace
}  // namespace tether::supervisor
