#include "clocks/fake_wall_timer.h"
#include "scripted_coordinator.h"
#include "vehicle/simulated_vehicle_impl.h"

#include <chrono>
#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <tether/base/random.h>
#include <tether/client_testing/manual_time_source.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;
using client_testing::ManualTimeSource;
using link::Reply;
using link::Request;

const uav::CameraSample kImage{from_ns<SimTime>(0), 3, 4, 2, std::vector<std::uint8_t>(24, 5)};

std::vector<link::Message> one(link::Message message) {
  return {std::move(message)};
}

class SimulatedVehicleTest : public testing::Test {
 protected:
  void start(ScriptedCoordinator::Answer answer = ScriptedCoordinator::grant_at_once,
             bool free_running = false, bool own_stamps = false) {
    link::Welcome welcome = welcome_with_sensors();
    welcome.catalogue.sensors[0].own_stamps = own_stamps;
    for (const std::size_t twin : {0u, 2u}) {
      welcome.catalogue.sensors.push_back(welcome.catalogue.sensors[twin]);
      welcome.catalogue.sensors.back().name += " 2";
    }
    welcome.free_running = free_running;
    coordinator_ = std::make_unique<ScriptedCoordinator>(welcome, std::move(answer));
    auto wall = std::make_unique<FakeWallTimer>();
    wall_ = wall.get();
    vehicle_ = std::make_unique<SimulatedVehicle>(coordinator_->connect(), welcome,
                                                  std::make_unique<ManualTimeSource>(source_),
                                                  std::move(wall), Duration::zero());
  }
  /// `result` is a Result or a Status.
  template <class T>
  static void expect_failure(const T& result, Failure::Kind kind, const std::string& value = "") {
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.failure().kind, kind);
    EXPECT_NE(result.failure().message.find(value), std::string::npos) << result.failure().message;
  }

  ManualTimeSource source_{computer::ClockKind::kCpu, 4.0};
  std::unique_ptr<ScriptedCoordinator> coordinator_;
  std::unique_ptr<SimulatedVehicle> vehicle_;
  FakeWallTimer* wall_ = nullptr;
};

TEST_F(SimulatedVehicleTest, ReadsEachSensorByItsIndex) {
  start([](const Request& r) {
    const auto& read = std::get<link::ReadSensor>(r.body);
    uav::Sample sample = kImage;
    if (read.sensor == 1) sample = uav::ImuSample{SimTime{}, 1, {1, 2, 3}, {}, {}};
    if (read.sensor == 2) sample = uav::RangeSample{SimTime{}, 2, 1.5};
    return one(Reply{r.sequence, r.issued_at, sample});
  });
  EXPECT_EQ(vehicle_->read<uav::CameraSample>("camera", Read::kNext)->rgb, kImage.rgb);
  EXPECT_EQ(vehicle_->read<uav::ImuSample>("imu", Read::kNext)->angular_velocity_rad_s,
            (uav::Vec3{1, 2, 3}));
  EXPECT_EQ(vehicle_->read<uav::RangeSample>("down", Read::kLatest)->range_m, 1.5);
  const auto requests = coordinator_->requests();
  ASSERT_EQ(requests.size(), 3u);
  EXPECT_FALSE(std::get<link::ReadSensor>(requests[1].body).latest);
  EXPECT_TRUE(std::get<link::ReadSensor>(requests[2].body).latest);
  EXPECT_EQ(requests[2].sequence, 3u);
}

TEST_F(SimulatedVehicleTest, ReadsWhatIsAvailable) {
  start([](const Request& r) {
    const bool first = r.sequence == 1;
    Reply reply{r.sequence, r.issued_at, std::nullopt};
    if (!first) reply.sample = uav::RangeSample{SimTime{}, 2, 1.5};
    return one(reply);
  });
  expect_failure(vehicle_->read<uav::RangeSample>("down", Read::kIfAvailable),
                 Failure::Kind::kNothingYet);
  EXPECT_EQ(vehicle_->read<uav::RangeSample>("down", Read::kIfAvailable)->range_m, 1.5);
  EXPECT_TRUE(std::get<link::ReadSensor>(coordinator_->requests()[0].body).only_if_available);
  expect_failure(vehicle_->read<uav::ImuSample>("imu", Read::kIfAvailable),
                 Failure::Kind::kInvalid);
  EXPECT_FALSE(vehicle_->is_concurrent());
}

