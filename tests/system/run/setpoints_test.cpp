#include "support/trials.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/record/messages.h>

/// Commands of every level, trajectories, drawn latencies and lost links: what flights with them
/// leave, and whether they follow the rules of time.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

class Setpoints : public testing::Test {
 protected:
  Output fly(const std::string& out, const std::string& calls, const std::string& uav_keys) {
    write_text(folder_ / "fly.toml",
               "name = \"fly\"\nworld = \"" + hover_world().string() +
                   "\"\ntime_limit_s = 20\nmax_contact_speed_m_s = inf\n[[uav]]\nname = \"uav1\"\n"
                   "model = \"" TETHER_SOURCE_DIR
                   "/data/models/hummingbird_gimbal/model.sdf\"\n"
                   "position_m = [0.0, 0.0, 1.0]\n" +
                   uav_keys + "[sut]\ncommand = [\"" SCRIPT_SUT_PROGRAM "\", " + calls +
                   "\"finish\"]\n[[condition]]\nname = \"only\"\n"
                   "policy = \"conservative_barrier\"\n"
                   "clock = \"scripted\"\ncomputing_ms = 1.3\n");
    return run(tether({"run", folder_ / "fly.toml", "--quiet", "--out", folder_ / out}), 60s);
  }

  TempFolder folder_;
};

TEST_F(Setpoints, APositionIsReachedAndALostLinkEndsInALanding) {
  const Output output =
      fly("land", R"("follow:9", "sleep:4000", "refused:3000", "refused:33", "sleep:6000", )",
          "setpoint_timeout_ms = 5000\non_setpoint_loss = \"land\"\n");
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(audit_code(folder_ / "land"), 0);
  const record::Record record = read_record(folder_ / "land");
  ASSERT_EQ(record.commands.size(), 2u);
  EXPECT_EQ(record.commands[1].message.loss, "land");
  const auto arrived = std::ranges::find_if(
      record.ground_truth, [](const auto& truth) { return truth.at >= SimTime(4s); });
  EXPECT_NEAR(arrived->message.p_WB_m[0], 0.4, 0.02);
  EXPECT_NEAR(arrived->message.p_WB_m[1], -0.2, 0.02);
  EXPECT_NEAR(arrived->message.p_WB_m[2], 1.3, 0.02);
  EXPECT_LT(record.ground_truth.back().message.p_WB_m[2], 0.3);
}

TEST_F(Setpoints, AGimbalTurnsAtItsRateWhileTheUavFliesOn) {
  const Output output = fly("gimbal", R"("follow:2", "follow:512", "sleep:2000", )", "");
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(audit_code(folder_ / "gimbal"), 0);
  const record::Record record = read_record(folder_ / "gimbal");
  const auto& joints = record.header.suts.at(0).joints;
  ASSERT_EQ(joints.size(), 2u);
  EXPECT_EQ(joints[1].name, "gimbal_pitch");
  const auto at = [&](Duration time) {
    return std::ranges::find_if(record.ground_truth,
                                [&](const auto& truth) { return truth.at >= SimTime(time); })
        ->message;
  };
  EXPECT_NEAR(at(200ms).joints_rad.at(1), 2.0 * 0.2, 0.02);
  EXPECT_EQ(at(1s).joints_rad, (std::vector{-0.6, 1.2}));
  EXPECT_GT(at(1s).v_WB_m_s[0], 0.2);
}

TEST_F(Setpoints, AnyMixFollowsTheRulesOfTimeAndRepeats) {
  constexpr const char* kMasks[] = {"1", "9",    "23",  "2",   "1010", "1006",
                                    "4", "1020", "160", "192", "256"};
  constexpr int kJoints = 512;
  const std::string keys =
      "command_latency = { kind = \"normal\", mean_ms = 6, stddev_ms = 5 }\n"
      "setpoint_timeout_ms = 40\non_setpoint_loss = \"";
  for (const char* action : {"keep", "hover", "brake", "land"}) {
    KeyedRandom random({5, static_cast<std::uint64_t>(action[0]), 0});
    std::string calls;
    for (int i = 0; i < 250; ++i) {
      calls += "\"follow:";
      for (std::uint32_t more = random.bits() % 4; more > 0; --more)
        calls += std::string(kMasks[random.bits() % 11]) + ",";
      calls += std::string(kMasks[random.bits() % 8]) + "\", ";
      if (random.bits() % 4 == 0)
        calls += "\"follow:" + std::to_string(kJoints) +
                 "\", \"follow:" + std::to_string(kJoints + 1) + "," + kMasks[random.bits() % 8] +
                 "\", ";
      if (random.bits() % 3 == 0) calls += "\"sleep:" + std::to_string(random.bits() % 70) + "\", ";
    }
    const std::string name = action;
    for (const std::string& out : {name, name + "_again"}) {
      const Output output = fly(out, calls, keys + name + "\"\n");
      ASSERT_EQ(output.code, 0) << output.err;
      EXPECT_EQ(audit_code(folder_ / out), 0) << out;
    }
    EXPECT_TRUE(read_text(folder_ / name / "record.mcap") ==
                read_text(folder_ / (name + "_again") / "record.mcap"));
    const record::Record record = read_record(folder_ / name);
    EXPECT_TRUE(std::ranges::any_of(record.commands,
                                    [](const auto& c) { return !c.message.loss.empty(); }));
    EXPECT_TRUE(
        std::ranges::any_of(record.commands, [](const auto& c) { return c.message.index > 0; }));
  }
}

}  // namespace
}  // namespace tether::system_test
