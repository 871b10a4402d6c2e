#include "support/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/record/canonical.h>

/// With scripted execution times a run is the same to the byte, whatever the speed of the simulator
/// or of the wire.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

/// One face-anchor run whose SUT has a scripted clock: 2 ms for each phase of computing.
Output fly(const std::filesystem::path& scenario, const std::filesystem::path& out,
           const std::vector<std::string>& options = {}) {
  ExternalRun run(scenario, out, options);
  const auto sut = run.start_sut(face_sut());
  const Output output = run.wait();
  EXPECT_EQ(output.code, 0) << output.err << sut->err();
  return output;
}

double wall_s(const std::filesystem::path& out) {
  return read_result(out)["this_run"]["wall_s"];
}

class ScriptedRun : public testing::Test {
 protected:
  void expect_same(const std::string& a, const std::string& b) const {
    EXPECT_EQ(timeless_result(folder_ / a), timeless_result(folder_ / b));
    const std::string record = timeless_record(folder_ / a);
    EXPECT_GT(record.size(), 10'000u);
    EXPECT_TRUE(record == timeless_record(folder_ / b)) << "the records differ";
  }

  TempFolder folder_;
  std::filesystem::path scenario_ = write_face_scenario(folder_.path());
};

// Images and all: what the SUT saw is the same as well.
TEST_F(ScriptedRun, IsTheSameEveryTime) {
  fly(scenario_, folder_ / "a", {"--images"});
  fly(scenario_, folder_ / "b", {"--images"});
  EXPECT_GT(read_record(folder_ / "a").images.size(), 5u);
  expect_same("a", "b");
}

TEST_F(ScriptedRun, IsAnotherWithAnotherSeed) {
  fly(scenario_, folder_ / "a");
  fly(scenario_, folder_ / "b", {"--seed", "2"});
  EXPECT_FALSE(timeless_record(folder_ / "a") == timeless_record(folder_ / "b"));
}

TEST_F(ScriptedRun, DoesNotFeelASlowSimulator) {
  fly(scenario_, folder_ / "fast");
  fly(scenario_, folder_ / "slow", {"--real-time-factor", "0.1"});
  expect_same("fast", "slow");
  const double simulated_s = read_result(folder_ / "slow")["sync"]["st_at_end_s"];
  EXPECT_GE(wall_s(folder_ / "slow"), 9.0 * simulated_s);
}

TEST_F(ScriptedRun, DoesNotFeelASlowWire) {
  fly(scenario_, folder_ / "direct");

  ExternalRun run(scenario_, folder_ / "slow");
  Process proxy(
      {{proxy_program(), "0", run.address(), "--delay-ms", "20", "--mbit-s", "100"}, {}, {}});
  ASSERT_TRUE(proxy.wait_for_out("\n", 10s)) << proxy.err();
  const std::string address = proxy.out().substr(0, proxy.out().find('\n'));
  const auto sut = run.start_sut(face_sut(), {{"TETHER_ADDRESS", address}});
  EXPECT_EQ(run.wait().code, 0) << sut->err();

  expect_same("direct", "slow");
  const double interactions = read_result(folder_ / "slow")["sync"]["interactions"];
  EXPECT_GE(wall_s(folder_ / "slow"), 0.04 * (interactions - 1.0));
}

// ---- Two UAVs

/// A second UAV beside the first, turned the other way.
const Substitution kSecondUav = {"\n[sut]",
                                 R"(
[[uav]]
name = "uav2"
model = "small_camera.sdf"
position_m = [1.2, -1.5, 1.2]
yaw_deg = 35.0
command_latency_ms = 3.5

[sut])"};
const std::vector<Substitution> kTwoUavs = {
    kSecondUav,
    {"[[metric]]\nkind = \"oscillations\"\n", ""},
    {"kind = \"time_required\"", "kind = \"time_required\"\nuav = \"uav1\""},
    {"kind = \"final_bearing_error\"", "kind = \"final_bearing_error\"\nuav = \"uav2\""}};

class TwoUavs : public testing::Test {
 protected:
  void fly_both(const std::string& out, const std::vector<std::string>& options = {}) {
    ExternalRun run(scenario_, folder_ / out, options);
    const auto first = run.start_sut(face_sut(), {{"TETHER_UAV", "uav1"}});
    const auto second =
        run.start_sut(face_sut(), {{"TETHER_UAV", "uav2"}, {"TETHER_CLOCK", "scripted*7.3"}});
    const Output output = run.wait();
    EXPECT_EQ(output.code, 0) << output.err << first->err() << second->err();
  }
  // Which request found ST where is a matter of the race between the two; all else is not.
  std::string record_without_arrivals(const std::string& out) const {
    return record::canonical(read_record(folder_ / out));
  }

  TempFolder folder_;
  std::filesystem::path scenario_ = write_face_scenario(folder_.path(), kTwoUavs);
};

TEST_F(TwoUavs, FlyUnderOneBarrierAndRepeat) {
  fly_both("a");
  fly_both("b", {"--real-time-factor", "0.5"});
  EXPECT_EQ(timeless_result(folder_ / "a"), timeless_result(folder_ / "b"));
  EXPECT_TRUE(record_without_arrivals("a") == record_without_arrivals("b"));

  const record::Record record = read_record(folder_ / "a");
  ASSERT_EQ(record.header.suts.size(), 2u);
  for (const char* uav : {"uav1", "uav2"})
    EXPECT_TRUE(std::ranges::any_of(record.commands, [&](const auto& command) {
      return command.message.uav == uav && command.message.yaw_rate_rad_s != 0.0;
    })) << uav;
  for (const char* out : {"a", "b"}) {
    const Output audit = run(tether({"audit", folder_ / out / "record.mcap"}));
    EXPECT_EQ(audit.code, 0) << audit.out;
  }
}

// Started by Tether itself, each with its own CPU time.
TEST_F(TwoUavs, PassTheAuditWithRealTimes) {
  const Output output =
      run(tether({"run", scenario_, "--condition", "target", "--out", folder_ / "out"}));
  EXPECT_THAT(output.code, testing::AnyOf(0, 1)) << output.err;
  EXPECT_EQ(read_result(folder_ / "out")["end"], "finished");
  EXPECT_EQ(read_result(folder_ / "out")["suts"].size(), 2u);
  EXPECT_EQ(run(tether({"audit", folder_ / "out/record.mcap"})).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/sut-uav1.log"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/sut-uav2.log"));
}

}  // namespace
}  // namespace tether::system_test