// "down" is periodic, and "imu" measures on demand.
TEST_F(SimulatedVehicleTest, ReadsFromAQueueWhereOneIsSet) {
  start([](const Request& r) {
    Reply reply{r.sequence, r.issued_at, std::nullopt};
    if (r.sequence < 4) reply.sample = uav::RangeSample{SimTime{}, r.sequence, 1.5};
    return one(reply);
  });
  for (const std::uint32_t depth : {0u, 4097u})
    expect_failure(vehicle_->set_queue("down", depth), Failure::Kind::kInvalid, "1 to 4096");
  expect_failure(vehicle_->set_queue("down", static_cast<std::uint32_t>(-3)),
                 Failure::Kind::kInvalid, "a queue of -3");
  expect_failure(vehicle_->set_queue("imu", 5), Failure::Kind::kInvalid, "on demand");
  expect_failure(vehicle_->set_queue("nose", 5), Failure::Kind::kInvalid, "no sensor");
  ASSERT_TRUE(vehicle_->set_queue("down", 5).ok());
  const auto all = read_all<uav::RangeSample>(*vehicle_, "down");
  ASSERT_TRUE(all) << all.failure().message;
  ASSERT_EQ(all->size(), 3u);
  EXPECT_EQ(all->back().index, 3u);
  EXPECT_EQ(vehicle_->queue_of("down"), 5u);
  EXPECT_EQ(vehicle_->queue_of("nose"), 1u);
  for (const Request& request : coordinator_->requests())
    EXPECT_EQ(std::get<link::ReadSensor>(request.body).queue, 5u);
}

// The second sensor is one measurement ahead, then both are at 2 ms.
TEST_F(SimulatedVehicleTest, ReadsSensorsOfOneInstantTogether) {
  start([](const Request& r) {
    uav::RangeSample sample{from_ns<SimTime>(r.sequence == 1 ? 1 : 2), r.sequence, 1.5};
    return one(Reply{r.sequence, from_ns<ExecTime>(9), sample});
  });
  const auto both = read_together<uav::RangeSample>(*vehicle_, {"down", "down 2"});
  ASSERT_TRUE(both) << both.failure().message;
  EXPECT_EQ((*both)[0].sampled_at, (*both)[1].sampled_at);
  EXPECT_EQ(coordinator_->requests().size(), 3u);
  expect_failure(read_together<uav::RangeSample>(*vehicle_, {"down", "down 2", "down"}),
                 Failure::Kind::kInvalid, "'down' is named twice");
  EXPECT_EQ(coordinator_->requests().size(), 3u);
}

// A sensor that is faster than the program reads would never be empty.
TEST_F(SimulatedVehicleTest, ReadsAtMostTheQueueWhateverTheStampsSay) {
  start(
      [](const Request& r) {
        uav::CameraSample sample = kImage;
        sample.sampled_at = SimTime(std::chrono::seconds(9));
        return one(Reply{r.sequence, r.issued_at, sample});
      },
      false, true);
  ASSERT_TRUE(vehicle_->set_queue("camera", 3).ok());
  EXPECT_EQ(read_all<uav::CameraSample>(*vehicle_, "camera")->size(), 3u);
}

