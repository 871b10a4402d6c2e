#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_remote_testing/fake_external_simulator.h>
#include <tether/sim_testing/busy_flight.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim::testing {
namespace {

using namespace protocol;
using namespace std::chrono_literals;
using ::testing::HasSubstr;

using Fault = FakeExternalSimulator::Fault;

SimTime at(Duration d) {
  return SimTime(d);
}

World file_world(World world) {
  world.file = "/worlds/test.sdf";
  return world;
}

/// A remote simulator and the external one at the other end.
struct Served {
  explicit Served(const World& world, Fault fault = {}, RemoteOptions options = {})
      : external(world, std::move(fault)),
        simulator(make_remote_simulator(world, external.take_connection(), std::move(options),
                                        [](const Warning&) {})) {}

  FakeExternalSimulator external;
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

// ---- contacts ----------------------------------------------------------------------------------

// Touches the box "wall" in every step of the second advance.
std::optional<Reply> touching(const Request& request, Reply reply, bool is_reported) {
  if (auto* opened = std::get_if<Opened>(&reply)) opened->reports_contacts = is_reported;
  const auto* advance = std::get_if<Advance>(&request);
  if (advance && advance->to == at(100ms)) {
    for (SimTime t = at(50ms); t < advance->to; t += 1ms)
      std::get<State>(reply).touches.push_back({t, 0, "wall", 7, 3.0});
  }
  return reply;
}

TEST(RemoteSimulator, MakesContactsOfTouches) {
  for (const bool is_reported : {true, false}) {
    Served served(file_world(test_world()), [=](const Request& request, Reply reply) {
      return touching(request, std::move(reply), is_reported);
    });
    EXPECT_EQ(served.simulator->reports_contacts(), is_reported);
    served.simulator->advance_to(at(250ms));
    const std::vector<Contact> expected{{at(50ms), 0, "wall", 3.0}};
    EXPECT_EQ(served.simulator->take_contacts(), is_reported ? expected : std::vector<Contact>{});
    EXPECT_NEAR(served.simulator->clearance(0)->distance_m, 0.95, 1e-6) << "measured by the host";
  }
}

// ---- requests ----------------------------------------------------------------------------------

TEST(RemoteSimulator, SplitsLongAdvancesAtSteps) {
  const auto ends = [](Duration step, Duration to) {
    World world = file_world(test_world());
    world.step = step;
    const Served served(world);
    served.simulator->advance_to(at(to));
    std::vector<SimTime> out;
    for (const Advance& advance : all<Advance>(served.external.requests()))
      out.push_back(advance.to);
    return out;
  };
  EXPECT_THAT(ends(1ms, 120ms), ::testing::ElementsAre(at(50ms), at(100ms), at(120ms)));
  EXPECT_THAT(ends(20ms, 100ms), ::testing::ElementsAre(at(40ms), at(80ms), at(100ms)));
}

TEST(RemoteSimulator, SendsTheLastCommandOfEachUavOnce) {
  const Served served(file_world(busy_world()));
  served.simulator->apply(1, uav::to_setpoint({{1.0, 0.0, 0.0}, 0.0}));
  served.simulator->apply(1, uav::to_setpoint({{2.0, 0.0, 0.0}, 0.0}));
  served.simulator->advance_to(at(60ms));
  const auto advances = all<Advance>(served.external.requests());
  ASSERT_EQ(advances.size(), 2u);
  ASSERT_EQ(advances[0].commands.size(), 1u);
  EXPECT_EQ(advances[0].commands[0].uav, 1u);
  EXPECT_EQ(advances[0].commands[0].command.velocity_H_m_s.x, 2.0);
  EXPECT_TRUE(advances[1].commands.empty());
  EXPECT_FALSE(served.simulator->takes_setpoints());
}

TEST(RemoteSimulator, SendsSetpointsToASimulatorThatTakesThem) {
  const auto takes_them = [](const Request&, Reply reply) -> std::optional<Reply> {
    if (auto* opened = std::get_if<Opened>(&reply)) opened->takes_setpoints = true;
    return reply;
  };
  const Served served(file_world(busy_world()), takes_them);
  EXPECT_TRUE(served.simulator->takes_setpoints());
  const uav::Setpoint there{.mask = uav::kPosition, .in_heading = false, .p_WB_m = {1, 2, 3}};
  served.simulator->apply(0, {});
  served.simulator->apply(1, there);
  served.simulator->advance_to(at(10ms));
  const auto advances = all<Advance>(served.external.requests());
  ASSERT_EQ(advances.size(), 1u);
  EXPECT_EQ(advances[0].commands.size(), 1u);
  ASSERT_EQ(advances[0].setpoints.size(), 1u);
  EXPECT_EQ(advances[0].setpoints[0].uav, 1u);
  EXPECT_EQ(advances[0].setpoints[0].setpoint, there);
}

// A file may write any character into a name.
TEST(RemoteSimulator, WarnsInPrintableLines) {
  World world = file_world(test_world());
  Visual egg;
  egg.name = "eg\ng";
  egg.geometry = EllipsoidGeometry{{0.1, 0.2, 0.3}};
  world.uavs[0].body.visuals = {egg};
  FakeExternalSimulator external(world);
  std::vector<std::string> warnings;
  make_remote_simulator(world, external.take_connection(), {},
                        [&](const Warning& warning) { warnings.push_back(to_line(warning)); });
  EXPECT_THAT(warnings, ::testing::ElementsAre(HasSubstr("'eg?g'"), HasSubstr("takes velocities")));
}

TEST(RemoteSimulator, KnowsTheStateWithoutARequest) {
  const Served served(file_world(test_world()));
  served.simulator->advance_to(at(10ms));
  const std::size_t asked = served.external.requests().size();
  Snapshot snapshot;
  served.simulator->capture(snapshot);
  served.simulator->ground_truth(0);
  served.simulator->advance_to(at(10ms));
  measure_now<uav::ImuSample>(*served.simulator, kImu);
  EXPECT_EQ(served.external.requests().size(), asked);
}

TEST(RemoteSimulator, MeasuresTheCapturedWorld) {
  const Served served(file_world(test_world()));
  served.simulator->apply(0, uav::to_setpoint({{0.0, 0.0, 1.0}, 0.0}));
  Snapshot snapshot;
  served.simulator->capture(snapshot);
  served.simulator->advance_to(at(1s));
  served.simulator->measure(snapshot, 0, kRange, 0);
  const auto casts = all<CastRays>(served.external.requests());
  ASSERT_EQ(casts.size(), 1u);
  EXPECT_EQ(casts[0].X_WB.at(0).p.z, 1.0);
  EXPECT_GT(served.simulator->ground_truth(0).body.p_WB.z, 1.1);
  EXPECT_EQ(casts[0].carrier, 0u);
}

TEST(RemoteSimulator, SendsTheSeedAndHasTheOtherEndsName) {
  const Served served(file_world(test_world()));
  served.simulator->reset(77);
  EXPECT_EQ(all<Reset>(served.external.requests()).at(0).seed, 77u);
  EXPECT_EQ(served.simulator->description(), "Fake 1.0");
  measure_now<uav::CameraSample>(*served.simulator, kCamera);
  EXPECT_EQ(served.simulator->description(), "Fake 1.0, boxes");
}

// ---- faults ------------------------------------------------------------------------------------

const std::string kFake = "the simulator Fake 1.0";

using Use = std::function<void(Simulator&)>;
void advance(Simulator& simulator) {
  simulator.advance_to(at(10ms));
}
void reset(Simulator& simulator) {
  simulator.reset(1);
}

/// The error of a simulator with this fault.
Error error_of(Fault fault, const Use& use, RemoteOptions options = {}) {
  return thrown_error(ErrorCode::kSetup, [&] {
    const Served served(file_world(test_world()), std::move(fault), std::move(options));
    use(*served.simulator);
  });
}

/// Spoils the answers to one kind of request.
template <class Asked, class Answer>
Fault spoil(std::function<void(Answer&)> how) {
  return [how](const Request& request, Reply reply) -> std::optional<Reply> {
    if (std::holds_alternative<Asked>(request)) how(std::get<Answer>(reply));
    return reply;
  };
}
/// Sends this in place of the answer to Advance; nothing: closes the connection.
Fault instead(const std::optional<Reply>& answer) {
  return [answer](const Request& request, Reply reply) -> std::optional<Reply> {
    return std::holds_alternative<Advance>(request) ? answer : reply;
  };
}

TEST(RemoteFaults, AnswersThatViolateTheProtocolAreRefused) {
  struct Case {
    Fault fault;
    Use use;
    std::string subject;
    std::string value;
  };
  const auto measure_range = [](Simulator& s) { measure_now<uav::RangeSample>(s, kRange); };
  const auto measure_image = [](Simulator& s) { measure_now<uav::CameraSample>(s, kCamera); };
  const Case cases[] = {
      {spoil<Advance, State>([](State& s) { s.now -= 1ms; }), advance, kFake, "9000000 ns"},
      {spoil<Advance, State>([](State& s) { s.bodies[0].v_WB.x = std::nan(""); }), advance, kFake,
       "State.bodies"},
      {spoil<Reset, State>([](State& s) { s.bodies[0].q_WB.w = 1.01; }), reset, kFake,
       "State.bodies"},
      {spoil<Advance, State>([](State& s) {
         s.bodies.clear();
         s.motions.clear();
       }),
       advance, kFake, "State.bodies"},
      {spoil<CastRays, Distances>([](Distances& d) { d.distance_m.clear(); }), measure_range, kFake,
       "Distances.distance_m"},
      {spoil<Render, Picture>([](Picture& p) {
         p.height_px -= 1;
         p.rgb.resize(p.rgb.size() - static_cast<std::size_t>(3 * p.width_px));
       }),
       measure_image, kFake, "160x119"},
      {instead(Distances{}), advance, kFake, "Distances"},
      {spoil<Open, Opened>([](Opened& o) { o.state.bodies[0].p_WB.x += 0.1; }), reset,
       "UAV 'alpha'", "(0.1 0 1)"},
      {spoil<Reset, State>([](State& s) { s.bodies[0].p_WB.x += 0.1; }), reset, "UAV 'alpha'",
       "(0.1 0 1)"},
      {spoil<Advance, State>([](State& s) { s.bodies[0].p_WB.x = 2e5; }), advance, "UAV 'alpha'",
       kFake},
  };
  for (const Case& given : cases) {
    const Error error = error_of(given.fault, given.use);
    EXPECT_EQ(error.subject(), given.subject) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(given.value));
  }
}

TEST(RemoteFaults, FailedIsReportedInOnePrintableLine) {
  EXPECT_EQ(error_of(instead(Failed{"joint\nloose"}), advance).what(),
            kFake + " failed: joint?loose");
  EXPECT_EQ(error_of(instead(Failed{" "}), advance).what(), kFake + " failed without a reason");
  const auto rename = spoil<Open, Opened>([](Opened& o) { o.description = "Fake\n\x1b[2J"; });
  const auto both = [&](const Request& request, Reply reply) {
    return instead(Failed{"loose"})(request, *rename(request, std::move(reply)));
  };
  EXPECT_EQ(error_of(both, advance).subject(), "the simulator Fake??[2J");
}

TEST(RemoteFaults, ALostConnectionIsOfTheSimulatorsNameOrAddress) {
  RemoteOptions options;
  options.address = "127.0.0.1:4711";
  EXPECT_EQ(error_of(instead(std::nullopt), advance, options).subject(), kFake);
  const auto at_once = [](const Request&, Reply) { return std::optional<Reply>(); };
  EXPECT_EQ(error_of(at_once, advance, options).subject(), "the simulator at 127.0.0.1:4711");
  options.why_give_up = [] { return "the simulator was ended by signal 9"; };
  EXPECT_STREQ(error_of(instead(std::nullopt), advance, options).what(),
               "the simulator was ended by signal 9");
}

/// Does not answer Advance until it is released.
class Silent {
 public:
  void release() {
    released_ = true;
    released_.notify_all();
  }
  Fault fault() {
    return [this](const Request& request, Reply reply) -> std::optional<Reply> {
      if (std::holds_alternative<Advance>(request)) released_.wait(false);
      return reply;
    };
  }

