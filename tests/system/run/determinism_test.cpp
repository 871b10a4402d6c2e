#include "support/trials.h"

#include <cstdint>

#include <gtest/gtest.h>

#include <tether/os/machine.h>

/// With scripted execution times a run is the same to the byte, whatever the speed of the simulator
/// or of the link.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

double wall_s(const std::filesystem::path& out) {
  return read_result(out)["this_run"]["wall_s"];
}

/// Face-anchor runs whose SUT has a scripted clock: 2 ms for each phase of computing.
class ScriptedRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    scenario_ = write_face_scenario(folder_->path(), {kScripted});
    fly("first", {"--images"});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static void fly(const std::string& out, const std::vector<std::string>& options) {
    ExternalRun run(scenario_, *folder_ / out, options);
    const auto sut = run.start_sut(face_sut());
    const Output output = run.wait();
    EXPECT_EQ(output.code, 0) << output.err << sut->err();
  }
  static std::filesystem::path out(const std::string& name) { return *folder_ / name; }

  static inline std::unique_ptr<TempFolder> folder_;
  static inline std::filesystem::path scenario_;
};

// Images and all: what the SUT saw is the same as well.
TEST_F(ScriptedRun, IsTheSameWithASlowSimulator) {
  fly("slow", {"--images", "--real-time-factor", "0.25"});
  EXPECT_GT(read_record(out("slow")).images.size(), 5u);
  expect_same_runs(out("first"), out("slow"));
  const double simulated_s = read_result(out("slow"))["sync"]["st_at_end_s"];
  EXPECT_GE(wall_s(out("slow")), 3.6 * simulated_s);
}

TEST_F(ScriptedRun, IsTheSameOverASlowLink) {
  ExternalRun run(scenario_, out("slow_link"), {"--images"});
  const SlowWire wire(run.address(), 20, 100);
  const auto sut = run.start_sut(face_sut(), {{"TETHER_ADDRESS", wire.address()}});
  EXPECT_EQ(run.wait().code, 0) << sut->err();

  expect_same_runs(out("first"), out("slow_link"));
  const double interactions = read_result(out("slow_link"))["sync"]["interactions"];
  EXPECT_GE(wall_s(out("slow_link")), 0.04 * (interactions - 1.0));
}

// With a second core, pictures are drawn before the SUT asks for them.
TEST_F(ScriptedRun, IsTheSameOnOneCore) {
  if (os::separate_cores() < 2) GTEST_SKIP() << "needs two cores";
  const auto drawn_ahead = [](const std::string& name, const std::vector<std::string>& launcher) {
    const Command command = tether({"run", scenario_, "--images", "--quiet", "--out", out(name)});
    const Output output = run(started_by(launcher, command), 120s);
    EXPECT_EQ(output.code, 0) << output.err;
    return std::uint64_t{read_result(out(name))["this_run"]["simulator"]["drawn_ahead"]};
  };
  const std::string one_cpu = std::to_string(os::allowed_cpus().front());
  EXPECT_EQ(drawn_ahead("one_core", {"taskset", "--cpu-list", one_cpu}), 0u);
  EXPECT_GT(drawn_ahead("all_cores", {}), 0u);
  expect_same_runs(out("one_core"), out("all_cores"));
}

// ---- Two UAVs

/// A second UAV beside the first, turned the other way.
const std::vector<Substitution> kTwoUavs = {
    {kScripted.first, "clock = \"scripted\"\ncomputing_ms = 7.3"},
    {"\n[sut]", R"(
[[uav]]
name = "uav2"
model = "small_camera.sdf"
position_m = [1.2, -1.5, 1.2]
yaw_deg = 35.0
command_latency_ms = 3.5

[sut])"},
    {"[[metric]]\nkind = \"oscillations\"\n", ""},
    {"kind = \"time_required\"", "kind = \"time_required\"\nuav = \"uav1\""},
    {"kind = \"final_bearing_error\"", "kind = \"final_bearing_error\"\nuav = \"uav2\""}};

TEST(TwoUavs, FlyUnderOneBarrierAndRepeat) {
  const TempFolder folder;
  const auto scenario = write_face_scenario(folder.path(), kTwoUavs);
  for (const char* out : {"a", "b"}) {
    const std::vector<Spinner> load(*out == 'b' ? 3 : 0);
    ExternalRun run(scenario, folder / out, {"--images"});
    const auto first = run.start_sut(face_sut(), {{"TETHER_UAV", "uav1"}});
    const auto second = run.start_sut(face_sut(), {{"TETHER_UAV", "uav2"}});
    const Output output = run.wait();
    EXPECT_EQ(output.code, 0) << output.err << first->err() << second->err();
    EXPECT_EQ(audit_code(folder / out), 0);
  }
  EXPECT_EQ(timeless_result(folder / "a"), timeless_result(folder / "b"));
  EXPECT_TRUE(read_text(folder / "a/record.mcap") == read_text(folder / "b/record.mcap"));
  const record::Record record = read_record(folder / "a");
  ASSERT_EQ(record.header.suts.size(), 2u);
  for (const char* uav : {"uav1", "uav2"})
    EXPECT_TRUE(std::ranges::any_of(record.commands, [&](const auto& command) {
      return command.message.uav == uav && command.message.yaw_rate_rad_s != 0.0;
    })) << uav;
}

}  // namespace
}  // namespace tether::system_test
