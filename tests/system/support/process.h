#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::system_test {

/// A program to start. Standard input is empty and stays open until the process is destroyed.
struct Command {
  std::vector<std::string> arguments;  ///< program (a path, or a name to look for in PATH) first
  std::vector<std::pair<std::string, std::string>> environment;  ///< over this process' own
  std::filesystem::path working_folder;                          ///< empty: this process' own
};

/// How a program ended and what it said.
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
  /// @throws std::runtime_error when it cannot be started.
  explicit Process(const Command& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }
  /// What it has written so far.
  std::string out() const;
  std::string err() const;
  void signal(int number) const;
  bool has_ended();
  /// Waits at most `limit`; kills the whole group then. @pre not called before.
  Output wait(std::chrono::duration<double> limit);
  /// Waits until its stderr contains `text`; false if it ends or `limit` passes before.
  bool wait_for_err(const std::string& text, std::chrono::duration<double> limit);
  bool wait_for_out(const std::string& text, std::chrono::duration<double> limit);

 private:
  bool wait_for(const std::filesystem::path& file, const std::string& text,
                std::chrono::duration<double> limit);

  ScratchFolder folder_;
  std::chrono::steady_clock::time_point started_;
  pid_t pid_ = -1;
  int stdin_ = -1;
  std::optional<int> status_;
};

/// A core that is busy while this lives.
class Spinner {
 public:
  Spinner() : process_({{"sh", "-c", "while :; do :; done"}, {}, {}}) {}

 private:
  Process process_;
};

/// Runs to the end.
Output run(const Command& command, std::chrono::duration<double> limit = std::chrono::seconds(60));

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
