#pragma once

#include "trials.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <sys/types.h>

/// Runs in Gazebo, real or not.
namespace tether::system_test {

/// Variables that make `tether` start stand_in_simulator in that mode as gzserver; its root is made
/// in `folder`.
Variables stand_in_gazebo(const std::filesystem::path& folder, const std::string& mode);

/// `tether run` of the scenario in Gazebo.
Command gazebo_run(const std::filesystem::path& scenario, const std::filesystem::path& out,
                   const Variables& environment, const std::string& mark);

/// A run in Gazebo whose SUT flies on and on, at real time.
class EndlessFlight {
 public:
  /// Starts it in `folder`, with that limit for answers, and waits until some interactions are in
  /// its record.
  /// @throws std::runtime_error with its output if it ends before.
  EndlessFlight(const std::filesystem::path& folder, const Variables& environment,
                const std::string& mark, int hang_limit_s = 30);

  Process& process() { return *process_; }
  const std::filesystem::path& out() const { return out_; }

 private:
  std::filesystem::path out_;
  std::unique_ptr<Process> process_;
};

/// Of the living processes with the mark, the one whose command line contains `part`.
std::optional<pid_t> find_process(const std::string& mark, const std::string& part);

/// The private folder of a run with Gazebo, as its simulator.log in `out` names it.
/// @throws std::runtime_error when it does not.
std::filesystem::path private_folder(const std::filesystem::path& out);

/// Whether an X server with that pid has left its lock in /tmp.
bool has_x_lock(pid_t server);

}  // namespace tether::system_test
