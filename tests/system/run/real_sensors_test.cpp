#include "support/bench.h"
#include "support/profile_file.h"
#include "support/trials.h"

#include <algorithm>
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

Output sut(const std::vector<std::string>& arguments) {
  return run(with({{sut_program()}}, arguments));
}

/// The last line that the program printed.
nlohmann::json details(const Output& output) {
  const std::string text = output.out.substr(0, output.out.find_last_not_of('\n') + 1);
  return nlohmann::json::parse(text.substr(text.rfind('\n') + 1));
}

class RealSensors : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    bench_folder_ = std::make_unique<TempFolder>();
    bench_ = make_bench(bench_folder_->path(), 75);
  }
  static void TearDownTestSuite() { bench_folder_.reset(); }

  static inline std::unique_ptr<TempFolder> bench_folder_;
  static inline Bench bench_;
  TempFolder folder_;
};

TEST_F(RealSensors, GiveTableIIsRow) {
  const Output output =
      sut({"relative_position", "--anchor", "blue_box", "--rig", kSources / "data/rigs/bench.toml",
           "--camera", bench_.video, "--range", bench_.range, "--true-roi-px", "294,214,53,53",
           "--keep-image", folder_ / "seen.png"});
  ASSERT_EQ(output.code, 0) << output.err;
  const auto results = details(output)["results"];
  EXPECT_NEAR(results["distance_m"], bench_.distance_m, 0.1);
  EXPECT_NEAR(results["distance_reference_m"], bench_.distance_m, 0.02);
  EXPECT_LT(results["distance_error_m"].get<double>(), 0.1);
  EXPECT_LT(results["angle_error_deg"].get<double>(), 0.5);
  EXPECT_THAT(output.out, HasSubstr("0.285"));  // the paper's own row
  EXPECT_EQ(read_text(folder_ / "seen.png").substr(1, 3), "PNG");
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
                                   "--quiet", "--profile", profile, "--out", out}));
  EXPECT_LE(flown.code, 1) << flown.err;  // its time depends on this machine's
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
  Process process({{sut_program(), "characterize", "--camera", bench_.video, "--acquisitions", "70",
                    "--out", profile}});
  ASSERT_TRUE(wait_until([&] {  // it handles the signal
    const std::string status = read_text("/proc/" + std::to_string(process.pid()) + "/status");
    const auto at = status.find("SigCgt:\t");
    return at != std::string::npos && (std::stoull(status.substr(at + 8), nullptr, 16) & 2u) != 0;
  }));
  std::this_thread::sleep_for(500ms);  // of the video's 2.5 s
  process.signal(SIGINT);
  const Output output = process.wait(10s);
  EXPECT_EQ(output.code, 1) << output.err;
  EXPECT_FALSE(std::filesystem::exists(profile));
}

// Which device failed, and how: target/devices/test.
TEST_F(RealSensors, ThatFailLeaveNoProfileAndAreNamed) {
  write_range_folder(folder_ / "range", 1000);
  write_text(folder_ / "range/in_distance_raw", "far\n");
  const std::vector<std::string> devices[] = {
      {"--acquisitions", "1000", "--camera", bench_.video},  // of 75 images
      {"--range", folder_ / "range"},
      {"--camera", "/dev/video97"},
      {"--imu", "iio:no_such_driver"}};
  for (const auto& device : devices) {
    const auto profile = folder_ / "half.toml";
    const Output output = sut(with({{"characterize", "--out", profile}}, device).arguments);
    EXPECT_EQ(output.code, 3);
    EXPECT_THAT(output.err, HasSubstr(device.back()));
    EXPECT_EQ(std::ranges::count(output.err, '\n'), 1) << output.err;
    EXPECT_FALSE(std::filesystem::exists(profile));
  }
}

TEST_F(RealSensors, NeedTheVideoReaderBesideTheProgram) {
  const auto alone = folder_ / "tether-sut";
  std::filesystem::copy_file(sut_program(), alone);
  const Output output =
      run({{alone, "characterize", "--camera", bench_.video, "--out", folder_ / "camera.toml"}});
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("tether-video.so"));
}

}  // namespace
}  // namespace tether::system_test
