#include "support/trials.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// A wrong file or option gets one line that names file and line, exit code 2, and leaves nothing.
namespace tether::system_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Refused with one line of which `expected` are parts.
void expect_refused(const Output& output, const std::vector<std::string>& expected,
                    const std::filesystem::path& out) {
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_EQ(output.out, "");
  EXPECT_THAT(output.err, StartsWith("tether: "));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  for (const std::string& part : expected) EXPECT_THAT(output.err, HasSubstr(part));
  EXPECT_FALSE(std::filesystem::exists(out)) << "half-written: " << out;
}

// ---- Scenarios

struct WrongScenario {
  std::string what;
  Substitution change;
  std::string at;                     ///< in the changed text, on the line to be named
  std::vector<std::string> expected;  ///< parts of the message
};

void PrintTo(const WrongScenario& wrong, std::ostream* out) {
  *out << wrong.what;
}

const WrongScenario kWrongScenarios[] = {
    {"unknown_key",
     {"hang_limit_s = 2", "hang_limt_s = 2"},
     "hang_limt_s",
     {"hang_limt_s", "hang_limit_s"}},
    {"wrong_type", {"time_limit_s = 5", "time_limit_s = \"5\""}, "time_limit_s", {"time_limit_s"}},
    {"wrong_unit",
     {"time_limit_s = 5", "time_limit_s = 5\nstep_s = 0.001"},
     "step_s",
     {"step_s", "step_ms"}},
    {"impossible_value",
     {"cpu_factor = 10.0", "cpu_factor = -1.0"},
     "cpu_factor = -1.0",
     {"cpu_factor", "-1"}},
    {"no_number", {"time_limit_s = 5", "time_limit_s = nan"}, "time_limit_s", {"time_limit_s"}},
    {"wrong_word",
     {"\"conservative_barrier\"", "\"barrier\""},
     "\"barrier\"",
     {"barrier", "conservative_barrier", "free_running"}},
    {"no_toml", {"[sut]", "[sut"}, "[sut\n", {}},
    {"twice", {"time_limit_s = 5", "time_limit_s = 5\ntime_limit_s = 6"}, "time_limit_s = 6", {}},
    {"missing_model",
     {"hummingbird/model.sdf", "hummingbrd/model.sdf"},
     "hummingbrd",
     {"hummingbrd"}},
    {"unknown_metric",
     {"\"time_required\"", "\"elegance\""},
     "\"elegance\"",
     {"elegance", "time_required"}},
};

class ScenarioFile : public testing::TestWithParam<WrongScenario> {};

TEST_P(ScenarioFile, IsRefusedWithItsLine) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good", {GetParam().change});
  const int line = line_of(read_text(scenario), GetParam().at);
  std::vector<std::string> expected = GetParam().expected;
  expected.push_back(scenario.string() + ":" + std::to_string(line) + ":");
  expect_refused(run(tether({"run", scenario, "--out", folder / "out"})), expected, folder / "out");
}

INSTANTIATE_TEST_SUITE_P(Wrong, ScenarioFile, testing::ValuesIn(kWrongScenarios),
                         [](const auto& wrong) { return wrong.param.what; });

TEST(Scenario, WithoutANeededKeyIsRefused) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good", {{"time_limit_s = 5\n", ""}});
  expect_refused(run(tether({"run", scenario, "--out", folder / "out"})),
                 {scenario.string() + ":", "time_limit_s"}, folder / "out");
}

TEST(Scenario, ThatDoesNotExistIsRefused) {
  const TempFolder folder;
  expect_refused(run(tether({"run", folder / "nothing.toml", "--out", folder / "out"})),
                 {folder / "nothing.toml"}, folder / "out");
}

TEST(Scenario, ThatIsAFolderIsRefused) {
  const TempFolder folder;
  expect_refused(run(tether({"run", folder.path(), "--out", folder / "out"})), {folder.path()},
                 folder / "out");
}

TEST(SutProgram, ThatDoesNotExistIsRefused) {
  const TempFolder folder;
  const auto scenario =
      write_hover_scenario(folder.path(), "good", {{bad_sut_program().string(), "no-such-sut"}});
  expect_refused(run(tether({"run", scenario, "--out", folder / "out"})),
                 {scenario, "\"uav1\"", "no-such-sut"}, folder / "out");
}

