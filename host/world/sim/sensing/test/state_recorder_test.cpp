#include <gtest/gtest.h>

#include <tether/sim_sensing/state_layout.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::kCamera;
using uav::Pose;

// Two UAVs, and a shutter that reaches three steps back.
World shutter_world(double exposure_s = 0.003) {
  World world = testing::test_world();
  world.uavs.push_back(testing::test_uav("beta", {2.0, 0.0, 1.0}));
  std::get<CameraModel>(world.uavs[0].sensors[kCamera].model).exposure_s = exposure_s;
  return world;
}

std::vector<Pose> poses_at(double x) {
  return {{{x, 0.0, 1.0}, uav::from_rpy(0.1, 0.2, 0.3 * x)}, {{-x, 5.0, 0.0}, {}}};
}

const std::vector<BodyMotion> kSteadyMotions{{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}},
                                             {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0.8, 0.9}}};

std::vector<double> captured(const StateRecorder& recorder, double x) {
  std::vector<double> state;
  recorder.capture(poses_at(x), kSteadyMotions, state);
  return state;
}

// Where both bodies were, as x of `poses_at`.
void expect_past(const StateRecorder& recorder, const std::vector<double>& state,
                 const std::vector<double>& x) {
  const StateLayout& layout = recorder.layout();
  for (std::size_t steps = 0; steps < x.size(); ++steps) {
    for (std::size_t body = 0; body < 2; ++body) {
      EXPECT_EQ(layout.past_pose_of(state, body, steps), poses_at(x[steps])[body])
          << body << ", " << steps << " steps ago";
    }
  }
}

TEST(StateRecorderTest, NothingMovedBeforeTheReset) {
  StateRecorder recorder(shutter_world());
  recorder.reset(poses_at(0.0));
  expect_past(recorder, captured(recorder, 0.0), {0.0, 0.0, 0.0, 0.0});
  for (const double x : {1.0, 2.0}) recorder.begin_step(poses_at(x));
  recorder.reset(poses_at(9.0));
  expect_past(recorder, captured(recorder, 9.0), {9.0, 9.0, 9.0, 9.0});
}

TEST(StateRecorderTest, ForgetsTheOldestStepFirst) {
  StateRecorder recorder(shutter_world());
  recorder.reset(poses_at(0.0));
  recorder.begin_step(poses_at(0.5));
  expect_past(recorder, captured(recorder, 1.0), {1.0, 0.5, 0.0, 0.0});
  for (const double x : {1.0, 2.0, 3.0, 4.0}) recorder.begin_step(poses_at(x));
  expect_past(recorder, captured(recorder, 5.0), {5.0, 4.0, 3.0, 2.0});
}

// A back end that receives many steps at once may skip those that no shutter reaches.
TEST(StateRecorderTest, StepsBeyondTheShuttersMayBeLeftOut) {
  StateRecorder whole(shutter_world());
  StateRecorder last(shutter_world());
  whole.reset(poses_at(0.0));
  last.reset(poses_at(0.0));
  for (int i = 0; i < 50; ++i) {
    whole.begin_step(poses_at(0.1 * i));
    if (i >= 47) last.begin_step(poses_at(0.1 * i));
  }
  EXPECT_EQ(captured(whole, 5.0), captured(last, 5.0));
}

}  // namespace
}  // namespace tether::sim
