#include "support/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Target files: what `--target FILE` and a condition's `target` make of a run.
namespace tether::system_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class TargetFile : public testing::Test {
 protected:
  std::string write_target(const std::string& keys) const {
    write_text(folder_ / "target.toml", "name = \"t\"\n" + keys);
    return folder_ / "target.toml";
  }
  Output fly(const std::string& keys, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = {
        "run", scenario_, "--quiet", "--target", write_target(keys), "--out", folder_ / "out"};
    words.insert(words.end(), options.begin(), options.end());
    return run(tether(words));
  }
  /// A launcher that says on which CPUs it is before it goes on.
  std::string telling_launcher() const {
    write_text(folder_ / "launch.sh",
               "grep Cpus_allowed: /proc/self/status > \"$TETHER_OUT/cpus\"\nexec \"$@\"\n");
    return "launcher = [\"/bin/sh\", \"./launch.sh\"]\n";
  }
  nlohmann::json result() const { return read_result(folder_ / "out"); }

  TempFolder folder_;
  std::string scenario_ = write_hover_scenario(folder_.path(), "good");
};

TEST_F(TargetFile, NamesTheConditionAndScalesItsClock) {
  const Output output = fly("clock = \"cpu\"\ncpu_factor = 7\n");
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(result()["condition"], "t");
  EXPECT_EQ(result()["target"], "t");
  EXPECT_EQ(result()["cpu_factor"], 7.0);
  EXPECT_EQ(result()["suts"][0]["clock"], "cpu");
  EXPECT_EQ(result()["suts"][0]["cpu_factor"], 7.0) << "as the SUT was told";
  EXPECT_TRUE(result()["audit"]["passed"]);
}

TEST_F(TargetFile, KeepsTheNameOfAConditionThatWasAskedFor) {
  const Output output = fly("clock = \"cpu\"\n", {"--condition", "slow"});
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(result()["condition"], "slow on t");
  EXPECT_EQ(result()["cpu_factor"], 1.0) << "the target's, not the condition's";
}

TEST_F(TargetFile, StretchesTheWallClockUnderTheBarrierOnly) {
  const Output output = fly("clock = \"wall\"\ncpu_factor = 3\n");
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(result()["clock"], "wall");
  EXPECT_EQ(result()["suts"][0]["clock"], "wall");
  EXPECT_EQ(result()["suts"][0]["cpu_factor"], 3.0) << "as the SUT was told";
  EXPECT_TRUE(result()["audit"]["passed"]);

  scenario_ = write_hover_scenario(
      folder_.path(), "good",
      {{"\"conservative_barrier\"", "\"free_running\"\nreal_time_factor = 1"}});
  const Output free = fly("clock = \"wall\"\ncpu_factor = 3\n");
  EXPECT_EQ(free.code, 2);
  EXPECT_THAT(free.err, AllOf(HasSubstr("\"host\""), HasSubstr("\"t\"")));
}

TEST_F(TargetFile, StartsTheProgramOfItsFolderThroughItsLauncher) {
  std::filesystem::create_directory(folder_ / "bin");
  std::filesystem::copy(bad_sut_program(), folder_ / "bin/own_sut");
  scenario_ = write_hover_scenario(folder_.path(), "good",
                                   {{"\"" + bad_sut_program().string() + "\"", "\"own_sut\""}});
  const Output output = fly("program_folder = \"bin\"\n" + telling_launcher());
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(read_text(folder_ / "out/cpus"), HasSubstr("Cpus_allowed"));
}

TEST_F(TargetFile, BindsTheSutToSoManyCores) {
  const Output output = fly("cores = 1\n" + telling_launcher());
  ASSERT_EQ(output.code, 0) << output.err;
  const std::string line = read_text(folder_ / "out/cpus");
  int bits = 0;
  for (const char c : line.substr(line.find('\t') + 1)) {
    const auto digit = std::string("0123456789abcdef").find(c);
    if (digit != std::string::npos) bits += __builtin_popcount(static_cast<unsigned>(digit));
  }
  EXPECT_EQ(bits, 1) << line;
}

TEST_F(TargetFile, IsRefusedBeforeAnythingIsWritten) {
  const auto expect_refusal = [&](const std::string& keys, const std::string& words) {
    const Output output = fly(keys);
    EXPECT_EQ(output.code, 2);
    EXPECT_THAT(output.err, HasSubstr(words));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  };
  expect_refusal("clokc = \"cpu\"\n", "target.toml:2: ");
  expect_refusal("cores = 4000\n", "4000");
  expect_refusal("launcher = [\"no-such-emulator\"]\n", "\"no-such-emulator\"");
  const Output output = run(tether({"run", scenario_, "--target", folder_ / "none.toml"}));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("none.toml"));
}

TEST_F(TargetFile, AProgramThatIsNotThereIsNamedByRunAndCampaign) {
  scenario_ =
      write_hover_scenario(folder_.path(), "good", {{bad_sut_program().string(), "./none"}});
  write_text(folder_ / "campaign.toml",
             "name = \"small\"\ntrials = 1\n\n[[scenario]]\nfile = \"hover.toml\"\n");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", scenario_, "--out", folder_ / "out"},
        {"campaign", folder_ / "campaign.toml", "--out", folder_ / "out"}}) {
    const Output output = run(tether(words));
    EXPECT_EQ(output.code, 2);
    EXPECT_THAT(output.err, AllOf(HasSubstr("\"uav1\""), HasSubstr((folder_ / "none").string())));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  }
}

TEST_F(TargetFile, ATunnelNeedsABoard) {
  for (const char* target : {"", "wait"}) {
    std::vector<std::string> words{"run", scenario_, "--tunnel", "--out", folder_ / "out"};
    if (*target) words.insert(words.end(), {"--target", target});
    const Output output = run(tether(words));
    EXPECT_EQ(output.code, 2);
    EXPECT_THAT(output.err, HasSubstr("--tunnel"));
  }
}

TEST_F(TargetFile, OfAConditionIsAmongWhatACampaignRestsOn) {
  write_target("clock = \"cpu\"\ncpu_factor = 3\n");
  write_hover_scenario(folder_.path(), "good",
                       {{"clock = \"cpu\"\n\n", "target = \"target.toml\"\n\n"}});
  write_text(folder_ / "campaign.toml",
             "name = \"small\"\ntrials = 1\n\n[[scenario]]\nfile = \"hover.toml\"\n");
  const std::vector<std::string> words = {"campaign", folder_ / "campaign.toml", "--out",
                                          folder_ / "out"};
  const Output first = run(tether(words));
  ASSERT_EQ(first.code, 0) << first.err;
  const auto trial = read_result(folder_ / "out/hover/host/seed-0001");
  EXPECT_EQ(trial["target"], "t");
  EXPECT_EQ(trial["cpu_factor"], 3.0);

  write_target("clock = \"cpu\"\ncpu_factor = 4\n");
  auto again = words;
  again.push_back("--resume");
  const Output resumed = run(tether(again));
  EXPECT_EQ(resumed.code, 2);
  EXPECT_THAT(resumed.err, HasSubstr("target.toml"));
}

}  // namespace
}  // namespace tether::system_test
