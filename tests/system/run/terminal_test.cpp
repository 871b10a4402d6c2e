#include "support/faults.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/os/file_descriptor.h>
#include <tether/os/terminal.h>

/// Programs on a real terminal. The layout of their lines: tests in common/os and apps/tether.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

/// A program whose terminal has 60 columns. Closed when destroyed.
class OnTerminal {
 public:
  explicit OnTerminal(const Command& command) {
    winsize size{};
    size.ws_col = kColumns;
    size.ws_row = 24;
    int terminal = -1;
    pid_ = forkpty(&terminal, nullptr, nullptr, &size);
    if (pid_ == 0) start(command);
    terminal_ = os::FileDescriptor(terminal);
  }
  ~OnTerminal() { exit_code(); }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  static constexpr unsigned short kColumns = 60;

  /// What was printed until `is_over` holds, at the latest when the program ended.
  std::string read_until(const std::function<bool()>& is_over) {
    std::string printed;
    std::array<char, 4096> part{};
    while (!is_over()) {
      pollfd readable{terminal_.get(), POLLIN, 0};
      if (poll(&readable, 1, 20) == 0) continue;
      const ssize_t got = read(terminal_.get(), part.data(), part.size());
      if (got <= 0) break;
      printed.append(part.data(), static_cast<std::size_t>(got));
    }
    return printed;
  }
  void close() { terminal_ = os::FileDescriptor(); }
  /// Closes the terminal and waits.
  int exit_code() {
    close();
    if (pid_ > 0) waitpid(std::exchange(pid_, -1), &status_, 0);
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  }

 private:
  [[noreturn]] static void start(const Command& command) {
    for (const auto& [name, value] : command.environment) setenv(name.c_str(), value.c_str(), 1);
    std::vector<char*> arguments;
    for (const std::string& word : command.arguments)
      arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(arguments.front(), arguments.data());
    _exit(127);
  }

  pid_t pid_ = -1;
  int status_ = 0;
  os::FileDescriptor terminal_;
};

class Terminal : public RunTest {
 protected:
  /// The lines that were overwritten by another. Each fits, or it would have wrapped.
  static std::vector<std::string> overwritten_lines(std::string_view printed) {
    std::vector<std::string> lines;
    const std::string_view clear = os::kClearLine;
    for (auto at = printed.find(clear); at != std::string_view::npos;) {
      printed.remove_prefix(at + clear.size());
      at = printed.find(clear);
      const std::string line(printed.substr(0, at));
      if (at == std::string_view::npos || line.empty() || line.find('\n') != line.npos) continue;
      lines.push_back(line);
      EXPECT_EQ(os::cut_to_columns(line, OnTerminal::kColumns), line);
    }
    return lines;
  }
};

TEST_F(Terminal, ThatIsClosedInterruptsTheRun) {
  OnTerminal tether(flight("fly_on", {"--real-time-factor", "1"}, kEndless));
  tether.read_until([&] {
    const auto record = record_so_far(out_);
    return record && record->interactions.size() >= 100;
  });
  EXPECT_EQ(tether.exit_code(), 3);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_EQ(result()["end"], "interrupted");
  EXPECT_EQ(audit_code(out_), 0);
}

TEST_F(Terminal, IsNotWiderThanItIs) {
  OnTerminal one(flight("good", {"--real-time-factor", "2"}));
  EXPECT_THAT(overwritten_lines(one.read_until([] { return false; })),
              testing::Contains(testing::HasSubstr("x real time")));
  EXPECT_EQ(one.exit_code(), 0);
  const auto campaign = write_campaign(folder_.path(), 2, "conditions = [\"host\"]\n");
  OnTerminal many(tether({"campaign", campaign, "--out", folder_ / "many"}, mark_));
  EXPECT_THAT(overwritten_lines(many.read_until([] { return false; })),
              testing::Contains(testing::StartsWith("[#####.....] 1/2")));
  EXPECT_EQ(many.exit_code(), 0);
}

}  // namespace
}  // namespace tether::system_test
