#include "support/trials.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// The command line as DESIGN section 5 promises it.
namespace tether::system_test {
namespace {

using testing::HasSubstr;

// ---- Help and version

class Help : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(Help, IsPrintedAndIsNoError) {
  const Output output = run({GetParam(), {}, {}});
  EXPECT_EQ(output.code, 0);
  EXPECT_EQ(output.err, "");
  EXPECT_THAT(output.out, HasSubstr("--help"));
}

INSTANTIATE_TEST_SUITE_P(
    Programs, Help,
    testing::Values(std::vector<std::string>{tether_program(), "--help"},
                    std::vector<std::string>{tether_program(), "run", "--help"},
                    std::vector<std::string>{tether_program(), "campaign", "--help"},
                    std::vector<std::string>{tether_program(), "report", "--help"},
                    std::vector<std::string>{tether_program(), "audit", "--help"},
                    std::vector<std::string>{tether_program(), "frames", "--help"},
                    std::vector<std::string>{sut_program(), "--help"},
                    std::vector<std::string>{sut_program(), "face_anchor", "--help"},
                    std::vector<std::string>{sut_program(), "relative_position", "--help"}),
    [](const auto& command) {
      std::string name = std::filesystem::path(command.param[0]).filename();
      name = name == "tether" ? "tether" : "sut";
      return command.param.size() > 2 ? name + "_" + command.param[1] : name;
    });

class Examples : public testing::TestWithParam<std::string> {};

TEST_P(Examples, StandInTheHelpOfEachCommand) {
  EXPECT_THAT(run(tether({GetParam(), "--help"})).out, HasSubstr("\n  tether " + GetParam() + " "));
}

INSTANTIATE_TEST_SUITE_P(Commands, Examples,
                         testing::Values("run", "campaign", "report", "audit", "frames", "target"),
                         [](const auto& command) { return command.param; });

TEST(Version, IsOneLineOfEachProgram) {
  for (const auto& program : {tether_program(), sut_program()}) {
    const Output output = run({{program, "--version"}, {}, {}});
    EXPECT_EQ(output.code, 0);
    EXPECT_THAT(output.out, testing::ContainsRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
    EXPECT_EQ(std::count(output.out.begin(), output.out.end(), '\n'), 1);
  }
}

// ---- Wrong use

class WrongUse : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(WrongUse, EndsWithTwoAndSaysWhy) {
  const TempFolder folder;
  Command command = tether(GetParam());
  command.working_folder = folder.path();
  const Output output = run(command);
  EXPECT_EQ(output.code, 2);
  EXPECT_NE(output.err, "");
  EXPECT_EQ(output.out, "");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

INSTANTIATE_TEST_SUITE_P(
    Commands, WrongUse,
    testing::Values(std::vector<std::string>{}, std::vector<std::string>{"fly"},
                    std::vector<std::string>{"run"}, std::vector<std::string>{"--speed"},
                    std::vector<std::string>{"run", "a.toml", "--seed", "many"},
                    std::vector<std::string>{"run", "a.toml", "--real-time-factor", "-1"},
                    std::vector<std::string>{"run", "a.toml", "--seed", "-1"},
                    std::vector<std::string>{"run", "a.toml", "--real-time-factor", "nan"},
                    std::vector<std::string>{"audit", "nothing.mcap"},
                    std::vector<std::string>{"report", "nowhere"},
                    std::vector<std::string>{"report", ".", "--format", "xml"},
                    std::vector<std::string>{"campaign", "nothing.toml"}));

// ---- Names of shipped files

TEST(ShippedNames, AreListedWithTheirDescriptions) {
  const Output output = run(tether({"list"}));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.out, HasSubstr("\n  face_anchor  "));
  EXPECT_THAT(output.out, HasSubstr("\n  six_times_slower  "));
}

TEST(ShippedNames, StandForScenarioProfileAndTarget) {
  const TempFolder folder;
  const Output output = run(tether({"run", "face_anchor", "--profile", "ideal", "--target",
                                    "six_times_slower", "--quiet", "--out", folder / "out"}));
  EXPECT_LE(output.code, 1) << output.err;
  const auto result = read_result(folder / "out");
  EXPECT_EQ(result["scenario"], "face_anchor");
  EXPECT_EQ(result["condition"], "six_times_slower");
  EXPECT_EQ(result["profiles"].back(), "ideal");
}

TEST(ShippedNames, OfNothingEndWithTwoAndNameTheNearest) {
  const Output output = run(tether({"campaign", "face_ancor"}));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("'face_anchor'"));
}

TEST(SutProgram, EndsWithTwoAfterWrongUse) {
  const Output output = run({{sut_program(), "face_anchor"}, {}, {}});
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("--anchor"));
}

TEST(SutProgram, EndsWithThreeWhereThereIsNoCoordinator) {
  const Output output =
      run({{sut_program(), "face_anchor", "--anchor", "blue_box", "--address", "127.0.0.1:1"},
           {{"TETHER_TOKEN", "x"}},
           {}},
          std::chrono::seconds(30));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("127.0.0.1:1"));
}

