#include "support/faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Runs whose SUTs' work is counted. Each key: host/plan/scenario/test/files/load_target_test.cpp;
/// the clock: target/client/test/clocks/counted_source_test.cpp.
namespace tether::system_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CountedRun : public RunTest {
 protected:
  /// `tether run` of the hover scenario with counted_sut in that mode.
  Command counted(const std::string& mode, const std::filesystem::path& out,
                  const std::string& keys = kEmulator, const std::string& costs = kCosts) const {
    write_text(folder_ / "target.toml", keys + costs);
    const auto scenario = write_hover_scenario(folder_.path(), mode,
                                               {{bad_sut_program().string(), COUNTED_SUT_PROGRAM}});
    return tether({"run", scenario, "--out", out, "--quiet", "--target", folder_ / "target.toml"},
                  mark_);
  }
  Command counted(const std::string& mode) const { return counted(mode, out_); }

  static constexpr const char* kEmulator =
      "name = \"t\"\nclock = \"counted\"\nemulator = \"qemu-x86_64\"\n"
      "cpu_model = \"Nehalem\"\n";
  static constexpr const char* kCosts = R"([cost_ns]
integer = 0.3
multiply = 1.1
divide = 7.7
load = 0.5
store = 0.4
branch = 0.6
scalar_float = 1.3
vector_float = 1.7
vector_integer = 0.9
atomic = 11.1
)";
};

// Under load, from another environment, with the addresses of this run.
TEST_F(CountedRun, IsTheSameToTheByte) {
  ASSERT_EQ(run(counted("good")).code, 0) << read_text(out_ / "sut-uav1.log");
  EXPECT_EQ(result()["clock"], "counted");
  EXPECT_EQ(result()["target"], "t");
  EXPECT_EQ(result()["emulator"]["program"], "qemu-x86_64");
  EXPECT_EQ(result()["emulator"]["cpu_model"], "Nehalem");
  EXPECT_EQ(result()["emulator"]["costs"][1]["ns"], 1.1) << "of multiply";
  EXPECT_TRUE(result()["audit"]["passed"]);
  const Spinner load[3];
  const auto again = folder_ / "again";
  Command command = counted("good", again);
  command.environment.emplace_back("ANOTHER", std::string(1001, 'x'));
  ASSERT_EQ(run(command).code, 0);
  EXPECT_EQ(read_text(again / "record.mcap"), read_text(out_ / "record.mcap"));
  EXPECT_EQ(timeless_result(again), timeless_result(out_));
}

// However late it is noticed.
TEST_F(CountedRun, EndsAProgramThatComputesForEverAtTheTimeLimit) {
  const auto slow = substituted(kCosts, {{"integer = 0.3", "integer = 90"}});
  for (const char* name : {"first", "second"}) {
    ASSERT_EQ(run(counted("endless", folder_ / name, kEmulator, slow)).code, 1);
    EXPECT_EQ(read_result(folder_ / name)["end"], "time_limit");
  }
  EXPECT_EQ(read_text(folder_ / "first" / "record.mcap"),
            read_text(folder_ / "second" / "record.mcap"));
}

TEST_F(CountedRun, MayHaveThreadsThatOnlyWait) {
  EXPECT_EQ(run(counted("waiter")).code, 0);
}

TEST_F(CountedRun, MayHandWorkToThreadsAndWaitForThem) {
  for (const int spinners : {0, 3}) {
    const std::vector<Spinner> load(static_cast<std::size_t>(spinners));
    const auto out = folder_ / std::to_string(spinners);
    ASSERT_EQ(run(counted("hands_over", out)).code, 0) << read_text(out / "sut-uav1.log");
  }
  EXPECT_EQ(read_text(folder_ / "0" / "record.mcap"), read_text(folder_ / "3" / "record.mcap"));
}

TEST_F(CountedRun, EndsWhenWorkIsNotCounted) {
  const auto expect_end = [&](const std::string& mode, const std::string& reason) {
    SCOPED_TRACE(mode);
    const auto out = folder_ / mode;
    const Output output = run(counted(mode, out));
    EXPECT_EQ(output.code, 3);
    EXPECT_THAT(output.err, HasSubstr(reason));
  };
  expect_end("at_once", "several threads of the program compute at the same time");
  expect_end("meanwhile", "several threads of the program compute at the same time");
  expect_end("from_start", "several threads of the program compute at the same time");
  expect_end("process", "the program started a process");
  expect_end("daemon", "the program started a process");
  expect_end("native", "do not advance");
}

// A process that the program left behind before it joined.
TEST_F(CountedRun, ChargesDaemonsUnderACpuClock) {
  const auto scenario = write_hover_scenario(folder_.path(), "daemon",
                                             {{bad_sut_program().string(), COUNTED_SUT_PROGRAM}});
  EXPECT_EQ(run(tether({"run", scenario, "--out", out_, "--quiet"}, mark_)).code, 0)
      << read_text(out_ / "sut-uav1.log");
}

// The run does not wait for it.
TEST_F(CountedRun, RefusesAProgramStartedByHandThatDoesNotExist) {
  write_text(folder_ / "target.toml", std::string(kEmulator) + kCosts);
  const auto scenario = write_hover_scenario(
      folder_.path(), "good",
      {{bad_sut_program().string(), "/nowhere/fly"},
       {"name = \"uav1\"", "name = \"uav1\"\ntarget = \"laptop\""},
       {"[sut]", "[[target]]\nname = \"laptop\"\nfile = \"target.toml\"\nby_hand = true\n\n[sut]"},
       {"clock = \"cpu\"\n", ""}});
  const Output output = run(tether({"run", scenario, "--out", out_}));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, AllOf(HasSubstr("hover.toml"), HasSubstr("/nowhere/fly")));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(CountedRun, NamesThePackageThatIsMissing) {
  Command command = counted("good");
  command.environment.emplace_back("PATH", "/nowhere");
  Output output = run(command);
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, AllOf(HasSubstr("qemu-x86_64"), HasSubstr("qemu-user")));

  command.environment.back() = {"TETHER_COUNTER_PLUGIN", "/nowhere/plugin.so"};
  output = run(command);
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("/nowhere/plugin.so"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

}  // namespace
}  // namespace tether::system_test