 private:
  std::atomic<bool> released_ = false;
};

/// The error of an advance that is not answered.
Error error_of_silence(const RemoteOptions& options) {
  Silent silent;
  const Served served(file_world(test_world()), silent.fault(), options);
  Error error = thrown_error(ErrorCode::kSetup, [&] { advance(*served.simulator); });
  silent.release();
  return error;
}

TEST(RemoteFaults, SilenceEndsAtItsLimit) {
  RemoteOptions options;
  options.answer_limit = 150ms;
  const Error error = error_of_silence(options);
  EXPECT_EQ(error.subject(), kFake);
  EXPECT_THAT(error.what(), HasSubstr("0.150 s"));
}

TEST(RemoteFaults, SilenceEndsWithAReasonToGiveUp) {
  RemoteOptions options;
  options.answer_limit = 1h;
  int asked = 0;
  options.why_give_up = [&asked]() -> std::optional<std::string> {
    if (++asked < 3) return std::nullopt;
    return "the run was interrupted";
  };
  EXPECT_STREQ(error_of_silence(options).what(), "the run was interrupted");
  EXPECT_EQ(asked, 3);
}

TEST(RemoteFaults, AWorldThatCannotBeSentIsABadFile) {
  World world = file_world(test_world());
  world.uavs[0].name = std::string(600, 'x');
  EXPECT_THAT(bad_file_error([&] { Served served(world); }).what(), HasSubstr("512 bytes"));
}

}  // namespace
}  // namespace tether::sim::testing
