#include "support/faults.h"

#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// What `--target FILE` changes in a run. Each key:
/// host/plan/scenario/test/files/load_target_test.cpp; how the program is started:
/// host/trial/runner/test.
namespace tether::system_test {
namespace {

using testing::HasSubstr;

class TargetFile : public RunTest {
 protected:
  Output fly(const std::string& keys, const std::vector<std::string>& options = {},
             const std::vector<Substitution>& changes = {}) const {
    write_text(folder_ / "target.toml", "name = \"t\"\n" + keys);
    Command command = flight("good", {"--quiet", "--target", folder_ / "target.toml"}, changes);
    return run(with(command, options));
  }
};

TEST_F(TargetFile, ScalesTheClockAndStartsTheProgramOfItsFolderThroughItsLauncherOnItsCores) {
  std::filesystem::create_directory(folder_ / "bin");
  std::filesystem::copy(bad_sut_program(), folder_ / "bin/own_sut");
  write_text(folder_ / "launch.sh",
             "grep Cpus_allowed: /proc/self/status > \"$TETHER_OUT/cpus\"\nexec \"$@\"\n");
  const Output output =
      fly("clock = \"cpu\"\ncpu_factor = 7\ncores = 1\nprogram_folder = \"bin\"\n"
          "launcher = [\"/bin/sh\", \"./launch.sh\"]\n",
          {}, {{"\"" + bad_sut_program().string() + "\"", "\"own_sut\""}});
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(result()["condition"], "t");
  EXPECT_EQ(result()["target"], "t");
  EXPECT_EQ(result()["cpu_factor"], 7.0);
  EXPECT_EQ(result()["suts"][0]["clock"], "cpu");
  EXPECT_EQ(result()["suts"][0]["cpu_factor"], 7.0) << "as the SUT received it";
  EXPECT_TRUE(result()["audit"]["passed"]);

  const std::string line = read_text(out_ / "cpus");
  int cores = 0;
  for (const char c : line.substr(line.find('\t') + 1)) {
    const auto digit = std::string("0123456789abcdef").find(c);
    if (digit != std::string::npos) cores += std::popcount(static_cast<unsigned>(digit));
  }
  EXPECT_EQ(cores, 1) << line;
}

TEST_F(TargetFile, StretchesTheWallClockOfAConditionThatKeepsItsName) {
  const Output output = fly("clock = \"wall\"\ncpu_factor = 3\n", {"--condition", "slow"});
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(result()["condition"], "slow on t");
  EXPECT_EQ(result()["suts"][0]["clock"], "wall");
  EXPECT_EQ(result()["suts"][0]["cpu_factor"], 3.0) << "the target's, not the condition's";
  EXPECT_TRUE(result()["audit"]["passed"]);
}

TEST_F(TargetFile, IsRefusedBeforeAnythingIsWritten) {
  const auto expect_refusal = [&](const std::string& keys, const std::string& named) {
    const Output output = fly(keys);
    EXPECT_EQ(output.code, 2);
    EXPECT_THAT(output.err, HasSubstr(named));
    EXPECT_FALSE(std::filesystem::exists(out_));
  };
  expect_refusal("clokc = \"cpu\"\n", "target.toml:2: ");
  expect_refusal("cores = 4000\n", "4000");
  expect_refusal("launcher = [\"no-such-emulator\"]\n", "\"no-such-emulator\"");
}

}  // namespace
}  // namespace tether::system_test
