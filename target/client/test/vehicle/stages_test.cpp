#include "clocks/fake_wall_timer.h"
#include "scripted_coordinator.h"
#include "vehicle/simulated_vehicle_impl.h"

#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/client_testing/manual_time_source.h>

// Stages of a serial vehicle: what it computed between two calls is in the second one's request.
namespace tether::client {
namespace {

using namespace std::chrono_literals;
using client_testing::ManualTimeSource;
using Times = std::vector<link::StageTime>;

std::unique_ptr<SimulatedVehicle> fly(ScriptedCoordinator& coordinator, link::Welcome welcome,
                                      std::unique_ptr<TimeSource> source) {
  return std::make_unique<SimulatedVehicle>(coordinator.connect(), std::move(welcome),
                                            std::move(source), std::make_unique<FakeWallTimer>(),
                                            Duration::zero());
}

TEST(Stages, AreInTheNextRequest) {
  ScriptedCoordinator coordinator(welcome_with_sensors());
  ManualTimeSource source(computer::ClockKind::kCpu);
  const auto vehicle =
      fly(coordinator, welcome_with_sensors(), std::make_unique<ManualTimeSource>(source));
  source.advance(1ms);
  ASSERT_TRUE(vehicle->sleep_for(2ms).ok());
  {
    const Stage stage(*vehicle, "detect");
    source.advance(5ms);
  }
  source.advance(2ms);
  ASSERT_TRUE(vehicle->command_velocity({}).ok());
  const auto requests = coordinator.requests();
  ASSERT_EQ(requests.size(), 2u);
  EXPECT_EQ(requests[0].stages, (Times{{"start to sleep", 1ms}}));
  EXPECT_EQ(requests[1].stages, (Times{{"sleep to command", 2ms}, {"detect", 5ms}}));
  EXPECT_EQ(vehicle->end_stage().failure().kind, Failure::Kind::kInvalid);
}

TEST(Stages, TakeNoTimeFromAScriptedClock) {
  ScriptedCoordinator coordinator(welcome_with_sensors());
  const auto vehicle = fly(coordinator, welcome_with_sensors(), make_scripted_source(2ms));
  { const Stage stage(*vehicle, "detect"); }
  ASSERT_TRUE(vehicle->command_velocity({}).ok());
  const auto requests = coordinator.requests();
  EXPECT_EQ(requests.at(0).issued_at, requests[0].stages.at(0).computing + ExecTime{});
  EXPECT_EQ(
      requests[0].stages,
      (Times{{"start to command", requests[0].issued_at.time_since_epoch()}, {"detect", 0ms}}));
}

TEST(Stages, AreNotMeasuredInFreeRunning) {
  link::Welcome welcome = welcome_with_sensors();
  welcome.free_running = true;
  ScriptedCoordinator coordinator(welcome);
  const auto vehicle =
      fly(coordinator, welcome, std::make_unique<ManualTimeSource>(computer::ClockKind::kCpu));
  { const Stage stage(*vehicle, "detect"); }
  ASSERT_TRUE(vehicle->command_velocity({}).ok());
  EXPECT_TRUE(coordinator.requests().at(0).stages.empty());
}

/// Calls, stages, annotations and computing in an order drawn at random. Whatever it is, the parts
/// add up to what ET grew by (docs/design.md section 2, rule 5), and with a replayed clock ET grows
/// by what was given for those parts.
class RandomFlight : public testing::TestWithParam<computer::ClockKind> {
 protected:
  static link::StageTime given(const std::string& stage, std::uint64_t sequence) {
    const RandomKey key{7, random_stream("", stage, ""), sequence};
    return {stage, Duration(KeyedRandom(key).bits() % 1'000'000)};
  }
  static Times given_after(std::uint64_t sequence) {
    Times times;
    for (const char* from : {"start", "command", "sleep", "camera", "down"})
      for (const char* to : {"command", "sleep", "down"})
        times.push_back(given(link::stage_between(from, to), sequence));
    for (const char* stage : {"a", "b", "c"}) times.push_back(given(stage, sequence));
    return times;
  }
};

TEST_P(RandomFlight, PartsAddUpToWhatWasComputed) {
  const bool is_replayed = GetParam() == computer::ClockKind::kReplayed;
  link::Welcome welcome = welcome_with_sensors();
  welcome.start = ExecTime(3s);
  welcome.computing = given_after(0);
  ScriptedCoordinator coordinator(welcome, [](const link::Request& r) {
    const ExecTime until =
        r.issued_at + Duration(r.sequence % 3 == 0 ? 0 : 777 * static_cast<int>(r.sequence));
    link::Reply reply{r.sequence, until, std::nullopt, given_after(r.sequence)};
    if (std::holds_alternative<link::ReadSensor>(r.body))
      reply.sample = uav::RangeSample{SimTime{}, 1, 1.0};
    return std::vector<link::Message>{reply};
  });
  ManualTimeSource measured(computer::ClockKind::kCpu);
  std::unique_ptr<TimeSource> source = std::make_unique<ManualTimeSource>(measured);
  if (is_replayed) source = make_replayed_source();
  const auto vehicle = fly(coordinator, welcome, std::move(source));
  KeyedRandom random({11, static_cast<std::uint64_t>(GetParam()), 0});
  std::size_t open = 0;
  ExecTime before = vehicle->now();
  for (int i = 0; i < 600; ++i) {
    const std::uint32_t step = random.bits() % 8;
    measured.advance(Duration(random.bits() % 100'000));
    if (step <= 1 && open < 5) {
      const std::string stage(1, static_cast<char>('a' + random.bits() % 3));
      ASSERT_TRUE(vehicle->begin_stage(stage).ok());
      ++open;
    } else if (step == 2 && open > 0) {
      ASSERT_TRUE(vehicle->end_stage().ok());
      --open;
    } else if (step == 3) {
      ASSERT_TRUE(vehicle->annotate("roi", "{}").ok());
    } else if (step == 4) {
      ASSERT_TRUE(vehicle->command_velocity({}).ok());
    } else if (step == 5) {
      ASSERT_TRUE(vehicle->sleep_for(Duration(random.bits() % 1000)).ok());
    } else if (step == 6) {
      ASSERT_TRUE(vehicle->read<uav::RangeSample>("down", Read::kNext).ok());
    }
    EXPECT_GE(vehicle->now(), before);
    before = vehicle->now();
  }
  const auto requests = coordinator.requests();
  ASSERT_GT(requests.size(), 100u);
  ExecTime resumed = welcome.start;
  for (const link::Request& request : requests) {
    Duration sum{0};
    for (const link::StageTime& time : request.stages) {
      sum += time.computing;
      EXPECT_TRUE(!is_replayed || time == given(time.stage, request.sequence - 1));
    }
    EXPECT_EQ(request.issued_at, resumed + sum) << request.sequence;
    resumed = request.issued_at +
              Duration(request.sequence % 3 == 0 ? 0 : 777 * static_cast<int>(request.sequence));
  }
}

INSTANTIATE_TEST_SUITE_P(Clocks, RandomFlight,
                         testing::Values(computer::ClockKind::kCpu,
                                         computer::ClockKind::kReplayed));

}  // namespace
}  // namespace tether::client
