#include "command.h"
#include "freezer.h"
#include "waiting.h"

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
  const auto command =
      start_command({"sh", "-c", "while :; do :; done"}, "/nowhere/socket", std::nullopt);
  ASSERT_TRUE(command);
  const auto freezer = make_signal_freezer(*command, 0);
  ASSERT_TRUE(freezer) << freezer.failure().message;
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE((*freezer)->freeze());
    EXPECT_EQ(state_of(*command), 'T');
    (*freezer)->thaw();
    EXPECT_TRUE(wait_until([&] { return state_of(*command) != 'T'; }, std::chrono::seconds(10)));
  }
  ::kill(*command, SIGKILL);
  ::waitpid(*command, nullptr, 0);
}

}  // namespace
}  // namespace tether::supervisor
