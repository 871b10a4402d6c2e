#pragma once

#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/time.h>

namespace tether::os {

/// Variables with their values.
using Environment = std::vector<std::pair<std::string, std::string>>;

/// What to start, and how.
struct ChildCommand {
  std::vector<std::string> arguments;  ///< program first
  Environment environment;             ///< over this process' own
  std::filesystem::path log;           ///< gets stdout and stderr; empty: /dev/null
  std::vector<int> cpus{};             ///< it and its children run on these only; empty: on all
  std::filesystem::path errors{};      ///< gets stderr instead; empty: `log` does
  std::filesystem::path input{};       ///< read as stdin; empty: `input_pipe`, or /dev/null
  int input_pipe = -1;   ///< the caller's end to read from, as stdin; stays the caller's
  bool appends = false;  ///< to its logs, which several processes may then share
  std::filesystem::path working_folder{};    ///< empty: this process' own
  int end_signal = SIGTERM;                  ///< what asks it to end
  int death_signal = SIGKILL;                ///< what it gets when this process is gone
  Duration grace = std::chrono::seconds(1);  ///< from being asked to end to being made to
};

/// Exit codes beyond it say which signal ended a program; shells have it so, too.
inline constexpr int kSignalled = 128;

/// How a child ended.
struct ChildExit {
  int code = 0;             ///< exit code; kSignalled + signal where a signal ended it
  std::string description;  ///< "exited with code 3", "was ended by signal 11 (Segmentation fault)"
};

/// A process of ours that never outlives us: it dies with its object, and with this process however
/// that ends. In a process group of its own, so that Ctrl-C at the terminal reaches only us. Not
/// thread-safe.
class ChildProcess {
 public:
  /// Starts it. A program without '/' is looked for beside this program's own file, then in PATH.
  /// @throws Error(kSetup) naming the program and why it cannot be started.
  explicit ChildProcess(const ChildCommand& command);
  /// Ends it if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Whether and how it has ended. Does not block.
  const std::optional<ChildExit>& poll();
  /// Waits at most `limit` for it to end; whether it has.
  bool wait(Duration limit);
  /// Asks it and its children to end (`end_signal`), and makes them after its grace (SIGKILL).
  void terminate();

  pid_t pid() const { return pid_; }
  const std::string& program() const { return program_; }

 private:
  void reap(int status);

  std::string program_;
  int end_signal_;
  Duration grace_;
  pid_t pid_ = -1;
  std::optional<ChildExit> exit_;
};

}  // namespace tether::os
