#pragma once

#include "trials.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

/// Runs in which something breaks.
namespace tether::system_test {

/// A mark for the processes of the test that runs.
std::string mark_of_test();

/// Waits until the SUT of the run in `out` has printed that.
bool sut_prints(const std::filesystem::path& out, const std::string& text);
/// Waits until so many interactions are in the record of the run in `out`.
/// @throws std::runtime_error with what `tether` printed when it ends before.
void wait_until_recorded(Process& tether, const std::filesystem::path& out,
                         std::size_t interactions = 100);

/// How a run failed.
struct Failure {
  std::string end;                  ///< of result.json
  std::vector<std::string> reason;  ///< values in it
};

/// A case with runs of the hover scenario.
class RunTest : public testing::Test {
 protected:
  /// `tether run` with the SUT in that mode, into out_.
  Command flight(const std::string& mode = "good", const std::vector<std::string>& options = {},
                 const std::vector<Substitution>& changes = {}) const;
  /// What every failed run must show: exit code 3, a failed result with a reason of one line,
  /// the same reason on stderr, and no process left. Returns the result.
  nlohmann::json expect_failed(const Output& output, const Failure& failure) const {
    return expect_failed(output, failure, out_);
  }
  nlohmann::json expect_failed(const Output& output, const Failure& failure,
                               const std::filesystem::path& out) const;
  nlohmann::json result() const { return read_result(out_); }
  std::string reason() const { return result()["reason"]; }

  const std::string mark_ = mark_of_test();
  TempFolder folder_;
  const std::filesystem::path out_ = folder_ / "out";
};

/// Stands where a run writes its result before the result gets its name: the run comes up to there,
/// its record closed, and waits.
class HeldResult {
 public:
  /// Makes the run's folder if it is not there.
  explicit HeldResult(const std::filesystem::path& out);
  /// Waits until the run's record is whole: the run waits, or is about to.
  bool is_reached() const;
  /// Puts into its place what a run leaves that is killed while it writes. A run that waits goes on
  /// waiting.
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
