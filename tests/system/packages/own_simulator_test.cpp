#include "support/installed.h"
#include "support/trials.h"

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// examples/own-simulator as a user builds it: a copy outside of the tree, by a plain compiler,
/// with nothing of Tether but the schema; then flown in.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

const std::string kSource = TETHER_SOURCE_DIR;

class OwnSimulator : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    built_ = std::make_unique<TempFolder>();
    const auto example = *built_ / "own-simulator", build = example / "build";
    std::filesystem::copy(kSource + "/examples/own-simulator", example);
    output_of({TETHER_CMAKE, "-S", example, "-B", build, "-DCMAKE_CXX_COMPILER=g++",
               "-DTETHER_SCHEMA=" + kSource + "/host/external/sim/protocol/schema/simulator.fbs"});
    output_of({TETHER_CMAKE, "--build", build});
  }
  static void TearDownTestSuite() { built_.reset(); }

  OwnSimulator() {
    std::filesystem::copy(kSource + "/examples/own-simulator", example_);
    simulator_ = std::make_unique<Process>(
        Command{{*built_ / "own-simulator/build/own_simulator", folder_ / "yard.sock"}});
    EXPECT_TRUE(simulator_->wait_for_out(address_, 30s));
  }
  Command command(const std::string& out, const std::vector<std::string>& options = {}) const {
    return with(tether({"run", example_ / "face_anchor.toml", "--condition", "scripted",
                        "--simulator", address_, "--out", folder_ / out}),
                options);
  }
  void fly(const std::string& out, const std::vector<std::string>& options = {}) const {
    const Output output = run(command(out, options), 100s);
    EXPECT_EQ(output.code, 0) << output.err << read_text(folder_ / out / "sut-uav1.log");
  }

  static inline std::unique_ptr<TempFolder> built_;
  TempFolder folder_;
  const std::filesystem::path example_ = folder_ / "own-simulator";
  const std::string address_ = "unix:" + (folder_ / "yard.sock").string();
  std::unique_ptr<Process> simulator_;
};

TEST_F(OwnSimulator, FliesToTheGoalTheSameEveryTime) {
  fly("a", {"--images"});
  fly("b", {"--images"});
  EXPECT_GT(read_record(folder_ / "a").images.size(), 5u);
  expect_same_runs(folder_ / "a", folder_ / "b");
  const auto result = read_result(folder_ / "a");
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
  EXPECT_EQ(result["versions"]["simulator"], "own_simulator 1.0, rays");
  for (const auto& metric : result["metrics"]) EXPECT_TRUE(metric["value"].is_number()) << metric;
}

TEST_F(OwnSimulator, HasEverySensor) {
  const auto file = example_ / "face_anchor.toml";
  write_text(file,
             substituted(read_text(file),
                         {{"\"face_anchor\"]", "\"characterize\"]"},
                          {"anchor = \"blue_box\"\nprecision_deg = 2.0\n",
                           "sensors = \"range,camera,imu\"\nacquisitions = 10\n"},
                          {"[[metric]]\nkind = \"final_bearing_error\"\nmax_deg = 5.0\n", ""}}));
  fly("out");
  const auto result = read_result(folder_ / "out");
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
  const auto& measured = result["suts"][0]["details"]["results"];
  for (const char* sensor : {"range", "camera", "imu"})
    EXPECT_EQ(measured[std::string(sensor) + "_n"], 10) << sensor;
}

TEST_F(OwnSimulator, SaysWhatItCannotDo) {
  const auto file = example_ / "yard.sdf";
  write_text(file,
             substituted(read_text(file), {{"<world name=\"yard\">", "<world name=\"moon\">"}}));
  const Output output = run(command("out"), 100s);
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("own_simulator knows the yard only"));
  EXPECT_FALSE(simulator_->has_ended());
}

}  // namespace
}  // namespace tether::system_test
