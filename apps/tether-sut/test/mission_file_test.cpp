#include "mission_file.h"

#include <filesystem>
#include <utility>

#include <gmock/gmock.h>

#include <tether/base/units.h>
#include <tether/base_testing/scratch_folder.h>

namespace tether::sut {
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
      {"[[task]]\nanchor = \"b\"\n", 1, "needs task"},
      {"[[task]]\ntask = 3\n", 2, "needs task"},
      {"[[task]]\ntask = \"land\"\n", 2, "there is no task \"land\""},
      {"\n\n[[task]]\ntask = \"face_anchor\"\n", 3, "anchor is required"},
      {"height_m = 3\n[[task]]\ntask = \"face_anchor\"\nanchor = \"b\"\n", 1, "'height_m'"},
      {"[vision]\nspeed_m_s = 1\n[[task]]\ntask = \"face_anchor\"\n", 2, "[vision]"},
      {"vision = 1\n[[task]]\ntask = \"face_anchor\"\n", 1, "[vision]"},
      {"precision_deg = 0\n[[task]]\ntask = \"face_anchor\"\nanchor = \"b\"\n", 1, "precision_deg"},
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
      {"precision_deg = 0", "precision_deg"},
      {"precision_deg = nan", "precision_deg"},
      {"yaw_rate_deg_s = \"fast\"", "yaw_rate_deg_s"},
      {"min_value = [1, 2]", "min_value must be"},
      {"speed_m_s = 1", "face_anchor has no parameter 'speed_m_s'"},
      {"precision-deg = 1", "no parameter 'precision-deg'"},
      {"help = true", "no parameter 'help'"},
      {"prefilter = \"sharpen\"", "prefilter"},
      {"required = \"no\"", "required must be"},
      {"stable_frames = 1.5", "stable_frames"},
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
  for (const std::string& path : {std::string("/nowhere/m.toml"), folder.path().string()}) {
    const Result<Mission> mission = load_mission(path);
    ASSERT_FALSE(mission);
    EXPECT_THAT(mission.failure().message, StartsWith(path + ": cannot be read"));
  }
}

TEST(MissionFile, TheProjectsMissionsAreGood) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TETHER_SOURCE_DIR "/missions")) {
    const Result<Mission> mission = load_mission(entry.path().string());
    EXPECT_TRUE(mission) << mission.failure().message;
    ++files;
  }
  EXPECT_GE(files, 1);
}

}  // namespace
}  // namespace tether::sut
