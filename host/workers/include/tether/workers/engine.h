#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/workers/round.h>

/// What starts workers on other machines, and knows which of them are alive.
namespace tether::workers {

/// One task of a round's job.
struct Task {
  std::string name;       ///< as the worker knows it (WorkerName::task)
  bool is_alive = false;  ///< it runs, or waits for a machine
  bool is_waiting = false;
  std::string state{};  ///< in the engine's words
  std::string node{};   ///< empty: none yet
};

/// What a collector asks for.
struct Order {
  std::size_t tasks = 1;
  int cores = 1;                  ///< of each task; 0: a machine of its own
  std::set<std::string> avoid{};  ///< nodes on which trials were lost, if there are others
};

/// Calls are not concurrent.
class Engine {
 public:
  virtual ~Engine() = default;
  /// Starts workers for the round. False: the user does. @throws Error(kSetup) if it is refused.
  virtual bool start(const Round& round, const Order& order) = 0;
  /// Those of the round's job that are known; none: no answer, ask again.
  virtual std::optional<std::vector<Task>> tasks(const Round& round) = 0;
  /// Ends all tasks of the round's job. @throws Error(kSetup) if that is refused.
  virtual void cancel(const Round& round) = 0;
};

/// A program to run: its words → exit code, standard output, standard error.
struct Answer {
  int code = 0;
  std::string out;
  std::string err;
};
using RunProgram = std::function<Answer(const std::vector<std::string>&)>;

struct SlurmSettings {
  std::string worker;                ///< the shell command of a task
  std::vector<std::string> options;  ///< of sbatch
  RunProgram run;
};
/// Slurm: a job array for each round, which is found by its name.
/// @throws Error(kUsage) about an option that the array needs for itself; Error(kSetup) if there is
///   no Slurm, or if it does not answer.
std::unique_ptr<Engine> make_slurm(SlurmSettings settings);
/// The cores of the cluster; none: no answer.
std::optional<std::size_t> slurm_cores(const RunProgram& run);

/// Workers that the user starts. One is alive while its file changes, by `now`, a monotonic clock
/// of this machine: the clocks of other machines are not compared.
std::unique_ptr<Engine> make_unmanaged(std::function<Duration()> now);
/// A worker whose file has not changed for so long counts as dead.
inline constexpr Duration kSilence = std::chrono::minutes(3);

}  // namespace tether::workers
