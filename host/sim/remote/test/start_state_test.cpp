#include "checked_state.h"

#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/sim_testing/busy_flight.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using Spoil = std::function<void(protocol::State&)>;
using Check = void (*)(const World&, const protocol::State&, const std::string&);

protocol::State start_of(const World& world) {
  protocol::State state;
  for (const MovingBody& body : moving_bodies(world)) {
    state.bodies.push_back({body.X_WB.p, body.X_WB.q, {}, {}});
    state.past.push_back(body.X_WB);
  }
  return state;
}

/// What the check says of the busy world, which has UAVs and other bodies, after `spoil`.
std::string refusal_of(Check check, const Spoil& spoil) {
  const World world = busy_world();
  protocol::State state = start_of(world);
  spoil(state);
  try {
    check(world, state, "it");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kSetup);
    return error.what();
  }
  return {};
}

std::size_t first_body() {
  return busy_world().uavs.size();
}

TEST(StartState, IsThatOfTheWorld) {
  EXPECT_EQ(refusal_of(check_start, [](protocol::State&) {}), "");
}

TEST(StartState, HasRoundingAndEitherSign) {
  EXPECT_EQ(refusal_of(check_start,
                       [](protocol::State& state) {
                         uav::BodyState& body = state.bodies[0];
                         body.p_WB.x += 5e-7;
                         body.q_WB = {-body.q_WB.w, -body.q_WB.x, -body.q_WB.y, -body.q_WB.z};
                       }),
            "");
}

TEST(StartState, NamesAUavThatIsElsewhere) {
  const std::string name = busy_world().uavs[0].name;
  EXPECT_THAT(refusal_of(check_start, [](protocol::State& s) { s.bodies[0].p_WB.x += 2e-6; }),
              AllOf(HasSubstr("UAV '" + name + "' begins at p_WB ("), HasSubstr(" instead of ")));
  EXPECT_THAT(refusal_of(check_start,
                         [](protocol::State& s) {
                           s.bodies[0].q_WB = {0.0, 1.0, 0.0, 0.0};
                         }),
              HasSubstr("q_WB (0 1 0 0) instead of "));
}

TEST(StartState, NamesAUavThatMoves) {
  EXPECT_THAT(refusal_of(check_start, [](protocol::State& s) { s.bodies[0].v_WB.z = -2e-6; }),
              AllOf(HasSubstr("does not begin at rest"), HasSubstr("v_WB (0 0 -2e-06)")));
  EXPECT_THAT(refusal_of(check_start, [](protocol::State& s) { s.bodies[0].w_WB_B.z = 1.0; }),
              HasSubstr("w_WB_B (0 0 1)"));
}

TEST(StartState, NamesALinkThatIsElsewhere) {
  ASSERT_GT(moving_bodies(busy_world()).size(), first_body());
  const auto moved_by = [](double x_m) {
    return [x_m](protocol::State& s) { s.bodies[first_body()].p_WB.x += x_m; };
  };
  EXPECT_EQ(refusal_of(check_start, moved_by(5e-4)), "");
  EXPECT_THAT(refusal_of(check_start, moved_by(2e-3)), HasSubstr("link '"));
}

TEST(StartState, MayHaveOtherBodiesMove) {
  EXPECT_EQ(
      refusal_of(check_start, [](protocol::State& s) { s.bodies[first_body()].v_WB.x = 1.0; }), "");
}

TEST(StateReach, EndsWhereThatOfWorldsDoes) {
  EXPECT_EQ(refusal_of(check_reach, [](protocol::State& s) { s.bodies[0].p_WB.z = -1e5; }), "");
  EXPECT_THAT(refusal_of(check_reach, [](protocol::State& s) { s.bodies[0].p_WB.z = -1.1e5; }),
              HasSubstr("is at p_WB (0 0 -110000) m, beyond 1e5 m"));
  EXPECT_THAT(refusal_of(check_reach, [](protocol::State& s) { s.past.back().p.y = 1e6; }),
              HasSubstr("link '"));
}

}  // namespace
}  // namespace tether::sim::testing
