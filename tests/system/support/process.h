#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <tether/base_testing/scratch_folder.h>
#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>

namespace tether::system_test {

using Variables = os::Environment;

/// A program to start. Standard input is empty and stays open until the process is destroyed.
struct Command {
  std::vector<std::string> arguments;         ///< program (a path, or a name in PATH) first
  Variables environment = {};                 ///< over this process' own
  std::filesystem::path working_folder = {};  ///< empty: this process' own
};
/// The same with more arguments and variables.
Command with(Command command, const std::vector<std::string>& arguments,
             const Variables& environment = {});
/// The same started by another program, such as {"nice", "-n", "5"}.
Command started_by(const std::vector<std::string>& launcher, Command command);

/// How a program ended and what it printed.
struct Output {
  int code = -1;           ///< exit code; 128 + signal where a signal ended it
  bool timed_out = false;  ///< it was killed because it took too long
  std::string out;
  std::string err;
  std::chrono::duration<double> wall{0};
};

/// A running program whose output is kept. Killed, with its process group, when destroyed.
class Process {
 public:
  /// @throws Error when it cannot be started.
  explicit Process(const Command& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return child_.pid(); }
  /// What it has written so far.
  std::string out() const;
  std::string err() const;
  void signal(int number) const;
  bool has_ended() { return child_.poll().has_value(); }
  /// Waits at most `limit`; kills the whole group then.
  Output wait(std::chrono::duration<double> limit);
  /// Waits until its stderr contains `text`; false if it ends or `limit` passes before.
  bool wait_for_err(const std::string& text, std::chrono::duration<double> limit);
  bool wait_for_out(const std::string& text, std::chrono::duration<double> limit);

 private:
  bool wait_for(const std::filesystem::path& file, const std::string& text,
                std::chrono::duration<double> limit);

  ScratchFolder folder_;
  os::Pipe input_ = os::make_pipe();
  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  os::ChildProcess child_;
};

/// A core that is busy while this lives.
struct Spinner {
  Process process{{{"sh", "-c", "while :; do :; done"}}};
};

/// Runs to the end.
Output run(const Command& command, std::chrono::duration<double> limit = std::chrono::seconds(60));

/// Waits until `holds`; false if `limit` passes before.
bool wait_until(const std::function<bool()>& holds,
                std::chrono::duration<double> limit = std::chrono::seconds(60));

/// Pids of all living processes (zombies are not) with the environment variable TETHER_TEST_MARK =
/// `mark`. A program's children inherit it, so that none can hide.
std::vector<pid_t> processes_with_mark(const std::string& mark);
/// Waits until there is none; false if `limit` passes before.
bool wait_until_gone(const std::string& mark,
                     std::chrono::duration<double> limit = std::chrono::seconds(5));

/// Programs of this build.
std::filesystem::path tether_program();
std::filesystem::path sut_program();
std::filesystem::path bad_sut_program();
std::filesystem::path stand_in_program();
std::filesystem::path proxy_program();

}  // namespace tether::system_test
