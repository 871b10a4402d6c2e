#include "support/trials.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether size` as a whole. The statistics: host/trial/sizing/test; the answer:
/// host/report/test/answers.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::StartsWith;

constexpr auto kLongest = 180s;  // on a loaded machine

class Size : public testing::Test {
 protected:
  Command size(const std::vector<std::string>& options, const std::string& out = "out") const {
    return with(tether({"size", folder_ / "hover.toml", "--out", folder_ / out}), options);
  }
  nlohmann::json answer(const std::string& out = "out") const {
    return nlohmann::json::parse(read_text(folder_ / out / "size.json"));
  }
  static Substitution limit(const std::string& max_s) {
    return {"kind = \"time_required\"", "kind = \"time_required\"\nmax_s = " + max_s};
  }

  TempFolder folder_;
};

// With a scripted clock, the limit is reached up to about 2 x slower.
TEST_F(Size, FindsTheSlowestSufficientComputerAlsoAfterCtrlC) {
  write_hover_scenario(folder_.path(), "good", {kScripted, limit("3.5")});
  const std::vector<std::string> options = {"--between", "1,20",    "--interval",
                                            "1.06",      "--junit", folder_ / "size.xml"};
  Process process(size(options));
  ASSERT_TRUE(process.wait_for_err("seed 12:", kLongest)) << process.err();
  process.signal(SIGINT);
  const Output interrupted = process.wait(15s);
  EXPECT_EQ(interrupted.code, 3);
  EXPECT_THAT(interrupted.err, HasSubstr("--resume"));
  EXPECT_THAT(interrupted.out, StartsWith("Interrupted, so far: "));
  EXPECT_EQ(answer()["interrupted"], true);

  const Output resumed = run(with(size(options), {"--resume"}), kLongest);
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_THAT(resumed.out, StartsWith("Sufficient up to "));
  const nlohmann::json found = answer();
  EXPECT_EQ(found["schema"], 1);
  EXPECT_EQ(found["scenario"], "hover");
  EXPECT_EQ(found["condition"], "host");
  EXPECT_THAT(found["summary"][1].get<std::string>(),
              AllOf(StartsWith("Not met: "), HasSubstr("time required ≤ 3.5 s")));
  EXPECT_EQ(found["question"]["between"], (nlohmann::json{1.0, 20.0}));
  EXPECT_EQ(found["answer"]["where"], "within");
  EXPECT_EQ(found["interrupted"], false);
  EXPECT_EQ(found["answer"]["narrow"], true);
  EXPECT_EQ(found["answer"]["basis"], "margins");
  EXPECT_GT(found["answer"]["low"], 1.5);
  EXPECT_LT(found["answer"]["high"], 2.5);
  EXPECT_EQ(found["not_flown"].size(), 0U);
  for (const char* file : {"out/report.html", "out/size.svg", "size.xml"})
    EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / file)) << file;

  ASSERT_EQ(run(size({"--between", "1,20", "--interval", "1.06"}, "whole"), kLongest).code, 0);
  EXPECT_EQ(answer("whole")["flights"], found["flights"]) << "the interruption changed the flights";
}

// The program reaches its goal, but sends no estimates.
TEST_F(Size, EndsWithoutAnAnswerIfALimitedMetricNeverHasAValue) {
  write_hover_scenario(
      folder_.path(), "good",
      {kScripted, {"kind = \"time_required\"", "kind = \"estimate_error\"\nmax_m = 1.0"}});
  const Output output = run(size({"--between", "1,2"}), kLongest);
  EXPECT_EQ(output.code, 3) << output.out;
  EXPECT_THAT(output.err, HasSubstr("estimate error has no value"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/size.json"));
}

// Beside this limit, how fast the machine is makes no difference. A limit that no speed keeps says
// nothing about the board.
TEST_F(Size, EndsByWhetherTheBoardSuffices) {
  write_text(folder_ / "board.toml", "name = \"board\"\nclock = \"cpu\"\ncpu_factor = 1.5\n");
  for (const auto& [max_s, code, verdict] :
       {std::tuple{"4.9", 0, "sufficient"}, {"0.1", 1, "undecided"}}) {
    write_hover_scenario(folder_.path(), "good", {limit(max_s)});
    const Output output =
        run(size({"--between", "1,2", "--target", folder_ / "board.toml"}, verdict), kLongest);
    EXPECT_EQ(output.code, code) << output.err;
    EXPECT_EQ(answer(verdict)["boards"][0]["verdict"], verdict);
  }
}

TEST_F(Size, RefusesAWrongQuestionBeforeItWrites) {
  write_hover_scenario(folder_.path(), "good", {kScripted});
  const Output undecided = run(size({}));
  EXPECT_EQ(undecided.code, 2);
  EXPECT_THAT(undecided.err, HasSubstr("hover.toml:"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  write_hover_scenario(folder_.path(), "good", {kScripted, limit("3.5")});
  const Output nothing = run(size({"--resume"}));
  EXPECT_EQ(nothing.code, 2);
  EXPECT_THAT(nothing.err,
              AllOf(StartsWith("tether: " + (folder_ / "out").string() + ": does not exist"),
                    HasSubstr("omit --resume")));
  for (const auto& [option, value] : {std::pair{"--success", "1"},
                                      {"--confidence", "0"},
                                      {"--interval", "1"},
                                      {"--between", "3,2"},
                                      {"--max-trials", "3"},
                                      {"--target", "none.toml"},
                                      {"--unsynchronised", "slow"},
                                      {"--condition", "moon"}}) {
    const Output output = run(size({option, value}));
    EXPECT_EQ(output.code, 2) << option;
    EXPECT_THAT(output.err, StartsWith("tether: ")) << option;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << option;
  }
}

}  // namespace
}  // namespace tether::system_test