// The stamps of the first driver are 8 ms late, and image 0 of the second was lost.
TEST_F(SimulatedVehicleTest, PairsTheNearestStampsOfDrivers) {
  start(
      [](const Request& r) {
        const std::int64_t stamps_ms[] = {8, 33, 41};
        uav::CameraSample sample = kImage;
        sample.sampled_at = SimTime(std::chrono::milliseconds(stamps_ms[r.sequence - 1]));
        return one(Reply{r.sequence, from_ns<ExecTime>(200'000'000), sample});
      },
      false, true);
  const auto both = read_together<uav::CameraSample>(*vehicle_, {"camera", "camera 2"});
  ASSERT_TRUE(both) << both.failure().message;
  EXPECT_EQ(to_ns((*both)[0].sampled_at) - to_ns((*both)[1].sampled_at), 8'000'000);
  EXPECT_EQ(coordinator_->requests().size(), 3u);
  EXPECT_EQ(most_apart(vehicle_->catalogue(), {"down", "imu"}), Duration(0));
}

TEST_F(SimulatedVehicleTest, SendsNothingForWrongArguments) {
  start();
  for (const std::string name : {"nose", "imu"}) {
    expect_failure(vehicle_->read<uav::CameraSample>(name, Read::kNext), Failure::Kind::kInvalid,
                   name);
  }
  expect_failure(vehicle_->read<uav::RangeSample>("x", Read::kNext), Failure::Kind::kInvalid,
                 "camera");
  expect_failure(vehicle_->command_velocity({{1e9, 0, 0}, 0}), Failure::Kind::kInvalid);
  expect_failure(vehicle_->annotate("roi", "nonsense"), Failure::Kind::kInvalid);
  EXPECT_TRUE(coordinator_->requests().empty());
  const uav::VelocityCommand command{{1, -2, 0.5}, 0.25};
  ASSERT_TRUE(vehicle_->command_velocity(command).ok());
  EXPECT_EQ(coordinator_->requests().at(0).sequence, 1u);
  EXPECT_EQ(std::get<link::SetVelocity>(coordinator_->requests().at(0).body).command, command);
}

TEST_F(SimulatedVehicleTest, SetpointsAreCheckedAgainstTheCatalogue) {
  start();
  const uav::Setpoint here{.mask = uav::kPosition, .in_heading = false};
  const bool any = vehicle_->catalogue().limits.rotors > 0;
  ASSERT_FALSE(any);
  expect_failure(vehicle_->command(here), Failure::Kind::kInvalid, "only takes velocities");
  expect_failure(vehicle_->command({.mask = 0}), Failure::Kind::kInvalid, "mask 0");
  expect_failure(vehicle_->follow({}), Failure::Kind::kInvalid, "no set-points");
  EXPECT_TRUE(coordinator_->requests().empty());
  ASSERT_TRUE(vehicle_->command({.velocity_m_s = {1, 0, 0}}).ok());
  EXPECT_TRUE(std::holds_alternative<link::SetVelocity>(coordinator_->requests().at(0).body));
  const std::vector<uav::TimedSetpoint> two = {{Duration(0), {.yaw_rad = 9}},
                                               {Duration(5), {.velocity_m_s = {1, 0, 0}}}};
  ASSERT_TRUE(vehicle_->follow(two).ok());
  const auto sent = std::get<link::SetTrajectory>(coordinator_->requests().at(1).body).setpoints;
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].setpoint, uav::Setpoint{}) << "ignored fields are not sent";
  EXPECT_EQ(sent[1], two[1]);
}

/// Rule 5: the next stamp is the last reply's plus what was computed since, to the
/// nanosecond.
TEST_F(SimulatedVehicleTest, StampsGrowOnlyByComputing) {
  start([](const Request& r) {
    KeyedRandom random({5, 1, r.sequence});
    return one(Reply{r.sequence, r.issued_at + Duration(random.bits() % 40'000'000), {}});
  });
  ExecTime expected{};
  for (std::uint64_t i = 1; i <= 500; ++i) {
    KeyedRandom random({5, 2, i});
    const Duration computed(random.bits() % 30'000'000);
    source_.advance(computed);
    ASSERT_EQ(vehicle_->now(), expected + computed);
    ASSERT_TRUE((i % 3 == 0 ? vehicle_->sleep_for(1ms) : vehicle_->command_velocity({})).ok());
    ASSERT_EQ(coordinator_->requests().back().issued_at, expected + computed);
    expected += computed + Duration(KeyedRandom({5, 1, i}).bits() % 40'000'000);
    ASSERT_EQ(vehicle_->now(), expected);
  }
}

