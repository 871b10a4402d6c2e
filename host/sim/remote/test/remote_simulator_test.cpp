#include <atomic>
#include <limits>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_remote_testing/fake_outside.h>
#include <tether/sim_testing/busy_flight.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim::testing {
namespace {

using namespace protocol;
using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

SimTime at(Duration d) {
  return SimTime(d);
}

World file_world(World world) {
  world.file = "/worlds/test.sdf";
  return world;
}

/// A remote simulator and the one at the other end.
struct Served {
  explicit Served(const World& world, FakeOutside::Fault fault = {}, RemoteOptions options = {})
      : outside(world, std::move(fault)),
        simulator(make_remote_simulator(world, outside.take_connection(), std::move(options),
                                        [](const std::string&) {})) {}

  FakeOutside outside;
  std::unique_ptr<Simulator> simulator;
};

template <class Message>
std::vector<Message> all(const std::vector<Request>& requests) {
  std::vector<Message> out;
  for (const Request& request : requests) {
    if (const auto* message = std::get_if<Message>(&request)) out.push_back(*message);
  }
  return out;
}

// ---- what goes over the wire
// -------------------------------------------------------------------

TEST(RemoteSimulator, CutsLongAdvancesToTheStep) {
  const Served served(file_world(test_world()));
  served.simulator->advance_to(at(120ms));
  std::vector<SimTime> ends;
  for (const Advance& advance : all<Advance>(served.outside.requests())) ends.push_back(advance.to);
  EXPECT_THAT(ends, ::testing::ElementsAre(at(50ms), at(100ms), at(120ms)));
}

TEST(RemoteSimulator, AdvancesByWholeStepsWhereTheyAreLong) {
  World world = file_world(test_world());
  world.step = 20ms;
  const Served served(world);
  served.simulator->advance_to(at(100ms));
  std::vector<SimTime> ends;
  for (const Advance& advance : all<Advance>(served.outside.requests())) ends.push_back(advance.to);
  EXPECT_THAT(ends, ::testing::ElementsAre(at(40ms), at(80ms), at(100ms)));
}

TEST(RemoteSimulator, SendsTheLastCommandOfEachUavOnce) {
  const Served served(file_world(busy_world()));
  served.simulator->apply(1, {{1.0, 0.0, 0.0}, 0.0});
  served.simulator->apply(1, {{2.0, 0.0, 0.0}, 0.0});
  served.simulator->advance_to(at(60ms));
  const auto advances = all<Advance>(served.outside.requests());
  ASSERT_EQ(advances.size(), 2u);
  ASSERT_EQ(advances[0].commands.size(), 1u);
  EXPECT_EQ(advances[0].commands[0].uav, 1u);
  EXPECT_EQ(advances[0].commands[0].command.velocity_H_m_s.x, 2.0);
  EXPECT_TRUE(advances[1].commands.empty());
}

// A file may write any character into a name.
TEST(RemoteSimulator, WarnsInPrintableLines) {
  World world = file_world(test_world());
  Visual egg;
  egg.name = "eg\ng";
  egg.geometry = EllipsoidGeometry{{0.1, 0.2, 0.3}};
  world.uavs[0].body.visuals = {egg};
  FakeOutside outside(world, {});
  std::vector<std::string> warnings;
  make_remote_simulator(world, outside.take_connection(), {},
                        [&](const std::string& line) { warnings.push_back(line); });
  EXPECT_THAT(warnings, ::testing::ElementsAre(HasSubstr("'eg?g'")));
}

TEST(RemoteSimulator, KnowsTheStateWithoutAsking) {
  const Served served(file_world(test_world()));
  served.simulator->advance_to(at(10ms));
  const std::size_t asked = served.outside.requests().size();
  Snapshot snapshot;
  served.simulator->capture(snapshot);
  served.simulator->ground_truth(0);
  served.simulator->advance_to(at(10ms));
  measure_now<uav::ImuSample>(*served.simulator, kImu);
  EXPECT_EQ(served.outside.requests().size(), asked);
}

TEST(RemoteSimulator, MeasuresTheWorldAsItWasCaptured) {
  const Served served(file_world(test_world()));
  served.simulator->apply(0, {{0.0, 0.0, 1.0}, 0.0});
  Snapshot snapshot;
  served.simulator->capture(snapshot);
  served.simulator->advance_to(at(1s));
  served.simulator->measure(snapshot, 0, kRange, 0);
  const auto casts = all<CastRays>(served.outside.requests());
  ASSERT_EQ(casts.size(), 1u);
  EXPECT_EQ(casts[0].X_WB.at(0).p.z, 1.0);
  EXPECT_GT(served.simulator->ground_truth(0).body.p_WB.z, 1.1);
  EXPECT_EQ(casts[0].carrier, 0u);
}

TEST(RemoteSimulator, HasItsNameFromTheOtherEnd) {
  const Served served(file_world(test_world()));
  EXPECT_EQ(served.simulator->description(), "Fake 1.0");
  measure_now<uav::CameraSample>(*served.simulator, kCamera);
  EXPECT_EQ(served.simulator->description(), "Fake 1.0, boxes");
}

TEST(RemoteSimulator, TellsTheSeed) {
  const Served served(file_world(test_world()));
  served.simulator->reset(77);
  EXPECT_EQ(all<Reset>(served.outside.requests()).at(0).seed, 77u);
}

// ---- faults
// ------------------------------------------------------------------------------------

/// What `use` throws, of a simulator with this fault.
std::string error_of(FakeOutside::Fault fault, const std::function<void(Simulator&)>& use,
                     RemoteOptions options = {}) {
  try {
    const Served served(file_world(test_world()), std::move(fault), std::move(options));
    use(*served.simulator);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kSetup) << error.what();
    return error.what();
  }
  return {};
}

