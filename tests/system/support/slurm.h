#pragma once

#include "process.h"

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/os/child_process.h>

/// A Slurm of a test's own: this machine as the two nodes n1 and n2 with one core each, with a key,
/// a socket and ports of its own, as root or not.
namespace tether::system_test {

class SlurmCluster {
 public:
  /// @throws std::runtime_error with the logs if it does not come up.
  explicit SlurmCluster(const std::filesystem::path& folder);
  ~SlurmCluster();
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  /// Whether slurm-wlm and munge are installed.
  static bool is_installed();

  /// The command with this cluster as its Slurm.
  Command in(Command command) const;
  /// What squeue prints, line by line: "JOB_TASK NODE" of the tasks that run.
  std::vector<std::string> running() const;
  /// Ends slurmd of a node, and everything that it started, without a word.
  void lose_node(const std::string& node);
  /// Starts slurmd of a node.
  void start_node(const std::string& node);
  void wait_until_idle() const;

 private:
  std::filesystem::path folder_;
  std::string conf_;
  std::array<std::unique_ptr<os::ChildProcess>, 4> daemons_;
};

}  // namespace tether::system_test
