#include "command_line.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base/units.h>

namespace tether::sut {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

const std::string kRig = TETHER_SOURCE_DIR "/data/rigs/bench.toml";
const std::string kMission = TETHER_SOURCE_DIR "/data/missions/look_around.toml";

/// `arguments` are separated by blanks; '' is an empty one.
std::variant<CommandLine, Refusal> parse(const std::string& arguments) {
  std::istringstream text("tether-sut " + arguments);
  std::vector<std::string> words{std::istream_iterator<std::string>(text), {}};
  std::replace(words.begin(), words.end(), std::string("''"), std::string());
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  return parse_command_line(static_cast<int>(argv.size()), argv.data());
}

CommandLine parsed(const std::string& arguments) {
  auto result = parse(arguments);
  EXPECT_TRUE(std::holds_alternative<CommandLine>(result)) << std::get<Refusal>(result).text;
  return std::get<CommandLine>(result);
}

/// A refusal has exit code 2 and is one line.
std::string refused(const std::string& arguments) {
  const auto result = parse(arguments);
  if (!std::holds_alternative<Refusal>(result)) {
    ADD_FAILURE() << "accepted: " << arguments;
    return "";
  }
  const Refusal& refusal = std::get<Refusal>(result);
  EXPECT_EQ(refusal.exit_code, 2) << arguments;
  EXPECT_EQ(std::count(refusal.text.begin(), refusal.text.end(), '\n'), 1) << refusal.text;
  return refusal.text;
}

const rig::TaskSpec& only(const CommandLine& line) {
  EXPECT_FALSE(line.mission.is_sequence);
  return line.mission.tasks.at(0);
}

TEST(CommandLine, FaceAnchorHasTheDefaultsOfTheTask) {
  const CommandLine line = parsed("face_anchor --anchor blue_box");
  EXPECT_EQ(only(line).anchor, "blue_box");
  EXPECT_EQ(only(line).vision.camera, "camera");
  EXPECT_FALSE(line.address || line.uav || line.clock);
  const auto& options = std::get<tasks::FaceAnchorOptions>(only(line).options);
  const tasks::FaceAnchorOptions defaults;
  EXPECT_DOUBLE_EQ(options.precision_rad, defaults.precision_rad);
  EXPECT_DOUBLE_EQ(options.yaw_rate_rad_s, defaults.yaw_rate_rad_s);
  EXPECT_DOUBLE_EQ(options.min_yaw_rate_rad_s, defaults.min_yaw_rate_rad_s);
  EXPECT_EQ(options.time_limit, defaults.time_limit);
  EXPECT_EQ(options.lost_limit, defaults.lost_limit);
}

TEST(CommandLine, FaceAnchorTakesEveryOption) {
  const CommandLine line = parsed(
      "face_anchor --anchor b --precision-deg 2 --yaw-rate-deg-s 40 --slowdown 0.6 "
      "--min-yaw-rate-deg-s 3 --search-clockwise true --lost-limit-s 5 --time-limit-s 12.5 "
      "--tolerance-px 4 --stable-frames 3 --max-frames 9 --max-unseen-frames 2 --prefilter median "
      "--prefilter-size-px 7 --hue-tolerance-deg 9 --min-saturation 0.4 --min-value 0.2 "
      "--min-score 0.5 --camera eye --address h:1 --uav u --clock cpu*3");
  const auto& options = std::get<tasks::FaceAnchorOptions>(only(line).options);
  EXPECT_DOUBLE_EQ(options.precision_rad, rad_from_deg(2));
  EXPECT_DOUBLE_EQ(options.yaw_rate_rad_s, rad_from_deg(40));
  EXPECT_DOUBLE_EQ(options.min_yaw_rate_rad_s, rad_from_deg(3));
  EXPECT_EQ(options.slowdown, 0.6);
  EXPECT_TRUE(options.search_clockwise);
  EXPECT_EQ(options.lost_limit, seconds(5));
  EXPECT_EQ(options.time_limit, milliseconds(12'500));
  EXPECT_EQ(options.convergence.tolerance_px, 4);
  EXPECT_EQ(options.convergence.stable_frames, 3);
  EXPECT_EQ(options.convergence.max_frames, 9);
  EXPECT_EQ(options.convergence.max_unseen_frames, 2);
  const vision::TrackerOptions& tracker = only(line).vision.tracker;
  EXPECT_EQ(tracker.prefilter, vision::Prefilter::kMedian);
  EXPECT_EQ(tracker.prefilter_size_px, 7);
  EXPECT_EQ(tracker.hue_tolerance_deg, 9);
  EXPECT_EQ(tracker.min_saturation, 0.4);
  EXPECT_EQ(tracker.min_value, 0.2);
  EXPECT_EQ(tracker.min_score, 0.5);
  EXPECT_EQ(only(line).vision.camera, "eye");
  EXPECT_EQ(line.address, "h:1");
  EXPECT_EQ(line.uav, "u");
  EXPECT_EQ(line.clock, "cpu*3");
}

TEST(CommandLine, TasksWithoutAPathTakeTheirOptions) {
  const CommandLine position =
      parsed("relative_position --anchor b --stable-frames 4 --time-limit-s 9");
  const auto& relative = std::get<tasks::RelativePositionOptions>(only(position).options);
  EXPECT_EQ(relative.convergence.stable_frames, 4);
  EXPECT_EQ(relative.time_limit, seconds(9));

  const CommandLine sensor =
      parsed("sensor_characterization --sensor imu --acquisitions 7 --time-limit-s 3");
  const auto& timed = std::get<tasks::SensorCharacterizationOptions>(only(sensor).options);
  EXPECT_EQ(only(sensor).sensor, "imu");
  EXPECT_EQ(timed.acquisitions, 7);
  EXPECT_EQ(timed.time_limit, seconds(3));
}

TEST(CommandLine, MoveForwardTakesItsOptions) {
  const CommandLine line = parsed(
      "move_forward --anchor b --speed-m-s 0.4 --precision-deg 4 --face-precision-deg 2 "
      "--face-time-limit-s 11 --imu gyro --settle-s 0 --time-limit-s 90 --yaw-rate-deg-s 30 "
      "--stable-frames 3");
  const auto& options = std::get<tasks::MoveForwardOptions>(only(line).options);
  EXPECT_EQ(options.speed_m_s, 0.4);
  EXPECT_DOUBLE_EQ(options.precision_rad, rad_from_deg(4));
  EXPECT_DOUBLE_EQ(options.face.precision_rad, rad_from_deg(2));
  EXPECT_DOUBLE_EQ(options.face.yaw_rate_rad_s, rad_from_deg(30));
  EXPECT_EQ(options.face.time_limit, seconds(11));
  EXPECT_EQ(options.face.convergence.stable_frames, 3);
  EXPECT_EQ(options.face.imu, "gyro");
  EXPECT_EQ(options.settle_time, Duration(0));
  EXPECT_EQ(options.time_limit, seconds(90));
}

TEST(CommandLine, ClosedPathTakesItsOptions) {
  const CommandLine line = parsed(
      "closed_path --anchor b --distance-m 1.5 --speed-m-s 0.4 --imu gyro --rest-s 0.25 "
      "--turn-rate-deg-s 10 --turn-tolerance-deg 2 --settle-s 2.5 --turn-limit-s 7 --leg-slack-s 3 "
      "--time-limit-s 99 --tolerance-px 5");
  const auto& options = std::get<tasks::ClosedPathOptions>(only(line).options);
  EXPECT_EQ(options.distance_m, 1.5);
  EXPECT_EQ(options.speed_m_s, 0.4);
  EXPECT_EQ(options.imu, "gyro");
  EXPECT_EQ(options.rest_time, milliseconds(250));
  EXPECT_DOUBLE_EQ(options.turn_rate_rad_s, rad_from_deg(10));
  EXPECT_DOUBLE_EQ(options.turn_tolerance_rad, rad_from_deg(2));
  EXPECT_EQ(options.settle_time, milliseconds(2500));
  EXPECT_EQ(options.turn_limit, seconds(7));
  EXPECT_EQ(options.leg_slack, seconds(3));
  EXPECT_EQ(options.time_limit, seconds(99));
  EXPECT_EQ(options.convergence.tolerance_px, 5);
}

TEST(CommandLine, MissionTakesItsFileByPositionOrOption) {
  for (const std::string& arguments :
       {"mission " + kMission, "mission --file " + kMission + " --uav u"}) {
    const CommandLine line = parsed(arguments);
    EXPECT_TRUE(line.mission.is_sequence);
    EXPECT_EQ(line.mission.tasks.size(), 3u);
  }
  EXPECT_THAT(refused("mission /nowhere/m.toml"), HasSubstr("/nowhere/m.toml"));
}

TEST(CommandLine, DevicesReplaceTheCoordinator) {
  const CommandLine line =
      parsed("relative_position --anchor blue_box --rig " + kRig +
             " --camera /dev/video0 --true-roi-px 10,20,30,40 --keep-image i.png");
  ASSERT_TRUE(line.rig);
  ASSERT_EQ(line.rig->sensors.size(), 1u) << "no rangefinder was given";
  EXPECT_EQ(line.rig->sensors[0].device, "/dev/video0");
  EXPECT_EQ(line.rig->uav, "bench");
  EXPECT_EQ(only(line).vision.camera, "camera");
  ASSERT_TRUE(line.real_row.true_roi);
  EXPECT_EQ(line.real_row.true_roi->left_px, 10);
  EXPECT_EQ(line.real_row.true_roi->top_px, 20);
  EXPECT_EQ(line.real_row.true_roi->width_px, 30);
  EXPECT_EQ(line.real_row.true_roi->height_px, 40);
  EXPECT_EQ(line.real_row.keep_image, "i.png");
  EXPECT_FALSE(parsed("relative_position --anchor b --camera eye").rig);
}

TEST(CommandLine, EveryCommandTakesDevices) {
  for (const std::string& command :
       {std::string("sensor_characterization --sensor camera"),
        std::string("relative_position --anchor b"), std::string("face_anchor --anchor b"),
        std::string("move_forward --anchor b"), std::string("closed_path --anchor b"),
        "mission " + kMission, std::string("characterize")}) {
    const CommandLine line = parsed(command + " --rig " + kRig + " --camera 0 --range iio:vl53l0x");
    ASSERT_TRUE(line.rig) << command;
    EXPECT_EQ(line.rig->sensors.size(), 2u);
  }
}

TEST(CommandLine, Characterize) {
  const CommandLine line = parsed(
      "characterize --sensors camera,range --acquisitions 50 --experiments 10 --timing periodic "
      "--name pi --out p.toml --time-limit-s 30 --uav u");
  ASSERT_TRUE(line.characterize);
  EXPECT_THAT(line.characterize->sensors, ::testing::ElementsAre("camera", "range"));
  EXPECT_EQ(line.characterize->acquisitions, 50);
  EXPECT_EQ(line.characterize->experiments, 10);
  EXPECT_EQ(line.characterize->timing, calibration::Timing::kPeriodic);
  EXPECT_EQ(line.characterize->name, "pi");
  EXPECT_EQ(line.characterize->out, "p.toml");
  EXPECT_EQ(line.characterize->time_limit, seconds(30));
  EXPECT_EQ(line.uav, "u");
  EXPECT_FALSE(line.rig);
  const CommandLine plain = parsed("characterize");
  EXPECT_TRUE(plain.characterize->sensors.empty());
  EXPECT_EQ(plain.characterize->acquisitions, 100);
  EXPECT_EQ(plain.characterize->experiments, 1);
  EXPECT_EQ(plain.characterize->timing, calibration::Timing::kAuto);
}

TEST(CommandLine, Calibrate) {
  const CommandLine line =
      parsed("calibrate --against b.toml --write-target t.toml --rounds 40 --name pi");
  ASSERT_TRUE(line.calibrate);
  EXPECT_EQ(line.calibrate->against, "b.toml");
  EXPECT_EQ(line.calibrate->target, "t.toml");
  EXPECT_EQ(line.calibrate->rounds, 40);
  EXPECT_EQ(line.calibrate->name, "pi");
}

TEST(CommandLine, RejectsOptionsThatCannotBeCombined) {
  const std::pair<const char*, const char*> cases[] = {
      {"characterize --camera 0 --address h:1", "--address"},
      {"characterize --camera 0 --clock cpu", "--clock"},
      {"characterize --acquisitions 20000 --experiments 4", "60000"},
      {"characterize --rig /nowhere/r.toml", "/nowhere/r.toml"},
      {"face_anchor --anchor b --camera 0", "--rig"},
      {"relative_position --anchor b --keep-image i.png", "--keep-image"},
      {"relative_position --anchor b --true-roi-px 1,2,3,4", "--true-roi-px"}};
  for (const auto& [arguments, option] : cases) EXPECT_THAT(refused(arguments), HasSubstr(option));
}

TEST(CommandLine, RejectsAnAnchorThatTheWorldLacks) {
  const std::string line = "face_anchor --anchor blue_bx --check --anchors blue_box --anchors red";
  EXPECT_THAT(refused(line), HasSubstr("the scenario has no anchor \"blue_bx\"; did you mean "
                                       "'blue_box'?"));
  EXPECT_TRUE(
      parsed("face_anchor --anchor red --check --anchors blue_box --anchors red").only_checks);
  EXPECT_TRUE(parsed("face_anchor --anchor red --check").only_checks) << "not known";
}

TEST(CommandLine, RejectsMissingUnknownAndInvalidArguments) {
  for (const char* arguments : {"",
                                "take_off",
                                "face_anchor",
                                "face_anchor --anchor b --precision-deg 0",
                                "face_anchor --anchor b --precision-deg nan",
                                "face_anchor --anchor b --yaw-rate-deg-s fast",
                                "face_anchor --anchor b --token secret",
                                "relative_position --anchor b --precision-deg 1",
                                "sensor_characterization",
                                "move_forward --anchor b --prefilter-size-px 4",
                                "move_forward --anchor b --prefilter-size-px 33",
                                "mission",
                                "characterize --camera camera",
                                "characterize --range range",
                                "characterize --acquisitions 0",
                                "characterize --timing sometimes",
                                "characterize --name a/b",
                                "characterize --out ''",
                                "relative_position --anchor b --keep-image ''",
                                "face_anchor --anchor b --keep-image i.png",
                                "relative_position --anchor b --true-roi-px 1,2,3",
                                "relative_position --anchor b --true-roi-px 1,2,0,4",
                                "relative_position --anchor b --true-roi-px 1,2,nan,4",
                                "relative_position --anchor b --prefilter sharpen",
                                "face_anchor --anchor b relative_position"})
    EXPECT_THAT(refused(arguments), HasSubstr("--help")) << arguments;
}

TEST(CommandLine, SuggestsTheNearestCommandOrOption) {
  EXPECT_EQ(refused("face_anchr --anchor b"),
            "tether-sut: unknown command 'face_anchr'; did you mean 'face_anchor'? For help, type: "
            "tether-sut --help\n");
  EXPECT_EQ(refused("face_anchor --anchr=b"),
            "tether-sut: unknown option '--anchr'; did you mean '--anchor'? For help, type: "
            "tether-sut face_anchor --help\n");
  EXPECT_EQ(refused("calibrate --zzz"),
            "tether-sut: unexpected option '--zzz'. For help, type: tether-sut calibrate --help\n");
}

TEST(CommandLine, PrintsHelpAndVersion) {
  for (const char* arguments : {"--help", "face_anchor --help"}) {
    const auto help = std::get<Refusal>(parse(arguments));
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.text, HasSubstr("TETHER_TOKEN"));
  }
  EXPECT_THAT(std::get<Refusal>(parse("--version")).text, HasSubstr("tether-sut "));
}

}  // namespace
}  // namespace tether::sut
