#include <filesystem>
#include <utility>

#include <gmock/gmock.h>

#include <tether/base/units.h>
#include <tether/rig/mission.h>

namespace tether::rig {
namespace {

using ::testing::AllOf;
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

TEST(MissionFile, TasksHaveAnOrder) {
  const Mission mission = parsed(R"(
anchor = "blue_box"
[[task]]
task = "face_anchor"
name = "aim"
retry = 2
within_s = 5
on_miss = "look"
[[task]]
task = "face_anchor"
within_s = 6
[[task]]
task = "relative_position"
name = "look"
[[clause]]
eventually = "bearing_error <= 2 deg"
)");
  ASSERT_EQ(mission.tasks.size(), 3u);
  const TaskSpec& first = mission.tasks[0];
  EXPECT_EQ(first.name, "aim");
  EXPECT_EQ(first.retry, 2);
  EXPECT_EQ(first.otherwise, 2u);
  EXPECT_EQ(first.within, Duration(std::chrono::seconds(5)));
  EXPECT_FALSE(mission.tasks[1].within) << "the host's alone";
  EXPECT_TRUE(mission.tasks[1].required);
}

TEST(MissionFile, VisionTableCountsForMoreThanTheTop) {
  const Mission mission = parsed(
      "camera = \"a\"\n[vision]\ncamera = \"b\"\n"
      "[[task]]\ntask = \"relative_position\"\nanchor = \"x\"\n");
  EXPECT_EQ(mission.tasks.at(0).vision.camera, "b");
}

TEST(MissionFile, RefusalNamesLineAndKey) {
  struct Case {
    std::string text;
    int line;
    const char* key;
  };
  const std::string face = "[[task]]\ntask = \"face_anchor\"\nanchor = \"b\"\n";
  for (const Case& c :
       std::vector<Case>{{"", 1, "[[task]]"},
                         {"[task]\ntask = \"face_anchor\"\n", 1, "[[task]]"},
                         {"task = []\n", 1, "[[task]]"},
                         {"\n[[task]\n", 2, ""},
                         {"[[task]]\nanchor = \"b\"\n", 1, "'task'"},
                         {"[[task]]\ntask = \"fly\"\n", 2, "\"fly\""},
                         {"\n\n[[task]]\ntask = \"face_anchor\"\n", 3, "'anchor'"},
                         {"height_m = 3\n" + face, 1, "'height_m'"},
                         {"[vision]\nspeed_m_s = 1\n" + face, 2, "'speed_m_s'"},
                         {"vision = 1\n" + face, 1, "'vision'"},
                         {"precision_deg = 0\n" + face, 1, "'precision_deg'"},
                         {face + "precision_deg = nan", 4, "'precision_deg'"},
                         {face + "yaw_rate_deg_s = \"fast\"", 4, "'yaw_rate_deg_s'"},
                         {face + "speed_m_s = 1", 4, "'speed_m_s'"},
                         {face + "precision-deg = 1", 4, "'precision_deg'"},
                         {face + "prefilter = \"sharpen\"", 4, "'prefilter'"},
                         {face + "prefilter_size_px = 4", 4, "'prefilter_size_px'"},
                         {face + "required = \"no\"", 4, "'required'"},
                         {face + "stable_frames = 1.5", 4, "'stable_frames'"}}) {
    const Result<Mission> mission = parse_mission(c.text, "m.toml");
    ASSERT_FALSE(mission) << c.text;
    EXPECT_EQ(mission.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(mission.failure().message,
                AllOf(StartsWith("m.toml:" + std::to_string(c.line) + ": "), HasSubstr(c.key)));
  }
  for (const std::string path : {"/nowhere/m.toml", "/"}) {
    EXPECT_THAT(load_mission(path).failure().message, StartsWith(path));
  }
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
