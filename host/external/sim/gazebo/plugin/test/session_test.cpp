#include <deque>

#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kUavs = 1;
// Steps from Open to Opened.
constexpr int kWarmUp = 4;

// A host with a list of requests.
class ScriptedHost : public Host {
 public:
  std::optional<protocol::Request> next() override {
    if (requests.empty()) return std::nullopt;
    protocol::Request request = requests.front();
    requests.pop_front();
    return request;
  }
  void answer(const protocol::Reply& reply) override { replies.push_back(reply); }

  std::deque<protocol::Request> requests;
  std::vector<protocol::Reply> replies;
};

// A UAV and a ball, which both move by 1 m a step along x.
class FakeSimulation : public Simulation {
 public:
  void open(const protocol::Open&) override {}
  bool is_ready() override { return warm_up_steps-- == 0; }
  std::string description() const override { return "fake"; }
  void reset(std::uint64_t seed) override {
    x_m = 0.0;
    seeds.push_back(seed);
  }
  std::vector<uav::BodyState> bodies() const override {
    const uav::BodyState body{{x_m, 0, 1}, {}, {x_m, 0, 0}, {}};
    return {body, body};
  }
  void push(std::size_t uav, const uav::Vec3& force_W, const uav::Vec3&) override {
    EXPECT_LT(uav, kUavs);
    forces_W.push_back(force_W);
  }
  std::vector<TouchedPoint> touched_points() const override { return points; }
  protocol::Distances cast(const protocol::CastRays&) override { return {{x_m}}; }
  protocol::Picture render(const protocol::Render&) override {
    throw Error(ErrorCode::kSetup, "no canvas");
  }

  std::vector<TouchedPoint> points;
  int warm_up_steps = kWarmUp - 1;
  double x_m = 0.0;
  std::vector<std::uint64_t> seeds;
  std::vector<uav::Vec3> forces_W;
};

class SessionTest : public ::testing::Test {
 protected:
  static protocol::Open open() {
    protocol::Open open;
    open.step = 1ms;
    open.past_steps = 2;
    open.uavs.push_back({"uav1", "", {{0, 0, 1}, {}}, uav::hummingbird()});
    open.bodies.push_back({"ball", "link"});
    return open;
  }
  static protocol::Advance advance_to(Duration t) { return {SimTime(t), {}}; }

  // Steps the world until the host has nothing left to ask; returns how many steps it took.
  int run(std::deque<protocol::Request> requests) {
    host.requests = std::move(requests);
    int steps = 0;
    for (;; ++steps) {
      session.at_step_boundary();
      if (session.is_over()) return steps;
      if (!simulation.seeds.empty()) simulation.x_m += 1.0;
    }
  }
  const protocol::State& state(std::size_t reply) const {
    return std::get<protocol::State>(host.replies.at(reply));
  }

  ScriptedHost host;
  FakeSimulation simulation;
  Session session{host, simulation};
};

TEST_F(SessionTest, StepsUntilTheWorldIsReadyAndBeginsAtZero) {
  EXPECT_EQ(run({open()}), kWarmUp);
  const auto& opened = std::get<protocol::Opened>(host.replies.at(0));
  EXPECT_EQ(opened.description, "fake");
  EXPECT_EQ(opened.state.now, SimTime{});
  EXPECT_EQ(opened.state.bodies.size(), 2U);
  EXPECT_EQ(opened.state.motions.at(0).a_WB_W, uav::Vec3{});
  EXPECT_EQ(simulation.seeds, std::vector<std::uint64_t>{0});
  EXPECT_TRUE(simulation.forces_W.empty());
}

TEST_F(SessionTest, StepsExactlyToTheRequestedTime) {
  EXPECT_EQ(run({open(), advance_to(5ms), advance_to(5ms), advance_to(6ms)}), kWarmUp + 6);
  EXPECT_EQ(state(1).now, SimTime(5ms));
  EXPECT_EQ(state(1).bodies.at(0).p_WB.x, 5.0);
  EXPECT_EQ(state(2).bodies.at(0).p_WB.x, 5.0);
  EXPECT_EQ(state(3).bodies.at(0).p_WB.x, 6.0);
  EXPECT_EQ(simulation.forces_W.size(), 6U);
}

