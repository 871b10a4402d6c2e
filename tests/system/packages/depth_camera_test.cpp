#include "support/gazebo.h"
#include "support/installed.h"
#include "support/trials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// examples/depth-camera as a user builds it, in C and in C++: flown by an RGBD and a segmentation
/// camera, and what the run leaves of them.
namespace tether::system_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class DepthCamera : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    install_client(*folder_ / "installed");
    fs::copy(folder_of(*folder_ / "installed", "approach.toml"), *folder_ / "example",
             fs::copy_options::recursive);
    const fs::path example = *folder_ / "example", build = example / "build";
    output_of({TETHER_CMAKE, "-S", example, "-B", build, "-DCMAKE_C_COMPILER=gcc",
               "-DCMAKE_CXX_COMPILER=g++",
               "-DCMAKE_PREFIX_PATH=" + (*folder_ / "installed").string()});
    output_of({TETHER_CMAKE, "--build", build});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path scenario(const std::vector<Substitution>& changes = {}) {
    const fs::path example = *folder_ / "example", file = example / "own.toml";
    write_text(file, substituted(read_text(example / "approach.toml"), changes));
    return file;
  }
  static fs::path flown(const std::string& program, const std::vector<std::string>& options = {}) {
    const fs::path out = *folder_ / program;
    std::vector<std::string> arguments{
        "run",      scenario({{"build/approach_c", "build/" + program}}),
        "--quiet",  "--condition",
        "scripted", "--out",
        out};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Output output = run(tether(arguments), std::chrono::seconds(100));
    EXPECT_EQ(output.code, 0) << output.err << read_text(out / "sut-uav1.log");
    return out;
  }

  /// Flown once.
  static const fs::path& flown_c() {
    static const fs::path out = flown("approach_c", {"--images"});
    return out;
  }

  static inline std::unique_ptr<TempFolder> folder_;
};

// The near side of the box is at x = 5.4 m; the cameras are 0.1 m ahead of the UAV.
double gap_m(const record::GroundTruth& truth) {
  return 5.4 - truth.p_WB_m[0] - 0.1;
}

TEST_F(DepthCamera, BothProgramsFlyAlike) {
  const fs::path& c = flown_c();
  const fs::path cpp = flown("approach_cpp", {"--images"});
  const auto in_c = read_result(c), in_cpp = read_result(cpp);
  EXPECT_TRUE(in_c["audit"]["passed"]) << in_c["audit"]["summary"];
  EXPECT_EQ(in_c["suts"][0]["outcome"], "is there");
  EXPECT_NEAR(in_c["suts"][0]["details"]["distance_m"].get<double>(), 1.5, 0.02);
  EXPECT_EQ(in_c["metrics"], in_cpp["metrics"]);

  const auto record = record::read_record(c / "record.mcap", {.images = true});
  std::map<std::uint64_t, const record::RawImage*> depths, labels;
  for (const auto& logged : record.raw_images) {
    const bool is_depth = logged.message.sensor == "rgbd";
    ASSERT_EQ(logged.message.pixels.index(), is_depth ? 0U : 1U);
    (is_depth ? depths : labels)[logged.message.index] = &logged.message;
  }
  EXPECT_EQ(record.images.size(), depths.size());  // the colours
  EXPECT_TRUE(std::ranges::equal(std::views::keys(depths), std::views::keys(labels)))
      << "each pair is of one instant";
  ASSERT_GT(depths.size(), 5U);
  for (const auto& logged : record.interactions) {
    const record::Interaction& read = logged.message;
    if (read.kind != record::kSensor) {
      EXPECT_FALSE(read.seen_anchors);
      continue;
    }
    // Nothing is in front of the box.
    ASSERT_TRUE(read.seen_anchors && read.seen_anchors->size() == 1);
    EXPECT_EQ(read.seen_anchors->front().anchor, "blue_box");
    if (read.sensor != "labels") continue;
    const auto& shown = std::get<1>(labels.at(read.sample_index)->pixels);
    const auto& models = record.header.sensors.at(1).camera->models;
    const auto label =
        1 + std::distance(models.begin(), std::find(models.begin(), models.end(), "blue_box"));
    EXPECT_EQ(std::count(shown.begin(), shown.end(), label),
              static_cast<std::ptrdiff_t>(read.seen_anchors->front().pixels));
  }
  // Standing at the start: the first image, straight ahead, in a room of less than 8 m.
  const auto& first = *depths.begin()->second;
  const auto& depth_m = std::get<0>(first.pixels);
  const double start_m = gap_m(record.ground_truth.front().message);
  EXPECT_NEAR(depth_m[std::size_t{120} * 320 + 160], start_m, 1e-3);
  EXPECT_TRUE(std::ranges::all_of(depth_m, [](float d) { return d > 0.3F && d < 8.0F; }));
}

TEST_F(DepthCamera, FramesAreExtracted) {
  const fs::path& out = flown_c();
  const Output frames = run(tether({"frames", out / "record.mcap"}), std::chrono::seconds(60));
  EXPECT_EQ(frames.code, 0) << frames.err;
  int of_depth = 0, of_labels = 0, of_colors = 0;
  for (const auto& entry : fs::directory_iterator(out / "frames")) {
    const std::string name = entry.path().filename();
    of_depth += name.ends_with("-depth.png");
    of_labels += name.ends_with("-labels.png");
    of_colors += name.ends_with(".svg");
    if (!name.ends_with(".png")) continue;
    EXPECT_EQ(read_text(entry.path())[24], 16) << name << ": bits of each pixel";
  }
  EXPECT_GT(of_depth, 5);
  EXPECT_EQ(of_depth, of_colors);
  EXPECT_GT(of_labels, 5);
  EXPECT_EQ(run(tether({"report", out}), std::chrono::seconds(60)).code, 0);
}

/// No picture without depths in place of one with.
TEST_F(DepthCamera, ExternalSimulatorsRefuseTheUavWithTheLineOfTheSensor) {
  const fs::path model = *folder_ / "example" / "uav.sdf";
  const Output output = run(
      gazebo_run(scenario(), *folder_ / "refused", stand_in_gazebo(folder_->path(), ""), "none"));
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_THAT(output.err, HasSubstr(model.string() + ":" +
                                    std::to_string(line_of(read_text(model), "name=\"rgbd\""))));
}

}  // namespace
}  // namespace tether::system_test
