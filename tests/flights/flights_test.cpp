#include "pilots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/audit/audit.h>
#include <tether/base/random.h>
#include <tether/coordinator/coordinator.h>
#include <tether/record/writer.h>
#include <tether/sim_testing/fake_simulator.h>

// Short flights drawn at random, each with the loops of the client library, queues, drivers, and
// set-points of every kind. The audit judges the rules of time from the record; what a program was
// given is checked here.
namespace tether::flights {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::uint64_t kFlights = 1'000;
constexpr std::uint32_t kImuQueue = 8;
constexpr Duration kCameraPeriod = milliseconds(33);

/// A world whose UAVs have a second camera, and a joint that turns it.
sim::World make_world(std::size_t uavs) {
  sim::World world = sim::make_fake_world(uavs);
  for (sim::Uav& uav : world.uavs) {
    uav.sensors.push_back(uav.sensors[0]);
    uav.sensors.back().name = "right";
    uav.sensors.back().joints = 1;
    uav.joints = {{"pitch", {}, {0, 1, 0}, -1.0, 1.0, 2.0}};
  }
  return world;
}

/// What a flight is drawn from.
class Draws {
 public:
  explicit Draws(const RandomKey& key) : random_(key) {}

  std::uint32_t below(std::uint32_t bound) { return random_.bits() % bound; }
  bool coin() { return below(2) == 0; }
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  uav::Vec3 vector(double most) {
    return {between(-most, most), between(-most, most), between(-most, most)};
  }
  /// On a step boundary, within a step, or longer than a lost link takes to notice.
  Duration computing() {
    const std::array<Duration, 4> kinds{Duration(0), milliseconds(below(5)),
                                        microseconds(below(9'000)),
                                        microseconds(below(8) == 0 ? 60'000 : 100)};
    return kinds[below(4)];
  }
  uav::Delay delay(Duration mean) {
    const std::array<uav::Delay, 3> kinds{uav::ConstantDelay{mean},
                                          uav::NormalDelay{mean, mean / 2},
                                          uav::EmpiricalDelay{{Duration(0), mean, 3 * mean}}};
    return kinds[below(3)];
  }
  /// Of the joints alone, or with any other set-point.
  uav::Setpoint joints(uav::Setpoint setpoint = {.mask = 0}) {
    setpoint.mask |= uav::kJoints;
    setpoint.joints_rad = {between(-1.0, 1.0)};
    return setpoint;
  }
  /// Every mask of motion that means something.
  uav::Setpoint setpoint() {
    constexpr std::array<int, 6> kMotions{uav::kPosition,
                                          uav::kPosition | uav::kVelocity,
                                          uav::kPosition | uav::kVelocity | uav::kAcceleration,
                                          uav::kVelocity,
                                          uav::kVelocity | uav::kAcceleration,
                                          uav::kAcceleration};
    constexpr std::array<int, 3> kYaws{0, uav::kYaw, uav::kYawRate};
    constexpr std::array<int, 3> kOthers{uav::kAttitude | uav::kThrust,
                                         uav::kBodyRates | uav::kThrust, uav::kRotorSpeeds};
    const bool is_motion = below(4) != 0;
    uav::Setpoint drawn;
    drawn.mask = static_cast<std::uint16_t>(is_motion ? kMotions[below(6)] | kYaws[below(3)]
                                                      : kOthers[below(3)]);
    drawn.in_heading = is_motion && !drawn.has(uav::kPosition) && coin();
    drawn.p_WB_m = vector(5.0);
    drawn.velocity_m_s = vector(1.0);
    drawn.acceleration_m_s2 = vector(2.0);
    drawn.yaw_rad = between(-3.0, 3.0);
    drawn.yaw_rate_rad_s = between(-0.5, 0.5);
    drawn.w_WB_B_rad_s = vector(1.0);
    drawn.thrust_N = between(0.0, 8.0);
    drawn.rotor_speeds_rad_s.assign(4, between(0.0, 500.0));
    return drawn;
  }
  std::vector<uav::TimedSetpoint> trajectory() {
    if (below(8) == 0) return {{Duration(0), joints()}};
    std::vector<uav::TimedSetpoint> drawn{{Duration(0), setpoint()}};
    for (std::uint32_t more = coin() ? 0 : below(5); more > 0; --more)
      drawn.push_back({drawn.back().after + microseconds(1 + below(20'000)), setpoint()});
    for (uav::TimedSetpoint& one : drawn)
      if (below(4) == 0) one.setpoint = joints(std::move(one.setpoint));
    return drawn;
  }

 private:
  KeyedRandom random_;
};

/// One program: what it calls, and what it expects of the answers.
class Mission {
 public:
  Mission(Draws draws, bool is_plain) : draws_(draws), is_plain_(is_plain) {}

  Duration computing() { return draws_.computing(); }

  void fly(client::Vehicle& vehicle) {
    for (const char* sensor : {"camera", "right"}) ASSERT_TRUE(vehicle.set_queue(sensor, 3).ok());
    ASSERT_TRUE(vehicle.set_queue("imu", kImuQueue).ok());
    for (int act = 0; act < 30; ++act) {
      const Status done = one(vehicle);
      if (done || done.failure().kind == Failure::Kind::kNothingYet) continue;
      ASSERT_EQ(done.failure().kind, Failure::Kind::kRunEnded) << done.failure().message;
      return;
    }
    const Status finished = vehicle.finish(true, "done", "{}");
    EXPECT_TRUE(finished || finished.failure().kind == Failure::Kind::kRunEnded);
  }

 private:
  template <class T>
  static Status status(const Result<T>& result) {
    return result ? ok_status() : Status(result.failure());
  }

  Status one(client::Vehicle& vehicle) {
    const auto how = static_cast<client::Read>(draws_.below(3));
    switch (draws_.below(8)) {
      case 0:
        return read_all(vehicle);
      case 1:
        return read_pair(vehicle);
      case 2:
        return status(vehicle.read<uav::CameraSample>("camera", how));
      case 3:
        return read_imu(vehicle, how);
      case 4:
        return status(vehicle.read<uav::RangeSample>("range"));
      case 5:
        return vehicle.sleep_for(draws_.computing());
      default:
        return vehicle.follow(draws_.trajectory());
    }
  }

  Status read_imu(client::Vehicle& vehicle, client::Read how) {
    const auto sample = vehicle.read<uav::ImuSample>("imu", how);
    if (!sample) return sample.failure();
    EXPECT_TRUE(sample->index >= next_imu_ || how == client::Read::kLatest);
    next_imu_ = std::max(next_imu_, sample->index + 1);
    return ok_status();
  }

  // In order, and without a gap unless the queue was full.
  Status read_all(client::Vehicle& vehicle) {
    const auto all = client::read_all<uav::ImuSample>(vehicle, "imu");
    if (!all) return all.failure();
    const bool was_read_before = next_imu_ > 0;
    for (const uav::ImuSample& sample : *all) {
      EXPECT_GE(sample.index, next_imu_);
      const bool may_have_gap = !is_plain_ || !was_read_before || all->size() == kImuQueue;
      EXPECT_TRUE(sample.index == next_imu_ || may_have_gap)
          << sample.index << " " << next_imu_ << " " << all->size();
      next_imu_ = sample.index + 1;
    }
    EXPECT_LE(all->size(), kImuQueue);
    return ok_status();
  }

  Status read_pair(client::Vehicle& vehicle) {
    const auto pair = client::read_together<uav::CameraSample>(vehicle, {"camera", "right"});
    if (!pair) return pair.failure();
    const Duration apart = (*pair)[0].sampled_at - (*pair)[1].sampled_at;  // of 30 Hz
    EXPECT_LE(std::abs(apart.count()), 16'666'667);
    EXPECT_TRUE((*pair)[0].index == (*pair)[1].index || !is_plain_);
    return ok_status();
  }

  Draws draws_;
  bool is_plain_;
  std::uint64_t next_imu_ = 0;
};

/// One flight with this number.
class Flight {
 public:
  explicit Flight(std::uint64_t number)
      : draws_({number, 0, 0}), number_(number), world_(make_world(1 + draws_.below(3))) {
    if (number % 5 == 4) options_.policy = sync::SyncPolicy::kFreeRunning;
    if (is_free()) options_.real_time_factor = 1.0;
    is_plain_ = !is_free();
    options_.token = "secret";
    options_.seed = number;
    options_.time_limit = milliseconds(200 + draws_.below(2'000));
    for (sim::Uav& uav : world_.uavs) options_.uavs.push_back(draw(uav));
  }

  void fly() {
    sim::FakeSimulator simulator(world_);
    record::RecordInMemory recorder;
    WallTime now{};
    coordinator::Coordinator coordinator(simulator, recorder, options_,
                                         [&] { return now += tick(); });
    std::vector<Mission> missions;
    missions.reserve(world_.uavs.size());
    Pilots pilots(
        [this](std::size_t waiting) { return draws_.below(static_cast<std::uint32_t>(waiting)); });
    for (const sim::Uav& uav : world_.uavs) {
      Mission& mission = missions.emplace_back(Draws({number_, missions.size() + 1, 0}), is_plain_);
      pilots.add(
          uav.name, [&] { return mission.computing(); },
          [&](client::Vehicle& vehicle) { mission.fly(vehicle); });
    }
    const coordinator::RunReport report = coordinator.run(pilots);
    EXPECT_TRUE(report.end == coordinator::RunEnd::kFinished ||
                report.end == coordinator::RunEnd::kTimeLimit)
        << report.reason;
    EXPECT_EQ(report.causality_violations, 0u);
    check(recorder.take(), simulator);
  }

 private:
  bool is_free() const { return options_.policy == sync::SyncPolicy::kFreeRunning; }
  Duration tick() const { return is_free() ? milliseconds(1) : microseconds(1); }

  coordinator::UavOptions draw(sim::Uav& uav) {
    coordinator::UavOptions drawn;
    const uav::PeriodicTiming camera{kCameraPeriod, microseconds(draws_.below(2) * 700),
                                     draws_.delay(milliseconds(10))};
    uav::PeriodicTiming right = camera;
    right.delay = draws_.delay(milliseconds(8));
    drawn.timings = {
        camera, uav::PeriodicTiming{milliseconds(5), Duration(0), draws_.delay(milliseconds(2))},
        uav::OnDemandTiming{draws_.delay(milliseconds(20))}, right};
    drawn.command_latency = draws_.delay(microseconds(draws_.below(4) * 900));
    if (draws_.coin())
      drawn.setpoint_loss = {milliseconds(20 + draws_.below(30)),
                             static_cast<uav::LossAction>(draws_.below(4))};
    for (sim::Sensor& sensor : uav.sensors)
      if (draws_.coin())
        sensor.driver.stamp_offset = microseconds(draws_.below(14'000)) - milliseconds(7);
    if (draws_.below(3) == 0) {
      is_plain_ = false;
      for (sim::Sensor& sensor : uav.sensors) {
        sensor.driver.stamp_jitter = microseconds(draws_.below(3'000));
        sensor.driver.stamp_drift_ppb = 40'000;
        if (sensor.name == "range") continue;
        sensor.driver.lost_probability = 0.1;
        sensor.driver.repeated_probability = 0.1;
      }
    }
    return drawn;
  }

  void check(const record::Record& record, const sim::FakeSimulator& simulator) const {
    const audit::Verdict verdict = audit::audit(record);
    EXPECT_EQ(verdict.synchronised, !is_free());
    EXPECT_TRUE(verdict.passed()) << audit::to_text(verdict);
    // What the record says of commands is what the simulator was told.
    ASSERT_EQ(record.commands.size(), simulator.applied().size());
    for (std::size_t i = 0; i < record.commands.size(); ++i)
      EXPECT_EQ(record.commands[i].message.applied_at, simulator.applied()[i].at);
  }

  Draws draws_;
  std::uint64_t number_;
  sim::World world_;
  coordinator::RunOptions options_;
  /// Under the barrier, and drivers lose nothing and have stamps with offsets only.
  bool is_plain_ = true;
};

TEST(Flights, RulesHoldForQueuesJointReadsAndEverySetpoint) {
  for (std::uint64_t number = 0; number < kFlights; ++number) {
    SCOPED_TRACE(number);
    Flight(number).fly();
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace tether::flights
