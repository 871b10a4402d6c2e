#include "support/faults.h"

#include <algorithm>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Time that was recorded once and is replayed. Modes and stages:
/// host/record/timing/test/replay_test.cpp; what ends the run:
/// host/flight/coordinator/test/replay_test.cpp.
namespace tether::system_test {
namespace {

using testing::HasSubstr;

class TimingRun : public RunTest {
 protected:
  /// The hover scenario with counted_sut in that mode, and these keys instead of its clock.
  std::filesystem::path scenario(const std::string& mode, const std::string& clock) const {
    return write_hover_scenario(
        folder_.path(), mode,
        {{bad_sut_program().string(), COUNTED_SUT_PROGRAM}, {"clock = \"cpu\"", clock}});
  }
  void fly(const std::string& mode, const std::string& clock, const std::string& out,
           const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = {"run", scenario(mode, clock), "--out", folder_ / out,
                                      "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    const Output output = run(tether(words, mark_));
    ASSERT_EQ(output.code, 0) << output.err;
  }
  Output timing(std::vector<std::string> words) const {
    words.insert(words.begin(), "timing");
    return run(tether(words, mark_));
  }
  std::string replayed(const std::string& more) const {
    return "clock = \"replayed\"\ntiming = \"" + (folder_ / "a.timing").string() + "\"\n" + more;
  }
};

std::vector<record::Interaction> interactions(const std::filesystem::path& folder) {
  std::vector<record::Interaction> all;
  for (const auto& entry : read_record(folder).interactions) all.push_back(entry.message);
  return all;
}

double median_ns(const std::filesystem::path& folder, const std::string& stage) {
  std::vector<double> times;
  for (const record::Interaction& entry : interactions(folder))
    for (const record::StageTime& time : entry.stages)
      if (time.stage == stage) times.push_back(static_cast<double>(time.computing.count()));
  std::sort(times.begin(), times.end());
  return times.at(times.size() / 2);
}

TEST_F(TimingRun, IsReplayedToTheNanosecond) {
  fly("good", "clock = \"cpu\"", "measured");
  const Output table = timing({folder_ / "measured", "--out", folder_ / "a.timing", "--html",
                               folder_ / "a.html", "--csv", folder_ / "a.csv"});
  ASSERT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("work"));
  EXPECT_THAT(read_text(folder_ / "a.csv"), HasSubstr("work,100,"));
  for (const std::string out : {"replayed", "again"})
    fly("good", replayed("mode = \"exact\""), out);
  const auto measured = interactions(folder_ / "measured"), again = interactions(folder_ / "again");
  ASSERT_EQ(measured.size(), again.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    ASSERT_EQ(measured[i].request_at, again[i].request_at) << i;
    ASSERT_EQ(measured[i].reply_at, again[i].reply_at) << i;
    ASSERT_EQ(measured[i].stages, again[i].stages) << i;
  }
  EXPECT_EQ(read_text(folder_ / "again/record.mcap"), read_text(folder_ / "replayed/record.mcap"));
  const auto result = read_result(folder_ / "again");
  EXPECT_EQ(result["replay"]["mode"], "exact");
  EXPECT_EQ(result["replay"]["timing"], "a.timing");
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
}

// The build id is the same: what it is asked to do is not.
TEST_F(TimingRun, IsRefusedToTheSameProgramWithAnotherArgument) {
  fly("good", "clock = \"cpu\"", "measured");
  ASSERT_EQ(timing({folder_ / "measured", "--out", folder_ / "a.timing"}).code, 0);
  const auto slower = scenario("slower", replayed("mode = \"exact\""));
  const Output output = run(tether({"run", slower, "--out", folder_ / "slower", "--quiet"}, mark_));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("was \"good\", is \"slower\""));
}

// The planted change: the stage "work" does a fifth more. No run on the "board" has it.
TEST_F(TimingRun, ShowsASlowerStageWithoutTheBoard) {
  write_text(folder_ / "target.toml",
             "name = \"t\"\nclock = \"counted\"\nemulator = \"qemu-x86_64\"\n"
             "cpu_model = \"Nehalem\"\n[cost_ns]\ninteger = 0.3\nmultiply = 1\ndivide = 7\n"
             "load = 0.5\nstore = 0.5\nbranch = 0.5\nscalar_float = 1\nvector_float = 1\n"
             "vector_integer = 1\natomic = 10\n");
  const std::vector<std::string> counted = {"--target", folder_ / "target.toml"};
  fly("good", "clock = \"cpu\"", "measured");
  fly("good", "clock = \"cpu\"", "old", counted);
  fly("slower", "clock = \"cpu\"", "new", counted);
  ASSERT_EQ(
      timing({folder_ / "measured", "--counted", folder_ / "old", "--out", folder_ / "a.timing"})
          .code,
      0);
  ASSERT_EQ(timing({folder_ / "new", "--out", folder_ / "new.timing"}).code, 0);
  fly("slower", replayed("mode = \"resampled\""), "resampled");
  fly("slower",
      replayed("mode = \"scaled\"\ncounted = \"" + (folder_ / "new.timing").string() + "\""),
      "scaled");
  EXPECT_NEAR(median_ns(folder_ / "scaled", "work") / median_ns(folder_ / "resampled", "work"), 1.2,
              0.02);
  EXPECT_EQ(timing({folder_ / "new", "--against", folder_ / "old", "--limit", "10"}).code, 1);
  const Output change = timing({folder_ / "new", "--against", folder_ / "old", "--limit", "30",
                                "--json", "--junit", folder_ / "timing.xml"});
  EXPECT_EQ(change.code, 0);
  EXPECT_EQ(nlohmann::json::parse(change.out)["is_beyond_limit"], false);
  EXPECT_THAT(read_text(folder_ / "timing.xml"), HasSubstr("failures=\"0\""));
  EXPECT_EQ(timing({folder_ / "new", "--junit", folder_ / "timing.xml"}).code, 2);
}

// A program that sleeps instead of computing is no faster.
TEST_F(TimingRun, HoldsNoFlightWithoutAnAnswerAgainstALimit) {
  for (const std::string out : {"old", "new"}) fly("good", "clock = \"cpu\"", out);
  nlohmann::json result = read_result(folder_ / "new");
  const auto doubted = [&](const char* doubt) {
    result["this_run"]["doubts"] = {{{"kind", doubt}, {"subject", "uav1"}, {"amount", 2.5}}};
    write_text(folder_ / "new/result.json", result.dump());
    return timing({folder_ / "new", "--against", folder_ / "old", "--limit", "1000000", "--junit",
                   folder_ / "timing.xml"});
  };
  const Output busy = doubted("busy_machine");
  EXPECT_EQ(busy.code, 0) << busy.err;
  EXPECT_THAT(busy.out, HasSubstr("its times may be off by about 250 %"));
  const Output slept = doubted("unseen_wait");
  EXPECT_EQ(slept.code, 3);
  EXPECT_THAT(slept.err,
              HasSubstr("waited up to about 2.5 s on something that Tether does not see"));
  EXPECT_THAT(read_text(folder_ / "timing.xml"), HasSubstr("errors=\"1\""));
}

}  // namespace
}  // namespace tether::system_test
