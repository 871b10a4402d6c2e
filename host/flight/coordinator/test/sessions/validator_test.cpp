#include "sessions/validator.h"

#include <limits>
#include <utility>

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using Kind = Fault::Kind;

constexpr ExecTime us(std::int64_t value) {
  return ExecTime(microseconds(value));
}

/// A running SUT of a UAV with a periodic sensor and one on demand.
class Validator : public testing::Test {
 protected:
  static link::Request request(decltype(link::Request::body) body, ExecTime at = us(100)) {
    return {.sequence = 4, .issued_at = at, .body = std::move(body)};
  }
  void expect(std::optional<Kind> kind, const link::Request& asked = request(link::ReadSensor{})) {
    EXPECT_EQ(kind_of(fault_of(asked, sut_, WallTime{})), kind);
  }
  void expect_stop(std::optional<Kind> kind, ExecTime at) {
    EXPECT_EQ(kind_of(fault_of(link::Progress{at, true}, sut_, WallTime{})), kind);
  }
  static std::optional<Kind> kind_of(const std::optional<Fault>& fault) {
    return fault ? std::optional(fault->kind) : std::nullopt;
  }

  Sampler sensors_{{{"imu", {uav::PeriodicTiming{milliseconds(5), Duration(0), {}}, 0, 0}},
                    {"range", {uav::OnDemandTiming{}, 0, 1}}},
                   StepGrid(milliseconds(1))};
  Standing sut_{
      .running = true, .bound = us(50), .next_sequence = 4, .st = {}, .sensors = sensors_};
};

TEST_F(Validator, AcceptsTheNextRequestOfASutThatComputes) {
  expect(std::nullopt);
  expect(std::nullopt, request(link::SetVelocity{}));
  expect(std::nullopt, request(link::Sleep{us(200)}));
  expect(std::nullopt, request(link::Finish{}));
  sut_.bound.reset();  // in free running
  expect(std::nullopt);
  expect(std::nullopt, request(link::Sleep{us(200)}));
}

TEST_F(Validator, ASerialSutSendsOneRequestAtATimeFromTheWelcomeToItsFinish) {
  sut_.running = false;
  expect(Kind::kTooEarly);
  sut_.running = true;
  sut_.open_calls = 1;
  expect(Kind::kOutOfOrder);
  sut_.open_calls = 0;
  sut_.finished = true;
  expect(Kind::kOutOfOrder);
  sut_.finished = false;
  for (const std::uint64_t next : {3u, 5u}) {
    sut_.next_sequence = next;
    expect(Kind::kOutOfOrder);
  }
}

TEST_F(Validator, AConcurrentSutHasManyOpenCallsButNoneWhileHeld) {
  sut_.concurrent = true;
  sut_.open_calls = 63;
  expect(std::nullopt);
  sut_.held = true;
  expect(Kind::kOutOfOrder);
  sut_.held = false;
  sut_.open_calls = 64;
  expect(Kind::kTooMany);
}

TEST_F(Validator, TimestampsAreFromZeroTo146Years) {
  for (const ExecTime at : {us(-1), ExecTime::max(), from_ns<ExecTime>(std::int64_t{1} << 62)}) {
    expect(Kind::kStamp, request(link::ReadSensor{}, at));
    expect(Kind::kStamp, request(link::Sleep{at}));
  }
}

TEST_F(Validator, RejectsTimestampsAheadOfACheckedClock) {
  const sync::ClockPlausibility plausibility(sync::wall_bound(1.0), ExecTime{}, WallTime{});
  const link::Request hour = request(link::ReadSensor{}, ExecTime(std::chrono::hours(1)));
  expect(std::nullopt, hour);
  sut_.plausibility = &plausibility;
  expect(Kind::kAheadOfClock, hour);
  expect_stop(Kind::kAheadOfClock, hour.issued_at);
  expect(std::nullopt, request(link::ReadSensor{}, us(10)));
}

TEST_F(Validator, LimitsCallsAtTheSameSt) {
  sut_.calls_in_step = kMaxCallsInAStep - 1;
  expect(std::nullopt);
  sut_.calls_in_step = kMaxCallsInAStep;
  expect(Kind::kTooMany);
}

