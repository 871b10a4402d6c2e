#pragma once

#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/time.h>

namespace tether::os {

/// Variables with their values.
using Environment = std::vector<std::pair<std::string, std::string>>;

/// A program to start, and how.
struct ChildCommand {
  std::vector<std::string> arguments;  ///< program first
  Environment environment;             ///< added to that of this process
  std::filesystem::path log;           ///< file for stdout and stderr; empty: /dev/null
  std::vector<int> cpus{};             ///< for it and its children; empty: all
  std::filesystem::path errors{};      ///< file for stderr; empty: `log`
  std::filesystem::path input{};       ///< file for stdin; empty: `input_pipe`, or /dev/null
  int input_pipe = -1;                 ///< read end of a pipe for stdin; the caller keeps owning it
  bool appends = false;                ///< to its logs, which several processes can then share
  std::filesystem::path working_folder{};    ///< empty: that of this process
  int end_signal = SIGTERM;                  ///< asks it to end
  int death_signal = SIGKILL;                ///< sent to it when this process ends
  Duration grace = std::chrono::seconds(1);  ///< from `end_signal` to SIGKILL
  bool adopts_orphans = false;  ///< it is the parent of its descendants whose own parent ends
  /// If set, the child is a copy of this process that calls this and exits with what it returns,
  /// rather than a program. It has the memory and the open files of this process, but only the
  /// thread that starts it: a process with other threads than that of an Interrupt must not start
  /// such a child. `arguments` has one word, the name that `ps` shows; `environment`, `cpus` and
  /// `working_folder` stay those of this process.
  std::function<int()> body{};
};

/// The variables of a child with `extra`, by name: those of this process, and these.
Environment merged_environment(const Environment& extra);

/// Higher exit codes are this plus the signal that ended a program, as in shells.
inline constexpr int kSignalled = 128;

/// How a child ended.
struct ChildExit {
  int code = 0;             ///< exit code; kSignalled + signal if a signal ended it
  std::string description;  ///< "exited with code 3", "was ended by signal 11 (Segmentation fault)"
};

/// A child process that ends with its object, and with this process however that ends. It is in its
/// own process group, so that Ctrl-C at the terminal reaches only this process. Not thread-safe.
class ChildProcess {
 public:
  /// Starts it. A program without '/' is searched for in the folder of this program, then in PATH.
  /// @throws Error(kSetup), about the program, if it cannot be started; with the place of a log or
  /// input that cannot be opened.
  explicit ChildProcess(const ChildCommand& command);
  /// Ends it if it is still running.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// How it ended; none while it runs. Does not block.
  const std::optional<ChildExit>& poll();
  /// Waits at most `limit` for its end; true if it has ended.
  bool wait(Duration limit);
  /// Sends `end_signal` to it and its children, and SIGKILL after its grace.
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

/// Ends all children of this process that no ChildProcess started, thus adopted ones (adopt_orphans
/// in process_table.h), and what they leave: with SIGTERM, after `grace` with SIGKILL. Returns once
/// they have ended, 5 s after `grace` at the latest. Thread-safe.
void end_orphans(Duration grace);

/// The result of a program.
struct Captured {
  int code = -1;           ///< exit code; 128 + signal if a signal ended it
  bool timed_out = false;  ///< it was ended at the limit, or because of a stop
  std::string out;
  std::string err;
  Duration wall{0};  ///< from its start to its end
};

/// Runs a program with `input` as its standard input until it exits. Its streams are only in
/// memory. Ends it after `limit`, or when a stop is requested.
/// @throws Error(kSetup) if it cannot be started.
Captured run_captured(const std::vector<std::string>& arguments, const std::string& input,
                      Duration limit, const std::stop_token& stop = {});

/// The file of this program.
std::filesystem::path own_file();
/// What follows the program's name on the command line by which this process was started.
std::vector<std::string> own_arguments();
/// The file that a command starts: in the folder of this program, else in PATH. A name with '/' is
/// a path.
/// @throws Error(kSetup), about the name, if there is no such program; about the file, if it is a
/// script without its interpreter.
std::filesystem::path find_program(const std::string& name);

/// @throws Error(kSetup), about the program, if no library can be preloaded into it, or if it does
/// not ask the C library for the time: it is static, set-user-ID, or written in Go.
void require_preloadable(const std::filesystem::path& program);

/// The text quoted so that a shell reads it as one word.
std::string shell_word(const std::string& text);

}  // namespace tether::os
