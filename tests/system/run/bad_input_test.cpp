#include "support/trials.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// A wrong file or option: one line that names file and line, exit code 2, and no output folder.
/// Each rule of a file: host/plan/scenario/test, host/world/sim/sdf/test.
namespace tether::system_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct WrongInput {
  std::string what;
  Substitution change;                 ///< of the hover scenario, or of its world
  std::string at;                      ///< in the changed text, on the line to be named
  std::vector<std::string> named{};    ///< besides
  std::vector<std::string> options{};  ///< of `tether run`
  bool in_world = false;
};

void PrintTo(const WrongInput& wrong, std::ostream* out) {
  *out << wrong.what;
}

const WrongInput kWrongInputs[] = {
    {"UnknownKey", {"hang_limit_s = 2", "hang_limt_s = 2"}, "hang_limt_s", {"hang_limit_s"}},
    {"NoToml", {"[sut]", "[sut"}, "[sut\n"},
    {"MissingModel", {"hummingbird/model.sdf", "hummingbrd/model.sdf"}, "hummingbrd"},
    {"MissingWorld", {"world.sdf\"", "nowhere.sdf\""}, "nowhere.sdf"},
    {"MissingProgram", {"command = [\"", "command = [\"./none\", \""}, "", {"\"uav1\"", "none"}},
    {"UnknownSensor",
     {"\n[sut]", "\n[uav.sensors.sonar]\ntiming = \"on_demand\"\n[sut]"},
     "sonar",
     {"range"}},
    {"UnknownAnchor", {"[\"blue_box\"]", "[\"red_box\"]"}, "", {"red_box"}},
    {"UnknownCondition", {}, "", {"moon", "host", "slow"}, {"--condition", "moon"}},
    {"UnknownSimulator", {}, "", {"gazeebo", "mujoco"}, {"--simulator", "gazeebo"}},
    {"AntialiasingInGazebo",
     {"\n[sut]", "\n[uav.sensors.camera]\nantialias = true\n[sut]"},
     "antialias",
     {"'camera'", "antialias = false"},
     {"--simulator", "gazebo"}},
    {"AntialiasingInAnExternalSimulator",
     {"\n[sut]", "\n[uav.sensors.camera]\nantialias = true\n[sut]"},
     "antialias",
     {"'camera'", "antialias = false"},
     {"--simulator", "tcp://127.0.0.1:1"}},
    {"NoAddress", {}, "", {"--listen", "here"}, {"--listen", "here"}},
    {"TunnelWithoutABoard", {}, "", {"--tunnel"}, {"--tunnel"}},
    {"ImpossibleSize",
     {"<size>20 20 0.1</size>", "<size>20 -20 0.1</size>"},
     "20 -20",
     {},
     {"--strict"},
     true},
    {"NoXml", {"</light>", "</ligt>"}, "<light name", {}, {}, true},
    {"DamagedMesh",
     {"<box><size>20 20 0.1</size></box>", "<mesh><uri>bad.obj</uri></mesh>"},
     "bad.obj",
     {"bad.obj: has no triangle"},
     {"--strict"},
     true},
    {"DamagedTexture",
     {"<collision name=\"box\">",
      "<visual name=\"v\"><geometry><sphere><radius>1</radius></sphere></geometry><material><pbr>"
      "<metal><albedo_map>bad.png</albedo_map></metal></pbr></material></visual>"
      "<collision name=\"box\">"},
     "bad.png",
     {"bad.png: cannot be read as PNG"},
     {"--strict"},
     true},
};

class Input : public testing::TestWithParam<WrongInput> {};

TEST_P(Input, ThatIsWrongIsRefusedWithItsLine) {
  const auto& [what, change, at, named, options, in_world] = GetParam();
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good");
  const auto world = folder / "world.sdf";
  write_text(world, read_text(hover_world()));
  write_text(scenario, substituted(read_text(scenario), {{hover_world(), world}}));
  write_text(folder / "bad.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  write_text(folder / "bad.png", "no picture");
  const auto changed = in_world ? world : scenario;
  write_text(changed, substituted(read_text(changed), {change}));
  const Output output = run(with(tether({"run", scenario, "--out", folder / "out"}), options));
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_EQ(output.out, "");
  EXPECT_THAT(output.err, StartsWith("tether: "));
  EXPECT_EQ(std::ranges::count(output.err, '\n'), 1) << output.err;
  if (!at.empty()) {
    EXPECT_THAT(output.err, HasSubstr(changed.string() + ":" +
                                      std::to_string(line_of(read_text(changed), at)) + ":"));
  }
  for (const std::string& part : named) EXPECT_THAT(output.err, HasSubstr(part));
  EXPECT_FALSE(std::filesystem::exists(folder / "out")) << "half-written";
}

INSTANTIATE_TEST_SUITE_P(Wrong, Input, testing::ValuesIn(kWrongInputs),
                         [](const auto& wrong) { return wrong.param.what; });

TEST(File, ThatIsNoneIsRefusedByEachCommand) {
  const TempFolder folder;
  write_text(folder / "record.mcap", "no MCAP at all");
  write_text(folder / "campaign.toml", "name = \"small\"\ntrails = 2\n");
  for (const auto& [command, file] : {std::pair{"run", folder / "nothing.toml"},
                                      {"run", folder.path()},
                                      {"audit", folder / "record.mcap"},
                                      {"campaign", folder / "campaign.toml"}}) {
    Command wrong = tether({command, file});
    wrong.working_folder = folder.path();
    const Output output = run(wrong);
    EXPECT_EQ(output.code, 2) << command;
    EXPECT_THAT(output.err, StartsWith("tether: " + file.string())) << command;
    EXPECT_FALSE(std::filesystem::exists(folder / "out")) << command;
  }
}

}  // namespace
}  // namespace tether::system_test
