#include <filesystem>
#include <utility>

#include <gmock/gmock.h>

#include <tether/base/units.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/rig/mission_file.h>

namespace tether::rig {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

Mission parsed(const std::string& text) {
  const Result<Mission> mission = parse_mission(text, "m.toml");
  EXPECT_TRUE(mission) << mission.failure().message;
  return mission ? *mission : Mission{};
}

TEST(MissionFile, EachTaskHasItsOptionsAndTheCommonOnes) {
  const Mission mission = parsed(R"(
anchor = "blue_box"
camera = "eye"
tolerance_px = 3.5

[vision]
prefilter = "median"
prefilter_size_px = 7

[[task]]
task = "sensor_characterization"
sensor = "range"
acquisitions = 5

[[task]]
task = "face_anchor"
required = false
precision_deg = 2
search_clockwise = true
prefilter = "none"

[[task]]
task = "closed_path"
anchor = "red_box"
distance_m = 1.5
)");
  EXPECT_TRUE(mission.is_sequence);
  ASSERT_EQ(mission.tasks.size(), 3u);
  const TaskSpec& first = mission.tasks[0];
  EXPECT_EQ(first.sensor, "range");
  EXPECT_EQ(std::get<tasks::SensorCharacterizationOptions>(first.options).acquisitions, 5);
  EXPECT_TRUE(first.required);

  const TaskSpec& second = mission.tasks[1];
  const auto& face = std::get<tasks::FaceAnchorOptions>(second.options);
  EXPECT_FALSE(second.required);
  EXPECT_EQ(second.anchor, "blue_box");
  EXPECT_EQ(second.vision.camera, "eye");
  EXPECT_EQ(second.vision.tracker.prefilter, vision::Prefilter::kNone);
  EXPECT_EQ(second.vision.tracker.prefilter_size_px, 7);
  EXPECT_DOUBLE_EQ(face.precision_rad, rad_from_deg(2));
  EXPECT_EQ(face.convergence.tolerance_px, 3.5);
  EXPECT_TRUE(face.search_clockwise);

  const TaskSpec& third = mission.tasks[2];
  EXPECT_EQ(third.anchor, "red_box") << "a task's own word counts for more";
  EXPECT_EQ(third.vision.tracker.prefilter, vision::Prefilter::kMedian);
  EXPECT_EQ(std::get<tasks::ClosedPathOptions>(third.options).distance_m, 1.5);
}

TEST(MissionFile, VisionCountsForMoreThanTheTop) {
  const Mission mission = parsed(
      "camera = \"a\"\n[vision]\ncamera = \"b\"\n"
      "[[task]]\ntask = \"relative_position\"\nanchor = \"x\"\n");
  EXPECT_EQ(mission.tasks.at(0).vision.camera, "b");
}

struct Mistake {
  const char* text;
  int line;
  const char* says;
};

TEST(MissionFile, MistakesNameFileAndLine) {
  const std::vector<Mistake> mistakes = {
      {"", 1, "[[task]]"},
      {"[task]\ntask = \"face_anchor\"\n", 1, "[[task]]"},
      {"task = []\n", 1, "[[task]]"},
      {"\n[[task]\n", 2, "no valid TOML"},
      {"[[task]]\nanchor = \"b\"\n", 1, "[task] lacks the key 'task'"},
      {"[[task]]\ntask = 3\n", 2, "'task' of [task] must be a string"},
      {"[[task]]\ntask = \"land\"\n", 2,
       "'task' of [task] is \"land\"; Allowed: 'sensor_characterization', "},
      {"\n\n[[task]]\ntask = \"face_anchor\"\n", 3, "[task] lacks the key 'anchor'"},
      {"height_m = 3\n[[task]]\ntask = \"face_anchor\"\nanchor = \"b\"\n", 1,
       "unknown key 'height_m' in the file"},
      {"[vision]\nspeed_m_s = 1\n[[task]]\ntask = \"face_anchor\"\n", 2,
       "unknown key 'speed_m_s' in [vision]"},
      {"vision = 1\n[[task]]\ntask = \"face_anchor\"\n", 1, "'vision' of the file must be a table"},
      {"precision_deg = 0\n[[task]]\ntask = \"face_anchor\"\nanchor = \"b\"\n", 1,
       "'precision_deg' of the file must be at least 0.001 and at most 90, but is 0"},
  };
  for (const Mistake& mistake : mistakes) {
    const Result<Mission> mission = parse_mission(mistake.text, "m.toml");
    ASSERT_FALSE(mission) << mistake.text;
    EXPECT_EQ(mission.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(mission.failure().message,
                StartsWith("m.toml:" + std::to_string(mistake.line) + ": "));
    EXPECT_THAT(mission.failure().message, HasSubstr(mistake.says));
    EXPECT_THAT(mission.failure().message, ::testing::Not(HasSubstr("\n")));
  }
}

TEST(MissionFile, WrongValuesNameTheirOwnLine) {
  const std::string start = "[[task]]\ntask = \"face_anchor\"\nanchor = \"b\"\n";
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"precision_deg = 0", "'precision_deg' of [task] must be at least 0.001"},
      {"precision_deg = nan", "and at most 90, but is nan"},
      {"yaw_rate_deg_s = \"fast\"", "'yaw_rate_deg_s' of [task] must be a number"},
      {"min_value = [1, 2]", "'min_value' of [task] must be a number"},
      {"speed_m_s = 1", "unknown key 'speed_m_s' in [task]"},
      {"precision-deg = 1", "unknown key 'precision-deg' in [task]; did you mean 'precision_deg'?"},
      {"help = true", "unknown key 'help'"},
      {"prefilter = \"sharpen\"", "Allowed: 'none', 'gaussian' and 'median'"},
      {"prefilter_size_px = 4", "'prefilter_size_px' of [task] must be odd"},
      {"required = \"no\"", "'required' of [task] must be true or false"},
      {"stable_frames = 1.5", "'stable_frames' of [task] must be an integer"},
  };
  for (const auto& [line, says] : wrong) {
    const Result<Mission> mission = parse_mission(start + "slowdown = 0.5\n" + line, "m.toml");
    ASSERT_FALSE(mission) << line;
    EXPECT_THAT(mission.failure().message, StartsWith("m.toml:5: "));
    EXPECT_THAT(mission.failure().message, HasSubstr(says));
  }
}

TEST(MissionFile, WhatCannotBeReadIsNamed) {
  const ScratchFolder folder;
  EXPECT_EQ(load_mission("/nowhere/m.toml").failure().message,
            "/nowhere/m.toml: there is no such file");
  const std::string path = folder.path().string();
  EXPECT_EQ(load_mission(path).failure().message, path + ": that is no regular file");
}

TEST(MissionFile, TheProjectsMissionsAreGood) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(TETHER_SOURCE_DIR "/data/missions")) {
    const Result<Mission> mission = load_mission(entry.path().string());
    EXPECT_TRUE(mission) << mission.failure().message;
    ++files;
  }
  EXPECT_GE(files, 1);
}

}  // namespace
}  // namespace tether::rig