// ---- Runs

TEST(Run, LeavesAResultAndARecordThatAgree) {
  const TempFolder folder;
  const Output output = run(tether({"run", write_hover_scenario(folder.path(), "good"), "--seed",
                                    "7", "--out", folder / "out"}));
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.out, HasSubstr("goal_reached"));

  const auto result = read_result(folder / "out");
  const record::Record record = read_record(folder / "out");
  EXPECT_EQ(record.damage, "");
  EXPECT_EQ(result["exit_code"], 0);
  EXPECT_EQ(result["seed"], 7);
  EXPECT_EQ(record.header.seed, 7u);
  EXPECT_EQ(result["scenario"], record.header.scenario);
  EXPECT_EQ(result["condition"], record.header.condition);
  EXPECT_EQ(result["policy"], record.header.policy);
  EXPECT_EQ(result["versions"]["simulator"], record.header.simulator);
  ASSERT_TRUE(record.footer);
  EXPECT_EQ(result["end"], record.footer->end);
  EXPECT_EQ(result["sync"]["interactions"], record.footer->interactions);
  EXPECT_EQ(result["sync"]["interactions"], record.interactions.size());
  EXPECT_EQ(result["sync"]["causality_violations"], 0);
  EXPECT_DOUBLE_EQ(result["sync"]["st_at_end_s"], to_seconds(record.footer->st_at_end));
  EXPECT_DOUBLE_EQ(result["suts"][0]["et_at_end_s"], to_seconds(record.footer->et_at_end[0]));
  EXPECT_EQ(result["suts"][0]["sut"], "bad_sut");
  EXPECT_EQ(result["audit"]["passed"], true);
}

// 100 rounds of four interactions, and the end: nothing is lost on the way into the record.
TEST(Run, RecordsWhatTheSutDid) {
  const TempFolder folder;
  ASSERT_EQ(run(tether({"run", write_hover_scenario(folder.path(), "good"), "--out", folder / "out",
                        "--quiet"}))
                .code,
            0);
  const record::Record record = read_record(folder / "out");
  EXPECT_EQ(record.interactions.size(), 401u);
  EXPECT_EQ(record.commands.size(), 100u);
  EXPECT_EQ(record.annotations.size(), 100u);
  EXPECT_EQ(record.interactions.back().message.kind, record::kFinish);
  EXPECT_GE(record.footer->st_at_end, from_ns<SimTime>(1'400'000'000));
}

// The same measurement again and again is no breach of the rules where it was asked for.
TEST(Run, MayReadTheLatestMeasurementAgain) {
  const TempFolder folder;
  ASSERT_EQ(run(tether({"run", write_hover_scenario(folder.path(), "latest"), "--out",
                        folder / "out", "--quiet"}))
                .code,
            0);
  const Output audit = run(tether({"audit", folder / "out/record.mcap"}));
  EXPECT_EQ(audit.code, 0) << audit.out;
}

TEST(Run, PrintsTheResultAsJson) {
  const TempFolder folder;
  const Output output = run(tether(
      {"run", write_hover_scenario(folder.path(), "good"), "--out", folder / "out", "--json"}));
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(nlohmann::json::parse(output.out), read_result(folder / "out"));
}

TEST(Run, IsQuietWhenAsked) {
  const TempFolder folder;
  const Output output = run(tether(
      {"run", write_hover_scenario(folder.path(), "good"), "--out", folder / "out", "--quiet"}));
  EXPECT_EQ(output.code, 0);
  EXPECT_EQ(output.out, "");
  EXPECT_EQ(output.err, "");
}

TEST(Run, EndsWithOneWhenTheGoalIsMissed) {
  const TempFolder folder;
  const Output output =
      run(tether({"run", write_hover_scenario(folder.path(), "missed"), "--out", folder / "out"}));
  EXPECT_EQ(output.code, 1);
  EXPECT_EQ(read_result(folder / "out")["outcome"], "goal_missed");
  EXPECT_EQ(read_result(folder / "out")["exit_code"], 1);
  EXPECT_THAT(read_result(folder / "out")["reason"].get<std::string>(), HasSubstr("not flown"));
}

TEST(Run, EndsWithOneWhenAMetricIsBeyondItsLimit) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(
      folder.path(), "good", {{"kind = \"time_required\"", "kind = \"time_required\"\nmax_s = 1"}});
  EXPECT_EQ(run(tether({"run", scenario, "--out", folder / "out"})).code, 1);
  EXPECT_THAT(read_result(folder / "out")["reason"].get<std::string>(), HasSubstr("time_required"));
}

TEST(Run, TakesItsFolderFromScenarioConditionAndSeed) {
  const TempFolder folder;
  Command command = tether({"run", write_hover_scenario(folder.path(), "good"), "--condition",
                            "slow", "--seed", "3", "--quiet"});
  command.working_folder = folder.path();
  EXPECT_EQ(run(command).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/hover/slow/seed-0003/result.json"));
}

TEST(Run, ReplacesAnEarlierResult) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "out");
  write_text(folder / "out/result.json", "old");
  write_text(folder / "out/record.mcap", "old");
  EXPECT_EQ(run(tether({"run", write_hover_scenario(folder.path(), "good"), "--out", folder / "out",
                        "--quiet"}))
                .code,
            0);
  EXPECT_EQ(read_result(folder / "out")["end"], "finished");
  EXPECT_EQ(read_record(folder / "out").damage, "");
}