TEST_F(SessionTest, HasThePosesAtTheBeginningOfTheLastSteps) {
  run({open(), advance_to(5ms), advance_to(6ms), advance_to(6ms)});
  ASSERT_EQ(state(1).past.size(), 4U);
  EXPECT_EQ(state(1).past[0].p.x, 3.0);
  EXPECT_EQ(state(1).past[1].p.x, 3.0);
  EXPECT_EQ(state(1).past[2].p.x, 4.0);
  ASSERT_EQ(state(2).past.size(), 2U);
  EXPECT_EQ(state(2).past[0].p.x, 5.0);
  EXPECT_TRUE(state(3).past.empty());
}

TEST_F(SessionTest, HasTheMotionOfTheLastStepUntilAReset) {
  run({open(), advance_to(3ms), advance_to(3ms), protocol::Reset{7}, advance_to(2ms)});
  // From 2 to 3 m/s in a millisecond.
  EXPECT_DOUBLE_EQ(state(1).motions.at(0).a_WB_W.x, 1000.0);
  EXPECT_DOUBLE_EQ(state(2).motions.at(0).a_WB_W.x, 1000.0);
  EXPECT_DOUBLE_EQ(state(3).motions.at(0).a_WB_W.x, 0.0);
  EXPECT_EQ(state(3).now, SimTime{});
  EXPECT_EQ(state(4).now, SimTime(2ms));
  EXPECT_EQ(state(4).bodies.at(0).p_WB.x, 2.0);
  EXPECT_EQ(simulation.seeds, (std::vector<std::uint64_t>{0, 7}));
}

// The UAV is body 0 and the ball body 1. Both have the same velocity, which is 3 m/s at the
// beginning of the last step.
TEST_F(SessionTest, ReportsWhatTheUavTouchesInEachStep) {
  const TouchedPoint::Side uav{0, "uav1", 1}, ball{1, "ball", 2}, wall{std::nullopt, "wall", 3};
  simulation.points = {{{uav, wall}, {}, {-1, 0, 0}},
                       {{wall, uav}, {}, {-1, 0, 0}},
                       {{ball, uav}, {}, {-1, 0, 0}},
                       {{ball, wall}, {}, {1, 0, 0}}};
  run({open(), advance_to(3ms), advance_to(4ms), advance_to(4ms)});
  EXPECT_TRUE(std::get<protocol::Opened>(host.replies[0]).reports_contacts);
  EXPECT_TRUE(std::get<protocol::Opened>(host.replies[0]).takes_setpoints);
  EXPECT_EQ(state(1).touches.size(), 9U);
  EXPECT_TRUE(state(3).touches.empty());
  ASSERT_EQ(state(2).touches.size(), 3U);
  const std::pair<const char*, double> expected[] = {{"wall", 3.0}, {"wall", -3.0}, {"ball", 0.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    const protocol::Touch& touch = state(2).touches[i];
    EXPECT_EQ(touch.at, SimTime(3ms));
    EXPECT_EQ(touch.uav, 0U);
    EXPECT_EQ(touch.with, expected[i].first);
    EXPECT_EQ(touch.shape, i < 2 ? 3U : 2U);
    EXPECT_DOUBLE_EQ(touch.speed_m_s, expected[i].second);
  }
}

TEST_F(SessionTest, FliesTheUavAsItIsCommanded) {
  protocol::Advance climb = advance_to(50ms);
  climb.commands.push_back({0, {{0, 0, 1}, 0}});
  run({open(), advance_to(1ms), climb});
  EXPECT_NEAR(simulation.forces_W.front().z, uav::hummingbird().mass_kg * 9.81, 1e-6);
  EXPECT_NE(simulation.forces_W.back().z, simulation.forces_W.front().z);
}

TEST_F(SessionTest, AnswersRaysWithoutAStep) {
  EXPECT_EQ(run({open(), protocol::CastRays{}}), kWarmUp);
  EXPECT_EQ(std::get<protocol::Distances>(host.replies.at(1)).distance_m, std::vector<double>{0.0});
}

TEST_F(SessionTest, EndsWithTheReasonOfAFailure) {
  run({open(), protocol::Render{}, advance_to(5ms)});
  ASSERT_EQ(host.replies.size(), 2U);
  EXPECT_EQ(std::get<protocol::Failed>(host.replies[1]).message, "no canvas");
}

}  // namespace
}  // namespace tether::gazebo_plugin
