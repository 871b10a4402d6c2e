#include "support/trials.h"

#include <cstdlib>
#include <functional>
#include <iostream>
#include <optional>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/os/machine.h>

/// A trial with scripted times is one trial, however often, on however busy a machine, with however
/// many rendering threads, and by whatever build it is flown.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

constexpr int kRuns = 20;

/// `tether` of the build under the address sanitizer, which scripts/test makes first.
std::optional<std::filesystem::path> checked_program() {
  const auto program = std::filesystem::path(TETHER_SOURCE_DIR) / "build/asan/bin/tether";
  const bool is_there = std::filesystem::exists(program);
  if (!is_there && std::getenv("CI")) throw std::runtime_error(program.string() + " is missing");
  testing::Test::RecordProperty("by_checked_build", is_there ? "yes" : "no");
  if (is_there) return program;
  std::cerr << "No run is flown by the build under the address sanitizer: " << program.string()
            << " is missing; make it with: scripts/build asan tether tether-sut\n";
  return std::nullopt;
}

class Repeatability : public testing::Test {
 protected:
  /// The hash of the record's bytes, images included.
  std::size_t fly(int run_number, const std::filesystem::path& program) {
    const auto out = folder_ / ("run" + std::to_string(run_number));
    Command command = tether({"run", scenario_, "--images", "--quiet", "--out", out});
    command.arguments.front() = program.string();
    const std::string one_cpu = std::to_string(os::allowed_cpus().front());
    if (run_number % 2 == 0) command = started_by({"taskset", "--cpu-list", one_cpu}, command);
    const Output output = run(command, 120s);
    EXPECT_EQ(output.code, 0) << output.err;
    EXPECT_FALSE(read_record(out).images.empty());
    return std::hash<std::string>()(read_text(out / "record.mcap"));
  }

  TempFolder folder_;
  std::filesystem::path scenario_ =
      write_shipped_scenario(folder_.path(), "face_anchor", {scripted_host(10)});
};

TEST_F(Repeatability, TwentyRunsUnderLoadHaveOneHash) {
  std::vector<Spinner> load(static_cast<std::size_t>(sysconf(_SC_NPROCESSORS_ONLN)) + 1);
  const auto checked = checked_program();
  std::set<std::size_t> hashes;
  for (int i = 0; i < kRuns; ++i)
    hashes.insert(fly(i, checked && i >= kRuns - 2 ? *checked : tether_program()));
  EXPECT_EQ(hashes.size(), 1u);
  load.clear();
  hashes.insert(fly(kRuns, tether_program()));
  EXPECT_EQ(hashes.size(), 1u);
}

}  // namespace
}  // namespace tether::system_test