namespace {
ManualTimeSource* g_source = nullptr;
}

// A handler that runs while the clock is stopped would compute in no time.
TEST_F(SimulatedVehicleTest, ChargesHandlersOfSignalsThatArriveDuringACall) {
  g_source = &source_;
  struct sigaction action {};
  action.sa_handler = [](int) { g_source->advance(5ms); };
  struct sigaction before {};
  ::sigaction(SIGUSR1, &action, &before);
  const pthread_t caller = ::pthread_self();
  start([caller](const Request& r) {
    ::pthread_kill(caller, SIGUSR1);
    return one(Reply{r.sequence, r.issued_at + Duration(2ms), {}});
  });
  ASSERT_TRUE(vehicle_->command_velocity({}).ok());
  EXPECT_EQ(vehicle_->now(), ExecTime{} + Duration(7ms));
  ::sigaction(SIGUSR1, &before, nullptr);
}

TEST_F(SimulatedVehicleTest, SleepsAreInteractions) {
  start([](const Request& r) {
    return one(Reply{r.sequence, std::max(r.issued_at, std::get<link::Sleep>(r.body).until), {}});
  });
  source_.advance(2ms);
  ASSERT_TRUE(vehicle_->sleep_for(10ms).ok());
  EXPECT_EQ(vehicle_->now(), ExecTime(12ms));
  ASSERT_TRUE(vehicle_->sleep_until(ExecTime(20ms)).ok());
  EXPECT_EQ(vehicle_->now(), ExecTime(20ms));
  ASSERT_TRUE(vehicle_->sleep_until(ExecTime(-5ms)).ok());
  ASSERT_TRUE(vehicle_->sleep_for(-1h).ok());
  EXPECT_EQ(vehicle_->now(), ExecTime(20ms));
  EXPECT_EQ(coordinator_->requests().size(), 4u);
  EXPECT_TRUE(std::get<link::Sleep>(coordinator_->requests()[0].body).is_relative);
  EXPECT_FALSE(std::get<link::Sleep>(coordinator_->requests()[1].body).is_relative);
  ASSERT_TRUE(vehicle_->sleep_for(Duration::max()).ok());
  EXPECT_EQ(to_ns(vehicle_->now()), link::kMaxTimestampNs - 1);
}

TEST_F(SimulatedVehicleTest, AnnotationsAreStampedAndFree) {
  start();
  source_.advance(3ms);
  ASSERT_TRUE(vehicle_->annotate("roi", R"({"u": 1})").ok());
  EXPECT_EQ(vehicle_->now(), ExecTime(3ms));
  source_.advance(1ms);
  ASSERT_TRUE(vehicle_->command_velocity({}).ok());
  const auto heard = coordinator_->heard();
  const auto& annotation = std::get<link::Annotation>(heard.at(0));
  EXPECT_EQ(annotation.at, ExecTime(3ms));
  EXPECT_EQ(annotation.topic, "roi");
  EXPECT_EQ(annotation.json, R"({"u": 1})");
  EXPECT_EQ(std::get<Request>(heard.at(1)).issued_at, ExecTime(4ms));
}

TEST_F(SimulatedVehicleTest, SaysAtItsEndHowManyCommandsItRefused) {
  start();
  for (int i = 0; i < 2; ++i)
    expect_failure(vehicle_->command_velocity({{1e9, 0, 0}, 0}), Failure::Kind::kInvalid);
  expect_failure(vehicle_->follow({}), Failure::Kind::kInvalid);
  ASSERT_TRUE(vehicle_->finish(true, "done", "").ok());
  const auto heard = coordinator_->heard();
  ASSERT_EQ(heard.size(), 2u);
  const auto& annotation = std::get<link::Annotation>(heard[0]);
  EXPECT_EQ(annotation.topic, uav::kClientReport);
  EXPECT_EQ(annotation.json,
            R"({"refused_commands": 3, "uncharged_ms": 0, "others_ms": 0, "clock_read_hz": 0})");
}