TEST(Condition, ThatTheScenarioLacksIsRefused) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good");
  expect_refused(run(tether({"run", scenario, "--condition", "moon", "--out", folder / "out"})),
                 {scenario, "moon", "\"host\"", "\"slow\""}, folder / "out");
}

TEST(ListenAddress, ThatIsNoneIsRefused) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good");
  expect_refused(run(tether({"run", scenario, "--listen", "here", "--out", folder / "out"})),
                 {"--listen", "here"}, folder / "out");
}

TEST(Sensor, ThatTheUavLacksIsRefused) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(
      folder.path(), "good", {{"\n[sut]", "\n[uav.sensors.sonar]\ntiming = \"on_demand\"\n[sut]"}});
  const int line = line_of(read_text(scenario), "sonar");
  expect_refused(run(tether({"run", scenario, "--out", folder / "out"})),
                 {scenario.string() + ":" + std::to_string(line) + ":", "sonar", "range"},
                 folder / "out");
}

TEST(Anchor, ThatTheWorldLacksIsRefused) {
  const TempFolder folder;
  const auto scenario =
      write_hover_scenario(folder.path(), "good", {{"[\"blue_box\"]", "[\"red_box\"]"}});
  expect_refused(run(tether({"run", scenario, "--out", folder / "out"})), {"red_box"},
                 folder / "out");
}

// ---- Worlds

struct WrongWorld {
  std::string what;
  Substitution change;
  std::string at;  ///< in the changed text, on the line to be named; empty: no line
  std::vector<std::string> expected;
};

void PrintTo(const WrongWorld& wrong, std::ostream* out) {
  *out << wrong.what;
}

const WrongWorld kWrongWorlds[] = {
    {"no_xml", {"</light>", "</ligt>"}, "<light name", {"XML"}},
    {"two_worlds", {"</world>", "</world><world name=\"b\"/>"}, "", {}},
    {"impossible_size", {"<size>20 20 0.1</size>", "<size>20 -20 0.1</size>"}, "20 -20", {"size"}},
    {"missing_mesh",
     {"<box><size>0.5 0.5 0.5</size></box>", "<mesh><uri>no/such.obj</uri></mesh>"},
     "no/such.obj",
     {"no/such.obj"}},
    {"no_number", {"<pose>3 0 1 0 0 0</pose>", "<pose>3 0 one 0 0 0</pose>"}, "0 one", {}},
};

class WorldFile : public testing::TestWithParam<WrongWorld> {};

TEST_P(WorldFile, IsRefusedWithItsName) {
  const TempFolder folder;
  const auto world = folder / "broken.sdf";
  const std::string sound = std::filesystem::path(TETHER_TEST_DIR) / "data/hover.sdf";
  const std::string text = substituted(read_text(sound), {GetParam().change});
  write_text(world, text);
  const auto scenario = write_hover_scenario(folder.path(), "good", {{sound, world}});
  std::vector<std::string> expected = GetParam().expected;
  expected.push_back(GetParam().at.empty()
                         ? world.string()
                         : world.string() + ":" + std::to_string(line_of(text, GetParam().at)));
  expect_refused(run(tether({"run", scenario, "--out", folder / "out"})), expected, folder / "out");
}

INSTANTIATE_TEST_SUITE_P(Wrong, WorldFile, testing::ValuesIn(kWrongWorlds),
                         [](const auto& wrong) { return wrong.param.what; });

TEST(World, ThatDoesNotExistIsRefusedWithTheScenariosLine) {
  const TempFolder folder;
  const std::string sound = std::filesystem::path(TETHER_TEST_DIR) / "data/hover.sdf";
  const auto scenario =
      write_hover_scenario(folder.path(), "good", {{sound, folder / "nowhere.sdf"}});
  const int line = line_of(read_text(scenario), "nowhere.sdf");
  expect_refused(run(tether({"run", scenario, "--out", folder / "out"})),
                 {scenario.string() + ":" + std::to_string(line) + ":", "nowhere.sdf"},
                 folder / "out");
}

// ---- Records

TEST(Record, ThatIsNoneIsRefused) {
  const TempFolder folder;
  write_text(folder / "record.mcap", "no MCAP at all");
  expect_refused(run(tether({"audit", folder / "record.mcap"})), {folder / "record.mcap"},
                 folder / "out");
}

}  // namespace
}  // namespace tether::system_test
