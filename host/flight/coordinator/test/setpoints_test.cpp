#include "coordinator_fixture.h"

#include <algorithm>

#include <gmock/gmock.h>

namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// Set-points of any level, through whole runs.
class SetpointsTest : public CoordinatorTest {
 protected:
  /// When which mask took effect, with the loss: "3 ms 18", "7 ms 18 brake".
  std::vector<std::string> effects() const {
    std::vector<std::string> out;
    for (const record::CommandEffect& m : recorder_.commands)
      out.push_back(std::to_string(to_ns(m.applied_at) / 1'000'000) + " ms " +
                    std::to_string(m.setpoint ? m.setpoint->mask : 18) +
                    (m.loss.empty() ? "" : " " + m.loss));
    return out;
  }
};

uav::Setpoint there(double x_m) {
  return {.mask = uav::kPosition, .in_heading = false, .p_WB_m = {x_m, 0, 1}};
}

Act follow(Duration compute, std::vector<uav::TimedSetpoint> setpoints) {
  return {compute, link::SetTrajectory{std::move(setpoints)}};
}

TEST_F(SetpointsTest, AnySetpointReachesTheSimulatorAndTheRecord) {
  const uav::Setpoint rotors{.mask = uav::kRotorSpeeds, .rotor_speeds_rad_s = {400, 401, 402, 403}};
  run({follow(milliseconds(2), {{Duration(0), there(2)}}),
       follow(milliseconds(1), {{Duration(0), rotors}}), turn(milliseconds(1), 1.0),
       sleep({}, milliseconds(2)), finish(Duration(0))});
  ASSERT_EQ(simulator_->applied().size(), 3u);
  EXPECT_EQ(simulator_->applied()[0].setpoint, there(2));
  EXPECT_EQ(simulator_->applied()[1].setpoint, rotors);
  EXPECT_THAT(effects(), testing::ElementsAre("2 ms 1", "3 ms 256", "4 ms 18"));
  EXPECT_EQ(recorder_.commands[1].setpoint->rotor_speeds_rad_s[3], 403.0);
  EXPECT_EQ(recorder_.interactions[0].setpoints.at(0), *recorder_.commands[0].setpoint);
  EXPECT_EQ(recorder_.interactions[0].kind, record::kCommand);
  EXPECT_FALSE(recorder_.interactions[0].command);
  EXPECT_TRUE(recorder_.interactions[2].command);
}

TEST_F(SetpointsTest, TheVehicleFollowsATrajectoryUntilTheNextCommand) {
  latency_ = microseconds(500);
  run({follow(milliseconds(2), {{Duration(0), there(1)},
                                {milliseconds(3), there(2)},
                                {milliseconds(6), {}},
                                {milliseconds(9), there(3)}}),
       sleep({}, milliseconds(8)), turn(Duration(0), 1.0), sleep({}, milliseconds(8)),
       finish(Duration(0))});
  EXPECT_THAT(effects(), testing::ElementsAre("3 ms 1", "6 ms 1", "9 ms 18", "11 ms 18"));
  EXPECT_EQ(recorder_.commands[2].index, 2u);
  EXPECT_EQ(recorder_.interactions[0].setpoints.size(), 4u);
}

// They neither end a trajectory nor show that the link is there.
TEST_F(SetpointsTest, JointsAloneLeaveWhatIsFlown) {
  sim::World world = sim::make_fake_world(1, milliseconds(1));
  world.uavs[0].joints = {{"pitch", {}, {0, 1, 0}, -1, 1, 2}};
  make(std::move(world));
  options_.uavs[0].setpoint_loss = {milliseconds(4), uav::LossAction::kBrake};
  remake();
  const uav::Setpoint down{.mask = uav::kJoints, .joints_rad = {0.5}};
  run({follow(milliseconds(2), {{Duration(0), there(1)}, {milliseconds(3), there(2)}}),
       follow(milliseconds(2), {{Duration(0), down}}), sleep({}, milliseconds(3)),
       follow(milliseconds(1), {{Duration(0), down}}), sleep({}, milliseconds(8)),
       finish(Duration(0))});
  EXPECT_THAT(effects(),
              testing::ElementsAre("2 ms 1", "4 ms 512", "5 ms 1", "8 ms 512", "10 ms 18 brake"));
  EXPECT_EQ(recorder_.header.suts.at(0).joints.at(0).name, "pitch");
}

