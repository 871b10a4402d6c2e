#include "support/faults.h"

#include <csignal>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// A program under tether-exec, and tether-exec itself, are killed or stopped in flight
/// (docs/guide/faults.md). How it ends without a run: threads_test.cpp.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

struct StruckProgram {
  std::string name;
  std::string victim;  ///< by its name in the process list
  int signal;
  Failure failure;
};

void PrintTo(const StruckProgram& struck, std::ostream* out) {
  *out << struck.name;
}

class InFlight : public RunTest, public testing::WithParamInterface<StruckProgram> {
 protected:
  std::optional<pid_t> process_called(const std::string& name) const {
    for (const pid_t pid : processes_with_mark(mark_))
      if (read_text("/proc/" + std::to_string(pid) + "/comm") == name + "\n") return pid;
    return std::nullopt;
  }
};

TEST_P(InFlight, AStruckProgramIsNamed) {
  Process process(
      flight("count", {},
             {{"[\"" + bad_sut_program().string() + "\", \"count\"]",
               "[\"" TETHER_EXEC_PROGRAM "\", \"" THREADS_SUT_PROGRAM "\", \"count\", \"60\"]"},
              kWall,
              {"time_limit_s = 5", "time_limit_s = 60"}}));
  // The record is written to the disk once a second while it flies.
  const auto record = out_ / "record.mcap";
  ASSERT_TRUE(wait_until([&] {
    return std::filesystem::exists(record) && std::filesystem::file_size(record) > 4096;
  })) << process.err();
  const auto victim = process_called(GetParam().victim);
  ASSERT_TRUE(victim) << process.err();
  kill(*victim, GetParam().signal);
  expect_failed(process.wait(60s), GetParam().failure);
  EXPECT_THAT(reason(), testing::HasSubstr("\"uav1\""));
  EXPECT_EQ(read_record(out_).footer->end, GetParam().failure.end);
  EXPECT_EQ(audit_code(out_), 0);
}

const StruckProgram kStruckPrograms[] = {
    {"kill_program", "threads_sut", SIGKILL, {"sut_lost", {"137"}}},
    {"stop_program", "threads_sut", SIGSTOP, {"sut_hung", {}}},
    {"kill_exec", "tether-exec", SIGKILL, {"sut_lost", {"signal 9"}}},
    {"stop_exec", "tether-exec", SIGSTOP, {"sut_hung", {}}},
};

INSTANTIATE_TEST_SUITE_P(Signals, InFlight, testing::ValuesIn(kStruckPrograms),
                         [](const auto& struck) { return struck.param.name; });

}  // namespace
}  // namespace tether::system_test