// ---- The face-anchor task under each condition, and its audit

class FaceAnchor : public testing::TestWithParam<std::string> {};

TEST_P(FaceAnchor, ReachesItsGoalAndPassesTheAudit) {
  const TempFolder folder;
  const Output output = run(tether({"run", write_face_scenario(folder.path()), "--condition",
                                    GetParam(), "--seed", "5", "--out", folder / "out"}));
  EXPECT_THAT(output.code, testing::AnyOf(0, 1)) << output.err;
  EXPECT_EQ(read_result(folder / "out")["end"], "finished");

  const Output audit = run(tether({"audit", folder / "out/record.mcap"}));
  EXPECT_EQ(audit.code, 0) << audit.out;
  EXPECT_EQ(read_result(folder / "out")["policy"],
            GetParam() == "target, no sync" ? "free_running" : "conservative_barrier");
}

INSTANTIATE_TEST_SUITE_P(Conditions, FaceAnchor,
                         testing::Values("host", "target", "target, no sync"),
                         [](const auto& condition) {
                           return condition.param == "host"     ? "host"
                                  : condition.param == "target" ? "target"
                                                                : "no_sync";
                         });

TEST(FaceAnchorImages, AreInTheRecordWhenAskedFor) {
  const TempFolder folder;
  const Output output = run(tether(
      {"run", write_face_scenario(folder.path()), "--images", "--out", folder / "out", "--quiet"}));
  EXPECT_EQ(output.code, 0) << output.err;
  const record::Record record = read_record(folder / "out");
  std::size_t reads = 0;
  for (const auto& entry : record.interactions) reads += entry.message.sensor == "camera" ? 1u : 0u;
  EXPECT_GT(reads, 5u);
  EXPECT_EQ(record.images.size(), reads);

  const Output frames =
      run(tether({"frames", folder / "out/record.mcap", "--out", folder / "frames"}));
  EXPECT_EQ(frames.code, 0) << frames.err;
  const std::filesystem::directory_iterator pictures(folder / "frames");
  EXPECT_EQ(static_cast<std::size_t>(std::distance(begin(pictures), end(pictures))), reads);
}

// A record may come from anybody.
TEST(FaceAnchorImages, OfARecordWithForeignNamesAreDrawnIntoTheFolderAllTheSame) {
  const TempFolder folder;
  const Output output = run(tether(
      {"run", write_face_scenario(folder.path()), "--images", "--out", folder / "out", "--quiet"}));
  ASSERT_EQ(output.code, 0) << output.err;
  record::Record record = read_record(folder / "out");
  for (auto& entry : record.images) entry.message.uav = "../../uav";
  std::filesystem::create_directory(folder / "foreign");
  write_record(folder / "foreign/record.mcap", record);

  EXPECT_EQ(run(tether({"frames", folder / "foreign/record.mcap"})).code, 0);
  std::size_t drawn = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.path().extension() != ".svg") continue;
    EXPECT_EQ(entry.path().parent_path(), folder / "foreign/frames");
    ++drawn;
  }
  EXPECT_EQ(drawn, record.images.size());
}

}  // namespace
}  // namespace tether::system_test