TEST_F(SetpointsTest, ALostLinkHasTheEffectOfTheScenario) {
  using enum uav::LossAction;
  const std::pair<uav::LossAction, uav::Setpoint> cases[] = {
      {kKeep, uav::to_setpoint({{1, 0, 0}, 0})},
      {kHover, {.mask = uav::kPosition, .in_heading = false, .p_WB_m = {0.006, 0, 1}}},
      {kBrake, {}},
      {kLand, uav::to_setpoint({{0, 0, -0.4}, 0})}};
  for (const auto& [action, expected] : cases) {
    make();
    options_.uavs[0].setpoint_loss = {milliseconds(5), action};
    remake();
    run({{milliseconds(10), link::SetVelocity{{{1, 0, 0}, 0}}},
         sleep({}, milliseconds(20)),
         turn(Duration(0), 1.0),
         sleep({}, milliseconds(3)),
         finish(Duration(0))});
    ASSERT_EQ(recorder_.commands.size(), 3u);
    EXPECT_EQ(recorder_.commands[1].loss, name(action));
    EXPECT_EQ(recorder_.commands[1].applied_at, st_ms(16));
    EXPECT_EQ(recorder_.commands[1].sequence, 1u);
    const uav::Setpoint& applied = simulator_->applied().at(1).setpoint;
    EXPECT_EQ(applied.mask, expected.mask) << name(action);
    EXPECT_NEAR(norm(applied.p_WB_m - expected.p_WB_m), 0.0, 1e-9);
    EXPECT_EQ(applied.velocity_m_s, expected.velocity_m_s);
    EXPECT_EQ(recorder_.header.suts[0].on_setpoint_loss, name(action));
    EXPECT_EQ(recorder_.header.suts[0].setpoint_timeout, milliseconds(5));
  }
}

TEST_F(SetpointsTest, DrawnLatenciesAreKeyedAndKeepTheOrder) {
  const auto fly = [this](std::uint64_t seed) {
    options_.seed = seed;
    make();
    options_.uavs[0].command_latency =
        uav::EmpiricalDelay{{microseconds(200), microseconds(5'300), microseconds(20'000)}};
    remake();
    ScriptedServer::Script script;
    for (int i = 0; i < 30; ++i) script.push_back(turn(milliseconds(1), 0.01 * i));
    script.push_back(sleep({}, milliseconds(30)));
    script.push_back(finish(Duration(0)));
    run(std::move(script));
    std::vector<std::int64_t> latencies;
    for (const record::Interaction& entry : recorder_.interactions)
      if (entry.command_latency) latencies.push_back(entry.command_latency->count());
    EXPECT_TRUE(std::ranges::is_sorted(recorder_.commands, {}, &record::CommandEffect::sequence));
    EXPECT_EQ(recorder_.commands.size(), 30u);
    return latencies;
  };
  const auto first = fly(1);
  ASSERT_EQ(first.size(), 30u);
  EXPECT_EQ(first, fly(1));
  EXPECT_NE(first, fly(2));
  EXPECT_EQ(recorder_.header.suts[0].command_latency, microseconds(200));
  EXPECT_EQ(recorder_.header.suts[0].max_command_latency, Duration(microseconds(20'000)));
}

TEST_F(SetpointsTest, InvalidOnesEndTheRunWithTheReason) {
  const std::pair<uav::Setpoint, std::string> cases[] = {
      {{.mask = uav::kRotorSpeeds, .rotor_speeds_rad_s = {1, 1}}, "rotor speeds"},
      {{.mask = uav::kBodyRates | uav::kThrust, .thrust_N = 1e5}, "thrust is above"}};
  for (const auto& [setpoint, reason] : cases) {
    make();
    const RunReport report =
        run({follow(milliseconds(1), {{Duration(0), setpoint}}), finish(Duration(0))});
    EXPECT_EQ(report.end, RunEnd::kSutLost);
    EXPECT_THAT(report.reason, HasSubstr(reason));
  }
}

}  // namespace
}  // namespace tether::coordinator