TEST_F(SimulatedVehicleTest, SaysAtItsEndThatItWaitedInALoop) {
  start();
  for (int i = 0; i < 50'000; ++i) (void)vehicle_->now();
  source_.advance(2s);
  ASSERT_TRUE(vehicle_->finish(true, "done", "").ok());
  const auto heard = coordinator_->heard();
  EXPECT_THAT(std::get<link::Annotation>(heard.at(0)).json,
              testing::HasSubstr(R"("clock_read_hz": 2500)"));
}

TEST_F(SimulatedVehicleTest, ReportsTheLastRoundTrip) {
  start([this](const Request& r) {
    wall_->advance(Duration(1000) * r.sequence);
    return ScriptedCoordinator::grant_at_once(r);
  });
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(vehicle_->command_velocity({}).ok());
  const auto requests = coordinator_->requests();
  EXPECT_EQ(requests[0].previous_round_trip, Duration(0));
  EXPECT_EQ(requests[1].previous_round_trip, Duration(1000));
  EXPECT_EQ(requests[2].previous_round_trip, Duration(2000));
}

TEST_F(SimulatedVehicleTest, FinishEndsTheMission) {
  start();
  ASSERT_TRUE(vehicle_->finish(true, "facing the anchor", R"({"error_rad": 0.01})").ok());
  const auto requests = coordinator_->requests();
  const auto& finish = std::get<link::Finish>(requests.at(0).body);
  EXPECT_TRUE(finish.reached_goal);
  EXPECT_EQ(finish.outcome, "facing the anchor");
  EXPECT_EQ(finish.details, R"({"error_rad": 0.01})");
  expect_failure(vehicle_->command_velocity({}), Failure::Kind::kInvalid);
  expect_failure(vehicle_->annotate("a", "{}"), Failure::Kind::kInvalid);
  expect_failure(vehicle_->sleep_for(1ms), Failure::Kind::kInvalid);
}

TEST_F(SimulatedVehicleTest, RefusalEndsEveryLaterCall) {
  using Reason = link::Refusal::Reason;
  for (const auto& [reason, kind] : {std::pair(Reason::kRunEnded, Failure::Kind::kRunEnded),
                                     std::pair(Reason::kBadRequest, Failure::Kind::kRefused)}) {
    start([refusal = link::Refusal{reason, "time limit of 60 s"}](const Request&) {
      return one(refusal);
    });
    expect_failure(vehicle_->command_velocity({}), kind, "time limit of 60 s");
    expect_failure(vehicle_->sleep_for(1ms), kind, "time limit of 60 s");
    EXPECT_EQ(coordinator_->requests().size(), 1u);
  }
}

TEST_F(SimulatedVehicleTest, ReportsLostCoordinator) {
  start();
  coordinator_.reset();
  expect_failure(vehicle_->command_velocity({}), Failure::Kind::kDisconnected);
  EXPECT_EQ(vehicle_->now(), ExecTime{});
}

TEST_F(SimulatedVehicleTest, RefusesRepliesThatBreakTheRules) {
  const auto sample_reply = [](Duration after, uav::Sample sample) {
    return [after, sample](const Request& r) {
      return one(Reply{r.sequence, r.issued_at + after, sample});
    };
  };
  const std::vector<ScriptedCoordinator::Answer> answers{
      [](const Request& r) {
        return one(Reply{r.sequence + 1, r.issued_at, kImage});
      },
      sample_reply(-1ns, kImage),
      sample_reply(0ns, uav::RangeSample{}),
      sample_reply(0ns, uav::CameraSample{SimTime(1ms) + 1ns, 0, 4, 2, kImage.rgb}),  // the future
      sample_reply(0ns, uav::CameraSample{SimTime{}, 0, 2, 4, kImage.rgb}),           // its size
      sample_reply(0ns, uav::CameraSample{SimTime{}, 0, 4, 2, {}, std::vector(8, 1.0F)}),
      sample_reply(0ns, uav::CameraSample{SimTime{}, 0, 4, 2, kImage.rgb, std::vector(8, 1.0F)}),
      ScriptedCoordinator::grant_at_once,  // no sample
      [](const Request&) { return one(link::Welcome{}); },
  };
  for (const auto& answer : answers) {
    source_ = ManualTimeSource(computer::ClockKind::kCpu, 4.0);
    start(answer);
    source_.advance(1ms);
    expect_failure(vehicle_->read<uav::CameraSample>("camera", Read::kNext),
                   Failure::Kind::kProtocol);
    expect_failure(vehicle_->command_velocity({}), Failure::Kind::kProtocol);
  }
}

// The clock of its driver can be ahead.
TEST_F(SimulatedVehicleTest, ASensorWithOwnStampsCanBeAheadOfTheRead) {
  const uav::CameraSample ahead{SimTime(20ms), 0, 4, 2, kImage.rgb};
  start(
      [ahead](const Request& r) {
        return one(Reply{r.sequence, r.issued_at, ahead});
      },
      false, true);
  const auto image = vehicle_->read<uav::CameraSample>("camera", Read::kNext);
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(image->sampled_at, ahead.sampled_at);
}

TEST_F(SimulatedVehicleTest, DoesNotHoldEtInFreeRunning) {
  start(
      [this](const Request& r) {
        wall_->advance(5ms);
        const bool sleeps = std::holds_alternative<link::Sleep>(r.body);
        return one(Reply{r.sequence, sleeps ? ExecTime(90ms) : r.issued_at + 5ms, {}});
      },
      true);
  wall_->advance(10ms);
  source_.advance(40ms);  // 10 ms of CPU on a target four times slower
  ASSERT_TRUE(vehicle_->command_velocity({}).ok());
  EXPECT_EQ(coordinator_->requests().at(0).issued_at, ExecTime(40ms));
  EXPECT_EQ(vehicle_->now(), ExecTime(45ms));
  ASSERT_TRUE(vehicle_->sleep_for(20ms).ok());
  const Request slept = coordinator_->requests().at(1);
  EXPECT_EQ(std::get<link::Sleep>(slept.body).until, slept.issued_at + 20ms);
  EXPECT_TRUE(std::get<link::Sleep>(slept.body).is_relative);
  ASSERT_TRUE(vehicle_->annotate("task", "{}").ok());
  EXPECT_EQ(vehicle_->now(), ExecTime(90ms)) << "ST at the reply";
  ASSERT_TRUE(vehicle_->sleep_until(ExecTime(95ms)).ok());
  EXPECT_FALSE(std::get<link::Sleep>(coordinator_->requests().at(2).body).is_relative);
  EXPECT_EQ(wall_->slept(), 30ms) << "the stall";
}

class IncompleteSource final : public TimeSource {
 public:
  computer::Clock clock() const override { return {computer::ClockKind::kCpu}; }
  Duration elapsed() const override { return Duration(0); }
  Status complete() const override { return Failure{Failure::Kind::kRefused, "not measured"}; }
};

TEST(SimulatedVehicle, EndsTheRunIfAPartOfItsTimeIsNotMeasured) {
  ScriptedCoordinator coordinator(link::Welcome{});
  ConnectOptions options;
  options.time = std::make_unique<IncompleteSource>();
  const auto vehicle = connect(coordinator.connect(), std::move(options)).value();
  for (const Status& status : {vehicle->sleep_for(Duration(1)), vehicle->command_velocity({})})
    EXPECT_EQ(status.failure().kind, Failure::Kind::kRefused);
  EXPECT_TRUE(coordinator.wait_for([](const link::Message& message) {
    const auto* refusal = std::get_if<link::Refusal>(&message);
    return refusal != nullptr && refusal->message == "not measured";
  }));
  EXPECT_TRUE(coordinator.requests().empty());
}

}  // namespace
}  // namespace tether::client
