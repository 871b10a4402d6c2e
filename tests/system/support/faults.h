#pragma once

#include "trials.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// Runs in which something breaks.
namespace tether::system_test {

/// A mark for the processes of the test that runs.
std::string mark_of_test();

/// Waits until `holds`; false if `limit` passes before.
bool wait_until(const std::function<bool()>& holds,
                std::chrono::duration<double> limit = std::chrono::seconds(60));

/// How a run failed.
struct Failure {
  std::string end;                  ///< of result.json
  std::vector<std::string> reason;  ///< parts of it
};

/// Expects what every failed run must show: exit code 3, a result that says so with a reason of one
/// line, the same reason on stderr, and no process left. Returns the result.
nlohmann::json expect_failed(const Output& output, const std::filesystem::path& out,
                             const Failure& failure, const std::string& mark);

/// Stands where a run writes its result before the result gets its name: the run comes up to there,
/// its record closed, and waits.
class HeldResult {
 public:
  /// Makes the run's folder if it is not there.
  explicit HeldResult(const std::filesystem::path& out);
  /// The run's record is whole: it waits, or is about to.
  bool is_waited_for() const;
  /// Puts into its place what a run leaves that is killed while it writes. Who waits, waits on.
  void tear() const;

 private:
  std::filesystem::path out_, part_;
};

/// Fails a test that is about to be skipped in CI: what CI skips nobody tests.
void expect_not_in_ci();

/// The command under limits of a shell's `ulimit` ("-n 12"), with no files open but the first
/// three.
Command limited(const Command& command, const std::string& limits);

}  // namespace tether::system_test
