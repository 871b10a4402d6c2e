#include "support/bench.h"
#include "support/profile_file.h"
#include "support/trials.h"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// tether-sut on real input: a video of the project's own renderer in place of a camera, and a
/// folder laid out like the kernel's IIO tree in place of a rangefinder.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const std::filesystem::path kSources = TETHER_SOURCE_DIR;

Output sut(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), sut_program());
  return run({.arguments = std::move(arguments), .environment = {}, .working_folder = {}}, 60s);
}

/// The last line that the program printed.
nlohmann::json details(const Output& output) {
  const std::string text = output.out.substr(0, output.out.find_last_not_of('\n') + 1);
  return nlohmann::json::parse(text.substr(text.rfind('\n') + 1));
}

class RealSensors : public testing::Test {
 protected:
  Output relative_position(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{
        "relative_position", "--anchor",  "blue_box", "--rig", kSources / "data/rigs/bench.toml",
        "--camera",          bench_.video};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return sut(arguments);
  }

  TempFolder folder_;
  Bench bench_ = make_bench(folder_.path(), 75);
};

TEST_F(RealSensors, GiveTableIIsRow) {
  const Output output = relative_position({"--range", bench_.range, "--true-roi-px",
                                           "294,214,53,53", "--keep-image", folder_ / "seen.png"});
  ASSERT_EQ(output.code, 0) << output.err;
  const auto results = details(output)["results"];
  EXPECT_NEAR(results["distance_m"], bench_.distance_m, 0.1);
  EXPECT_NEAR(results["distance_reference_m"], bench_.distance_m, 0.02);
  EXPECT_LT(results["distance_error_m"].get<double>(), 0.1);
  EXPECT_LT(results["angle_error_deg"].get<double>(), 0.5);
  EXPECT_THAT(output.out, HasSubstr("0.285"));  // the paper's own row
  EXPECT_EQ(read_text(folder_ / "seen.png").substr(1, 3), "PNG");
}

// Without a reference the row has a gap, not a number.
TEST_F(RealSensors, LeaveOutWhatNothingWasComparedWith) {
  const Output output = relative_position({});
  ASSERT_EQ(output.code, 0) << output.err;
  const auto results = details(output)["results"];
  EXPECT_FALSE(results.contains("distance_error_m"));
  EXPECT_FALSE(results.contains("angle_error_deg"));
}

TEST_F(RealSensors, AreCharacterizedIntoAProfileThatPlugsIn) {
  const auto profile = folder_ / "bench.toml";
  const Output output =
      sut({"characterize", "--camera", bench_.video, "--range", bench_.range, "--acquisitions",
           "15", "--experiments", "2", "--timing", "on_demand", "--out", profile});
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.out, HasSubstr("0.0977"));
  const auto camera_ms = samples_ms(profile, "camera");
  ASSERT_EQ(camera_ms.size(), 30u);
  EXPECT_EQ(samples_ms(profile, "range").size(), 30u);

  const auto out = folder_ / "out";
  const Output flown = run(tether({"run", kSources / "data/scenarios/relative_position.toml",
                                   "--quiet", "--profile", profile, "--out", out}),
                           60s);
  EXPECT_EQ(flown.code, 0) << flown.err;
  EXPECT_EQ(read_result(out)["profiles"].back(), profile_name(profile));
  for (const auto& logged : read_record(out).interactions) {
    if (logged.message.sensor != "camera") continue;
    const double taken_ms = 1e3 * to_seconds(logged.message.reply_at - logged.message.request_at);
    EXPECT_TRUE(std::any_of(camera_ms.begin(), camera_ms.end(), [&](double sample_ms) {
      return std::abs(sample_ms - taken_ms) < 1e-6;
    })) << taken_ms;
  }
}

// A video plays like a live camera: an image is there when it is due, and not before. A rangefinder
// measures when asked. Both go into one profile.
TEST_F(RealSensors, GetTheTimingThatTheyHave) {
  const auto profile = folder_ / "board.toml";
  const Output output = sut({"characterize", "--camera", bench_.video, "--range", bench_.range,
                             "--acquisitions", "30", "--out", profile});
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_GT(output.wall.count(), 29 / 30.0);
  const std::string text = read_text(profile);
  EXPECT_THAT(text, HasSubstr("period_ms = 33.333"));
  EXPECT_THAT(text, HasSubstr("timing = \"on_demand\""));
}

TEST_F(RealSensors, AnInterruptLeavesNoProfile) {
  const auto profile = folder_ / "half.toml";
  Process process({.arguments = {sut_program(), "characterize", "--camera", bench_.video,
                                 "--acquisitions", "70", "--out", profile},
                   .environment = {},
                   .working_folder = {}});
  std::this_thread::sleep_for(1s);  // of the video's 2.5
  process.signal(SIGINT);
  const Output output = process.wait(10s);
  EXPECT_EQ(output.code, 1) << output.err;
  EXPECT_FALSE(std::filesystem::exists(profile));
}

TEST_F(RealSensors, ACameraThatStopsLeavesNoProfile) {
  const auto profile = folder_ / "half.toml";
  const Output output =
      sut({"characterize", "--camera", bench_.video, "--acquisitions", "1000", "--out", profile});
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr(bench_.video.string()));
  EXPECT_THAT(output.err, HasSubstr("75"));
  EXPECT_FALSE(std::filesystem::exists(profile));
}

TEST_F(RealSensors, ARangefinderThatSpeaksNonsenseIsNamed) {
  write_text(bench_.range / "in_distance_raw", "far\n");
  const auto profile = folder_ / "half.toml";
  const Output output = sut({"characterize", "--range", bench_.range, "--out", profile});
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr((bench_.range / "in_distance_raw").string()));
  EXPECT_FALSE(std::filesystem::exists(profile));
}

struct Missing {
  const char* name;
  std::vector<std::string> device;
};

class MissingDevice : public testing::TestWithParam<Missing> {};

TEST_P(MissingDevice, IsNamedInOneLine) {
  const TempFolder folder;
  std::vector<std::string> arguments{"characterize", "--out", folder / "profile.toml"};
  const auto& device = GetParam().device;
  arguments.insert(arguments.end(), device.begin(), device.end());
  const Output output = sut(arguments);
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr(device.back()));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "profile.toml"));
}

INSTANTIATE_TEST_SUITE_P(Devices, MissingDevice,
                         testing::Values(Missing{"Camera", {"--camera", "/dev/video97"}},
                                         Missing{"Video", {"--camera", "/nowhere/clip.avi"}},
                                         Missing{"NoCamera", {"--camera", "/dev/null"}},
                                         Missing{"Range",
                                                 {"--range", "/sys/bus/iio/devices/iio:device97"}},
                                         Missing{"Imu", {"--imu", "iio:no_such_driver"}}),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace tether::system_test
