#include "support/trials.h"

#include <gtest/gtest.h>

/// A program reads a fast IMU beside a stereo camera, as their drivers would deliver them.
namespace tether::system_test {
namespace {

class Queues : public testing::Test {
 protected:
  /// 20 images of each camera a second, which the right one delivers 12 ms later, and 200 IMU
  /// measurements. Each call takes the program `computing_ms`.
  nlohmann::json fly(int queue, const std::string& computing_ms,
                     const std::string& of_imu = "") const {
    const std::filesystem::path shipped = TETHER_SOURCE_DIR "/data/models/hummingbird";
    std::filesystem::copy(shipped, folder_ / "uav",
                          std::filesystem::copy_options::recursive |
                              std::filesystem::copy_options::overwrite_existing);
    const auto camera = [](const std::string& name) {
      return "<sensor name='" + name +
             "' type='camera'><update_rate>20</update_rate><camera><image><width>64</width>"
             "<height>48</height></image></camera></sensor>\n";
    };
    const std::string range = "<sensor name=\"range\"";
    const auto model = folder_ / "uav/model.sdf";
    write_text(model,
               substituted(read_text(model), {{range, camera("left") + camera("right") + range}}));
    const std::string scenario =
        "name = \"queues\"\nworld = \"room\"\ntime_limit_s = 60\n[[uav]]\nname = \"uav1\"\n"
        "model = \"" +
        model.string() +
        "\"\nposition_m = [1.2, 0, 1.2]\n"
        "[uav.sensors.imu]\ntiming = \"periodic\"\nrate_hz = 200\n" +
        of_imu +
        "[uav.sensors.right]\ndelay = { kind = \"constant\", ms = 12 }\n"
        "[sut]\ncommand = [\"" QUEUES_SUT_PROGRAM "\", \"40\", \"" +
        std::to_string(queue) +
        "\"]\n[[condition]]\nname = \"host\"\npolicy = \"conservative_barrier\"\n"
        "clock = \"scripted\"\ncomputing_ms = " +
        computing_ms + "\n";
    const auto file = folder_ / "queues.toml";
    write_text(file, scenario);
    const auto out = folder_ / "out";
    const Output output = run(tether({"run", file, "--quiet", "--force", "--out", out}));
    EXPECT_LE(output.code, 1) << output.err;
    const auto result = read_result(out);
    EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
    return result["suts"][0]["details"];
  }
  TempFolder folder_;
};

// Each call takes little time, so nothing waits for long.
TEST_F(Queues, LoseNothingAndPairsAreOfOneInstant) {
  const auto details = fly(50, "0.1");
  EXPECT_EQ(details["lost"], 0);
  EXPECT_EQ(details["apart"], 0);
  EXPECT_NEAR(details["got"].get<double>(), 400.0, 12.0) << "10 for each of 40 images";
}

// A queue of 1 keeps the newest only, as reads without a queue do.
TEST_F(Queues, OfOneKeepTheNewest) {
  const auto details = fly(1, "0.1");
  EXPECT_EQ(details["apart"], 0);
  EXPECT_NEAR(details["got"].get<double>(), 40.0, 4.0);
  EXPECT_GT(details["lost"].get<int>(), 300);
}

// Each call takes 6 ms: more IMU measurements arrive than are read.
TEST_F(Queues, OverflowOnASlowComputer) {
  const auto details = fly(10, "6");
  EXPECT_EQ(details["apart"], 0);
  EXPECT_GT(details["lost"].get<int>(), 0);
}

// Of some 400 IMU measurements, a tenth never arrives. The audit checks each stamp, loss and
// repetition.
TEST_F(Queues, ADriverLosesAndRepeatsWhatItsProfileSays) {
  const auto details = fly(50, "0.1",
                           "stamp_offset_ms = -5\nstamp_jitter_ms = 1\nstamp_drift_ppm = 50\n"
                           "lost_probability = 0.1\nrepeated_probability = 0.1\n");
  EXPECT_EQ(details["apart"], 0);
  EXPECT_NEAR(details["lost"].get<double>(), 40.0, 18.0);
  EXPECT_NEAR(details["got"].get<double>() + details["lost"].get<double>(), 400.0, 14.0);
}

}  // namespace
}  // namespace tether::system_test
