#include "checked_state.h"

#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/sim_testing/busy_flight.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim::testing {
namespace {

using ::testing::HasSubstr;

using Spoil = std::function<void(protocol::State&)>;
using Check = void (*)(const World&, const protocol::State&, const std::string&);

/// Of the busy world, which has UAVs and another body, after `spoil`.
void run_check(Check check, const Spoil& spoil) {
  const World world = busy_world();
  protocol::State state;
  for (const MovingBody& body : moving_bodies(world)) {
    state.bodies.push_back({body.X_WB.p, body.X_WB.q, {}, {}});
    state.past.push_back(body.X_WB);
  }
  spoil(state);
  check(world, state, "it");
}

void expect_refused(Check check, const std::string& body, const std::string& value,
                    const Spoil& spoil) {
  const Error error = thrown_error(ErrorCode::kSetup, [&] { run_check(check, spoil); });
  EXPECT_EQ(error.subject(), body);
  EXPECT_THAT(error.what(), HasSubstr(value));
}

const std::string kUav = "UAV 'alpha'";
const std::string kLink = "link '' of model 'loose'";
constexpr std::size_t kLoose = 2;  // behind the UAVs

TEST(StartState, MayDifferByRounding) {
  run_check(check_start, [](protocol::State& s) {
    s.bodies[0].p_WB.x += 5e-7;
    const uav::Quat q = s.bodies[0].q_WB;
    s.bodies[0].q_WB = {-q.w, -q.x, -q.y, -q.z};  // the same rotation
  });
}

TEST(StartState, OfAUavIsItsPoseAtRest) {
  expect_refused(check_start, kUav, "(2e-06 0 1)", [](auto& s) { s.bodies[0].p_WB.x = 2e-6; });
  expect_refused(check_start, kUav, "(0 1 0 0)", [](auto& s) {
    s.bodies[0].q_WB = uav::Quat{0.0, 1.0, 0.0, 0.0};
  });
  expect_refused(check_start, kUav, "(0 0 -2e-06)", [](auto& s) { s.bodies[0].v_WB.z = -2e-6; });
  expect_refused(check_start, kUav, "(0 0 1)", [](auto& s) { s.bodies[0].w_WB_B.z = 1.0; });
}

TEST(StartState, OfALinkIsItsPoseAboutAndAnyMotion) {
  run_check(check_start, [](auto& s) {
    s.bodies[kLoose].p_WB.x += 5e-4;
    s.bodies[kLoose].v_WB.x = 1.0;
  });
  expect_refused(check_start, kLink, "", [](auto& s) { s.bodies[kLoose].p_WB.x += 2e-3; });
}

TEST(StateReach, HasTheLimitOfWorlds) {
  run_check(check_reach, [](auto& s) { s.bodies[0].p_WB.z = -1e5; });
  expect_refused(check_reach, kUav, "(0 0 -110000)", [](auto& s) { s.bodies[0].p_WB.z = -1.1e5; });
  expect_refused(check_reach, kLink, "", [](auto& s) { s.past.back().p.y = 1e6; });
}

}  // namespace
}  // namespace tether::sim::testing