TEST_F(Validator, ReadsNeedASensorOfTheUav) {
  expect(std::nullopt, request(link::ReadSensor{1}));
  expect(Kind::kNotAvailable, request(link::ReadSensor{2}));
  expect(std::nullopt, request(link::ReadSensor{0, false, true}));
  expect(Kind::kNotAvailable, request(link::ReadSensor{1, false, true}));
  expect(Kind::kNotAvailable, request(link::ReadSensor{1, false, false, 2}));
  expect(std::nullopt, request(link::ReadSensor{.sensor = 0, .skips = true}));
  expect(Kind::kNotAvailable, request(link::ReadSensor{.sensor = 1, .skips = true}));
}

TEST_F(Validator, WaitsForSensorsNeedPeriodicOnes) {
  expect(std::nullopt, request(link::ReceiveMessage{milliseconds(1), {0}}));
  expect(Kind::kNotAvailable, request(link::ReceiveMessage{milliseconds(1), {0, 1}}));
  expect(Kind::kNotAvailable, request(link::ReceiveMessage{milliseconds(1), {2}}));
}

TEST_F(Validator, ReadsOfTheBatteryNeedOne) {
  expect(Kind::kNotAvailable, request(link::ReadBattery{}));
  sut_.has_battery = true;
  expect(std::nullopt, request(link::ReadBattery{}));
}

TEST_F(Validator, LimitsVelocitiesAndWaitingSetpoints) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect(Kind::kBadValue, request(link::SetVelocity{{{nan, 0, 0}, 0}}));
  sut_.waiting_setpoints = kMaxWaitingSetpoints;
  expect(Kind::kTooMany, request(link::SetVelocity{}));
  sut_.waiting_setpoints = kMaxWaitingSetpoints - 1;
  expect(std::nullopt, request(link::SetVelocity{}));
  expect(Kind::kTooMany, request(link::SetTrajectory{{{}, {Duration(1), {}}}}));
}

TEST_F(Validator, SetpointsFitTheUav) {
  const uav::Setpoint here{.mask = uav::kPosition, .in_heading = false};
  expect(Kind::kBadValue, request(link::SetTrajectory{{{Duration(0), here}}}));
  expect(std::nullopt, request(link::SetTrajectory{{{Duration(0), {}}, {Duration(5), {}}}}));
  sut_.limits = {.rotors = 4, .max_rotor_speed_rad_s = 800, .max_thrust_N = 20};
  expect(std::nullopt, request(link::SetTrajectory{{{Duration(0), here}}}));
  expect(Kind::kBadValue, request(link::SetTrajectory{}));
  expect(std::nullopt);
}

TEST_F(Validator, OnlyARunningConcurrentSutStops) {
  expect_stop(Kind::kImpossibleStop, us(60));
  sut_.concurrent = true;
  expect_stop(std::nullopt, us(50));
  expect_stop(Kind::kImpossibleStop, us(49));
  sut_.held = true;
  expect_stop(Kind::kImpossibleStop, us(60));
}

TEST_F(Validator, LimitsTheBytesOfAnnotations) {
  AnnotationBudget budget;
  const link::Annotation note{ExecTime{}, "step", std::string((1 << 20) - 132, 'x')};  // 1 MiB
  for (int i = 0; i < 256; ++i) ASSERT_FALSE(budget.spend(note));
  EXPECT_EQ(budget.spend({})->kind, Kind::kTooMany);
}

/// How many messages of that size, sent at these intervals, are accepted; at most 100,000.
std::size_t accepted_messages(Duration interval, std::size_t bytes) {
  RadioBudget budget;
  for (std::size_t sent = 0; sent < 100'000; ++sent)
    if (const auto fault =
            budget.spend(SimTime(static_cast<std::int64_t>(sent) * interval), bytes)) {
      EXPECT_EQ(fault->kind, Kind::kFlood);
      return sent;
    }
  return 100'000;
}

TEST(RadioBudget, LimitsMessagesAtOneSt) {
  EXPECT_EQ(accepted_messages({}, 0), kMaxMessagesInAStep);
}

TEST(RadioBudget, LimitsMessagesAndBytesInEachSecondOfSt) {
  EXPECT_EQ(accepted_messages(microseconds(99), 10), kMaxMessagesInASecond);
  EXPECT_EQ(accepted_messages(microseconds(100), 10), 100'000u);
  EXPECT_EQ(accepted_messages(microseconds(900), 64 << 10), 1'024u);
  EXPECT_EQ(accepted_messages(milliseconds(1), 64 << 10), 100'000u);
}

}  // namespace
}  // namespace tether::coordinator
