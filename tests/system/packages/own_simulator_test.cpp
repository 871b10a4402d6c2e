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

class OwnSimulator : public testing::Test {
 protected:
  OwnSimulator() {
    const std::string source = TETHER_SOURCE_DIR;
    std::filesystem::copy(source + "/examples/own-simulator", example_);
    const auto build = example_ / "build";
    output_of({TETHER_CMAKE, "-S", example_, "-B", build, "-DCMAKE_CXX_COMPILER=g++",
               "-DTETHER_SCHEMA=" + source + "/host/sim/protocol/schema/simulator.fbs"});
    output_of({TETHER_CMAKE, "--build", build});
    const auto file = example_ / "face_anchor.toml";
    write_text(file, substituted(read_text(file),
                                 {{"\"../../data/models", "\"" + source + "/data/models"},
                                  {"\"../../data/profiles", "\"" + source + "/data/profiles"}}));
    simulator_ = std::make_unique<Process>(
        Command{{example_ / "build/own_simulator", folder_ / "yard.sock"}, {}, {}});
    EXPECT_TRUE(simulator_->wait_for_out("listening on " + address_, 30s));
  }
  Command command(const std::string& out, const std::vector<std::string>& options = {}) const {
    Command command = tether({"run", example_ / "face_anchor.toml", "--condition", "scripted",
                              "--simulator", address_, "--out", folder_ / out});
    command.arguments.insert(command.arguments.end(), options.begin(), options.end());
    return command;
  }
  void fly(const std::string& out, const std::vector<std::string>& options = {}) const {
    const Output output = run(command(out, options), 100s);
    EXPECT_EQ(output.code, 0) << output.err << read_text(folder_ / out / "sut-uav1.log");
  }

  const TempFolder folder_;
  const std::filesystem::path example_ = folder_ / "own-simulator";
  const std::string address_ = "unix:" + (folder_ / "yard.sock").string();
  std::unique_ptr<Process> simulator_;
};

TEST_F(OwnSimulator, FliesToTheGoal) {
  fly("out");
  const auto result = read_result(folder_ / "out");
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
  EXPECT_EQ(result["versions"]["simulator"], "own_simulator 1.0, rays");
  for (const auto& metric : result["metrics"]) EXPECT_TRUE(metric["value"].is_number()) << metric;
}

TEST_F(OwnSimulator, FliesTheSameEveryTime) {
  fly("a", {"--images"});
  fly("b", {"--images"});
  EXPECT_GT(read_record(folder_ / "a").images.size(), 5u);
  EXPECT_EQ(timeless_result(folder_ / "a"), timeless_result(folder_ / "b"));
  EXPECT_TRUE(timeless_record(folder_ / "a") == timeless_record(folder_ / "b"));
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
