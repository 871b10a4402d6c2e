#include "support/faults.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// The commands of both programs: their output, exit codes and files.
namespace tether::system_test {
namespace {

using testing::HasSubstr;

// Help of every command: packages/manual_pages_test.cpp.
TEST(Help, HasAnExampleOfEachCommand) {
  for (const std::string command :
       {"run", "campaign", "report", "audit", "frames", "target", "world"}) {
    const Output output = run(tether({command, "--help"}));
    EXPECT_EQ(output.err, "");
    EXPECT_THAT(output.out, HasSubstr("\n  tether " + command + " "));
  }
}

// The scripts themselves: apps/tether/test/completion_test.cpp.
TEST(Completion, OfBashIsMadeFromTheOptionsOfEachProgram) {
  const auto completed = [](const std::filesystem::path& program, const std::string& words) {
    const std::string name = program.filename();
    std::string function = "_" + name;
    std::ranges::replace(function, '-', '_');
    const std::string code = "PATH='" + program.parent_path().string() + "':$PATH\nsource <('" +
                             program.string() + "' completion bash)\nCOMP_WORDS=(" + name + " " +
                             words + ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n" + function +
                             "\necho \"${COMPREPLY[@]}\"";
    return run({{"bash", "-c", code}}).out;
  };
  EXPECT_EQ(completed(tether_program(), "timing a --ju"), "--junit\n");
  EXPECT_EQ(completed(tether_program(), "run --world corri"), "corridor\n");
  EXPECT_EQ(completed(tether_program(), "size a --axis ''"), "slowdown uavs\n");
  EXPECT_EQ(completed(sut_program(), "face_anchor --prec"), "--precision-deg\n");
}

TEST(Version, IsOneLineOfEachProgram) {
  for (const auto& program : {tether_program(), sut_program()}) {
    const Output output = run({{program, "--version"}});
    EXPECT_EQ(output.code, 0);
    EXPECT_THAT(output.out, HasSubstr(TETHER_VERSION_NUMBER));
    EXPECT_EQ(std::ranges::count(output.out, '\n'), 1);
  }
}

TEST(WrongUse, EndsWithTwoAndWritesNothing) {
  const std::vector<std::string> uses[] = {{},
                                           {"fly"},
                                           {"run"},
                                           {"--speed"},
                                           {"run", "a.toml", "--seed", "many"},
                                           {"run", "a.toml", "--seed", "-1"},
                                           {"run", "a.toml", "--real-time-factor", "-1"},
                                           {"run", "a.toml", "--real-time-factor", "nan"},
                                           {"run", "--"},
                                           {"run", "--world", "yard", "face_anchor"},
                                           {"run", "--", "./there-is-no-such-program"},
                                           {"run", "--", "/sbin/ldconfig"},
                                           {"run", "--anchor", "nothing", "--", "true"},
                                           {"run", "--condition", "x", "--", "true"},
                                           {"audit", "nothing.mcap"},
                                           {"report", "nowhere"},
                                           {"report", ".", "--format", "xml"},
                                           {"campaign", "nothing.toml"},
                                           {"target", "check", "board"}};
  for (const auto& use : uses) {
    const TempFolder folder;
    Command command = tether(use);
    command.working_folder = folder.path();
    const Output output = run(command);
    EXPECT_EQ(output.code, 2) << testing::PrintToString(use);
    EXPECT_NE(output.err, "");
    EXPECT_EQ(output.out, "");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

// ---- Names of shipped files

TEST(ShippedNames, AreListedWithTheirDescriptions) {
  const Output output = run(tether({"list"}));
  EXPECT_EQ(output.code, 0) << output.err;
  for (const char* name : {"face_anchor", "six_times_slower"})
    EXPECT_THAT(output.out, HasSubstr("\n  " + std::string(name) + "  "));
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

TEST(WorldCheck, PrintsWhatIsNotSimulatedUnlessTheWorldCannotBeUsed) {
  const TempFolder folder;
  write_text(folder / "w.sdf",
             "<sdf version='1.7'><world name='w'><plugin name='p' filename='p'/>"
             "<include><uri>model://gone</uri></include></world></sdf>");
  const Output refused = run(tether({"world", "check", folder / "w.sdf", "--strict"}));
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.out, "");
  EXPECT_THAT(refused.err, HasSubstr("model://gone"));
  const Output used = run(tether({"world", "check", folder / "w.sdf"}));
  EXPECT_EQ(used.code, 0) << used.err;
  EXPECT_EQ(used.err, "");
  EXPECT_THAT(used.out,
              testing::AllOf(HasSubstr("<include> of 'model://gone'"), HasSubstr("plugin 'p'")));
}

TEST(SutProgram, EndsWithThreeWhereThereIsNoCoordinator) {
  const Output output =
      run({{sut_program(), "face_anchor", "--anchor", "blue_box", "--address", "127.0.0.1:1"},
           {{"TETHER_TOKEN", "x"}}});
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("127.0.0.1:1"));
}

// ---- Runs

using RunCommand = RunTest;

TEST_F(RunCommand, LeavesAResultAndARecordThatAgree) {
  const Output output = run(flight("good", {"--seed", "7"}));
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.out, HasSubstr("goal_reached"));

  const auto result = read_result(out_);
  const record::Record record = read_record(out_);
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
  EXPECT_EQ(result["sync"]["causality_violations"], 0);
  EXPECT_DOUBLE_EQ(result["sync"]["st_at_end_s"], to_seconds(record.footer->st_at_end));
  EXPECT_DOUBLE_EQ(result["suts"][0]["et_at_end_s"], to_seconds(record.footer->et_at_end[0]));
  EXPECT_EQ(result["suts"][0]["sut"], "bad_sut");
  EXPECT_EQ(result["audit"]["passed"], true);
  // 100 rounds of four interactions, and the end: nothing is lost on the way into the record.
  EXPECT_EQ(record.interactions.size(), 401u);
  EXPECT_EQ(record.commands.size(), 100u);
  EXPECT_EQ(record.annotations.size(), 100u);
  EXPECT_EQ(record.interactions.back().message.kind, record::kFinish);
  EXPECT_GE(record.footer->st_at_end, from_ns<SimTime>(1'400'000'000));
}

// The same measurement again and again breaks no rule where it was asked for.
TEST_F(RunCommand, ReplacesAnEarlierResultAndMayReadTheLatestMeasurementAgain) {
  std::filesystem::create_directories(out_);
  write_text(out_ / "result.json", "old");
  write_text(out_ / "record.mcap", "old");
  const Output output = run(flight("latest", {"--quiet"}));
  EXPECT_EQ(output.code, 0);
  EXPECT_EQ(output.out + output.err, "");
  EXPECT_EQ(result()["end"], "finished");
  EXPECT_EQ(audit_code(out_), 0);
}

TEST_F(RunCommand, EndsWithOneWhenTheGoalIsMissed) {
  const Output output = run(flight("missed", {"--json"}));
  EXPECT_EQ(output.code, 1);
  nlohmann::json printed = nlohmann::json::parse(output.out);
  EXPECT_EQ(printed["answer"]["answer"], "goal missed");
  printed.erase("answer");
  EXPECT_EQ(printed, result());
  EXPECT_EQ(result()["outcome"], "goal_missed");
  EXPECT_EQ(result()["exit_code"], 1);
  EXPECT_THAT(reason(), HasSubstr("not flown"));
}

TEST_F(RunCommand, TakesItsFolderFromScenarioConditionAndSeed) {
  // A metric beyond its limit is a goal missed.
  const auto scenario =
      write_hover_scenario(folder_.path(), "good",
                           {{"kind = \"time_required\"", "kind = \"time_required\"\nmax_s = 1"}});
  Command command = tether({"run", scenario, "--condition", "slow", "--seed", "3", "--quiet"});
  command.working_folder = folder_.path();
  EXPECT_EQ(run(command).code, 1);
  EXPECT_THAT(read_result(out_ / "hover/slow/seed-0003")["reason"].get<std::string>(),
              HasSubstr("time_required"));
}

// ---- Images

// A record may come from anybody: foreign names in it lead nowhere else.
TEST(FaceAnchorImages, AreInTheRecordWhenAskedForAndDrawnIntoTheFolder) {
  const TempFolder folder;
  const Output output = run(tether(
      {"run", write_face_scenario(folder.path()), "--images", "--out", folder / "out", "--quiet"}));
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(audit_code(folder / "out"), 0);
  record::Record record = read_record(folder / "out");
  const auto reads = std::ranges::count_if(
      record.interactions, [](const auto& entry) { return entry.message.sensor == "camera"; });
  EXPECT_GT(reads, 5);
  EXPECT_EQ(std::ssize(record.images), reads);

  for (auto& entry : record.images) entry.message.uav = "../../uav";
  std::filesystem::create_directory(folder / "foreign");
  write_record(folder / "foreign/record.mcap", record);
  EXPECT_EQ(run(tether({"frames", folder / "foreign/record.mcap"})).code, 0);
  std::ptrdiff_t drawn = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.path().extension() != ".svg") continue;
    EXPECT_EQ(entry.path().parent_path(), folder / "foreign/frames");
    ++drawn;
  }
  EXPECT_EQ(drawn, reads);
}

}  // namespace
}  // namespace tether::system_test
