#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/sim_testing/fake_simulator.h>

namespace tether::sim {
namespace {

using std::chrono::milliseconds;

const uav::VelocityCommand kTurningLeft{{0.5, 0.1, -0.2}, 0.8};

SimTime at_ms(std::int64_t ms) {
  return SimTime(milliseconds(ms));
}

/// Flies with a command, stopping at `stops` as well, and measures everything at the end.
std::vector<uav::Sample> fly(FakeSimulator& simulator, const std::vector<SimTime>& stops) {
  simulator.reset(7);
  simulator.apply(0, to_setpoint(kTurningLeft));
  for (const SimTime stop : stops) simulator.advance_to(stop);
  simulator.advance_to(at_ms(1000));
  Snapshot snapshot;
  simulator.capture(snapshot);
  std::vector<uav::Sample> samples;
  for (std::size_t sensor = 0; sensor < 3; ++sensor) {
    samples.push_back(simulator.measure(snapshot, 0, sensor, sensor));
  }
  return samples;
}

TEST(FakeSimulator, GivesTheSameBytesHoweverTheAdvanceIsSplit) {
  FakeSimulator simulator(make_fake_world(2));
  const auto whole = fly(simulator, {});
  const auto truth = simulator.ground_truth(0).body;
  const auto split = fly(simulator, {at_ms(1), at_ms(333), at_ms(333), at_ms(999)});
  EXPECT_EQ(std::get<uav::CameraSample>(whole[0]).rgb, std::get<uav::CameraSample>(split[0]).rgb);
  EXPECT_EQ(std::get<uav::ImuSample>(whole[1]).q_WS, std::get<uav::ImuSample>(split[1]).q_WS);
  EXPECT_EQ(std::get<uav::RangeSample>(whole[2]).range_m,
            std::get<uav::RangeSample>(split[2]).range_m);
  EXPECT_EQ(truth.p_WB, simulator.ground_truth(0).body.p_WB);
}

TEST(FakeSimulator, FollowsCommandsFromTheirInstantInTheHeadingFrame) {
  World world = make_fake_world(1);
  world.uavs[0].X_WB.q = uav::from_axis_angle({0.0, 0.0, 1.0}, 1.5707963267948966);
  FakeSimulator simulator(std::move(world));
  simulator.advance_to(at_ms(100));
  simulator.apply(0, uav::to_setpoint({{2.0, 0.0, 0.5}, 0.0}));
  simulator.advance_to(at_ms(600));
  const auto body = simulator.ground_truth(0).body;
  EXPECT_LT(norm(body.p_WB - uav::Vec3{0.0, 1.0, 1.25}), 1e-9);
  simulator.apply(0, uav::to_setpoint({{}, 0.5}));
  simulator.advance_to(at_ms(1600));
  EXPECT_NEAR(uav::yaw_rad(simulator.ground_truth(0).body.q_WB) - uav::yaw_rad(body.q_WB), 0.5,
              1e-9);
  ASSERT_EQ(simulator.applied().size(), 2u);
  EXPECT_EQ(simulator.applied()[1].at, at_ms(600));
}

TEST(FakeSimulator, ImagesDifferBySeedUavInstantAndIndex) {
  FakeSimulator simulator(make_fake_world(2));
  Snapshot snapshot;
  simulator.capture(snapshot);
  const auto image = [&](std::size_t uav, std::uint64_t index) {
    return std::get<uav::CameraSample>(simulator.measure(snapshot, uav, 0, index)).rgb;
  };
  const auto first = image(0, 0);
  EXPECT_EQ(first, image(0, 0));
  EXPECT_NE(first, image(1, 0));
  EXPECT_NE(first, image(0, 1));
  simulator.reset(1);
  EXPECT_NE(first, image(0, 0));
  simulator.advance_to(at_ms(33));
  simulator.capture(snapshot);
  simulator.advance_to(at_ms(2033));
  const auto later = std::get<uav::CameraSample>(simulator.measure(snapshot, 0, 0, 5));
  EXPECT_EQ(later.sampled_at, at_ms(33));
  EXPECT_EQ(instant_in_image(later), at_ms(33));
  EXPECT_EQ(later.index, 5u);
}

TEST(FakeSimulator, CountsCallsAndReportsAdvances) {
  FakeSimulator simulator;
  std::vector<std::pair<SimTime, SimTime>> advances;
  simulator.on_advance([&](SimTime from, SimTime to) { advances.emplace_back(from, to); });
  simulator.advance_to(at_ms(3));
  simulator.advance_to(at_ms(10));
  EXPECT_EQ(simulator.calls().advance_to, 2u);
  EXPECT_EQ(simulator.calls().steps, 10u);
  ASSERT_EQ(advances.size(), 2u);
  EXPECT_EQ(advances[1], std::pair(at_ms(3), at_ms(10)));
  simulator.on_advance([](SimTime, SimTime) { throw Error(ErrorCode::kSetup, "lost"); });
  EXPECT_THROW(simulator.advance_to(at_ms(11)), Error);
}

TEST(FakeSimulator, RefusesInvalidCalls) {
  FakeSimulator simulator;
  simulator.advance_to(at_ms(2));
  EXPECT_THROW(simulator.advance_to(at_ms(1)), Error);
  EXPECT_THROW(simulator.advance_to(at_ms(2) + Duration(1)), Error);
  EXPECT_THROW(simulator.apply(1, {}), Error);
  Snapshot snapshot;
  simulator.capture(snapshot);
  EXPECT_THROW(simulator.measure(snapshot, 0, 3, 0), Error);
}

}  // namespace
}  // namespace tether::sim