/// Spoils the answers to one kind of request.
template <class Asked, class Answer>
FakeOutside::Fault spoil(std::function<void(Answer&)> how) {
  return [how](const Request& request, Reply reply) -> std::optional<Reply> {
    if (std::holds_alternative<Asked>(request)) how(std::get<Answer>(reply));
    return reply;
  };
}

void advance(Simulator& simulator) {
  simulator.advance_to(at(10ms));
}

TEST(RemoteFaults, AnotherTimeThanAskedFor) {
  const auto fault = spoil<Advance, State>([](State& state) { state.now -= 1ms; });
  EXPECT_THAT(error_of(fault, advance),
              AllOf(HasSubstr("Fake 1.0"), HasSubstr("State.now is 9000000 ns"),
                    HasSubstr("asked for 10000000 ns")));
}

TEST(RemoteFaults, NumbersThatAreNone) {
  const auto fault = spoil<Advance, State>(
      [](State& state) { state.bodies[0].v_WB.x = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_THAT(error_of(fault, advance), AllOf(HasSubstr("Fake 1.0"), HasSubstr("State.bodies")));
}

TEST(RemoteFaults, AnAttitudeThatIsNone) {
  const auto fault = spoil<Reset, State>([](State& state) { state.bodies[0].q_WB.w = 1.01; });
  EXPECT_THAT(error_of(fault, [](Simulator& simulator) { simulator.reset(1); }),
              HasSubstr("State.bodies is not of unit length"));
}

TEST(RemoteFaults, TooFewBodies) {
  const auto fault = spoil<Advance, State>([](State& state) {
    state.bodies.clear();
    state.motions.clear();
  });
  EXPECT_THAT(error_of(fault, advance), HasSubstr("State.bodies has 0 entries instead of 1"));
}

TEST(RemoteFaults, TooFewDistances) {
  const auto fault =
      spoil<CastRays, Distances>([](Distances& distances) { distances.distance_m.clear(); });
  EXPECT_THAT(error_of(fault, [](Simulator& s) { measure_now<uav::RangeSample>(s, kRange); }),
              HasSubstr("Distances.distance_m has 0 entries instead of 1"));
}

TEST(RemoteFaults, APictureOfAnotherSize) {
  const auto fault = spoil<Render, Picture>([](Picture& picture) {
    picture.height_px -= 1;
    picture.rgb.resize(picture.rgb.size() - static_cast<std::size_t>(3 * picture.width_px));
  });
  EXPECT_THAT(error_of(fault, [](Simulator& s) { measure_now<uav::CameraSample>(s, kCamera); }),
              HasSubstr("160x119 pixels instead of 160x120"));
}

TEST(RemoteFaults, AnAnswerToSomethingElse) {
  const auto fault = [](const Request&, Reply) { return Reply(Distances{}); };
  EXPECT_THAT(error_of(fault, advance), HasSubstr("Distances answers no CastRays"));
}

TEST(RemoteFaults, Failure) {
  const auto fault = [](const Request& request, Reply reply) -> std::optional<Reply> {
    if (std::holds_alternative<Advance>(request)) return Failed{"the joints came loose"};
    return reply;
  };
  EXPECT_EQ(error_of(fault, advance), "the simulator Fake 1.0 failed: the joints came loose");
}

TEST(RemoteFaults, FailureWithoutAReason) {
  const auto fault = [](const Request& request, Reply reply) -> std::optional<Reply> {
    if (std::holds_alternative<Advance>(request)) return Failed{" "};
    return reply;
  };
  EXPECT_EQ(error_of(fault, advance), "the simulator Fake 1.0 failed without a reason");
}

TEST(RemoteFaults, TextsThatSteerATerminal) {
  const auto fault = [](const Request& request, Reply reply) -> std::optional<Reply> {
    if (auto* opened = std::get_if<Opened>(&reply)) opened->description = "Fake\n\x1b[2J";
    if (std::holds_alternative<Advance>(request)) return Failed{"one\ntwo"};
    return reply;
  };
  EXPECT_EQ(error_of(fault, advance), "the simulator Fake??[2J failed: one?two");
}

TEST(RemoteFaults, AnotherStartThanTheWorldHas) {
  const auto move = [](State& state) { state.bodies[0].p_WB.x += 0.1; };
  const auto nothing = [](Simulator&) {};
  EXPECT_THAT(error_of(spoil<Open, Opened>([&](Opened& opened) { move(opened.state); }), nothing),
              AllOf(HasSubstr("Fake 1.0"), HasSubstr("begins at")));
  EXPECT_THAT(error_of(spoil<Reset, State>(move), [](Simulator& s) { s.reset(1); }),
              HasSubstr("begins at"));
}

TEST(RemoteFaults, AStateThatIsOutOfReach) {
  const auto fault = spoil<Advance, State>([](State& state) { state.bodies[0].p_WB.x = 2e5; });
  EXPECT_THAT(error_of(fault, advance), AllOf(HasSubstr("Fake 1.0"), HasSubstr("beyond 1e5 m")));
}

/// Hangs up in the place of its answer to Advance.
std::optional<Reply> hang_up(const Request& request, Reply reply) {
  if (std::holds_alternative<Advance>(request)) return std::nullopt;
  return reply;
}

TEST(RemoteFaults, HangingUp) {
  EXPECT_THAT(error_of(hang_up, advance), HasSubstr("the simulator Fake 1.0 is lost: "));
}

TEST(RemoteFaults, BeforeItHasANameAreOfItsAddress) {
  RemoteOptions options;
  options.address = "127.0.0.1:4711";
  const auto hang_up_at_once = [](const Request&, Reply) { return std::optional<Reply>(); };
  EXPECT_THAT(error_of(hang_up_at_once, advance, options),
              HasSubstr("the simulator at 127.0.0.1:4711 is lost: "));
  EXPECT_THAT(error_of(hang_up, advance, options), HasSubstr("the simulator Fake 1.0 is lost: "));
}

TEST(RemoteFaults, WhoStartedItKnowsBetterWhyItIsGone) {
  RemoteOptions options;
  options.why_give_up = [] { return "the simulator was ended by signal 9"; };
  EXPECT_EQ(error_of(hang_up, advance, options), "the simulator was ended by signal 9");
}

/// Keeps its answer to Advance to itself until it is let go.
class Silent {
 public:
  FakeOutside::Fault fault() {
    return [this](const Request& request, Reply reply) -> std::optional<Reply> {
      if (std::holds_alternative<Advance>(request)) go_.wait(false);
      return reply;
    };
  }
  void let_go() {
    go_ = true;
    go_.notify_all();
  }

 private:
  std::atomic<bool> go_ = false;
};

TEST(RemoteFaults, Silence) {
  Silent silent;
  RemoteOptions options;
  options.answer_limit = 150ms;
  Served served(file_world(test_world()), silent.fault(), options);
  try {
    advance(*served.simulator);
    ADD_FAILURE() << "not given up";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kSetup);
    EXPECT_THAT(error.what(), HasSubstr("the simulator Fake 1.0 has not answered for 0.150 s"));
  }
  silent.let_go();
}

TEST(RemoteFaults, GivesUpWhenToldTo) {
  Silent silent;
  RemoteOptions options;
  options.answer_limit = 1h;
  int asked = 0;
  options.why_give_up = [&asked]() -> std::optional<std::string> {
    if (++asked < 3) return std::nullopt;
    return "the run was interrupted";
  };
  Served served(file_world(test_world()), silent.fault(), options);
  try {
    advance(*served.simulator);
    ADD_FAILURE() << "not given up";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the run was interrupted");
  }
  EXPECT_EQ(asked, 3);
  silent.let_go();
}

TEST(RemoteFaults, AWorldThatCannotBeTold) {
  World world = file_world(test_world());
  world.uavs[0].name = std::string(600, 'x');
  try {
    Served served(world);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    EXPECT_THAT(error.what(), HasSubstr("name is longer than 512 bytes"));
  }
}

}  // namespace
}  // namespace tether::sim::testing
