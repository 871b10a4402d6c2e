#include <gtest/gtest.h>

#include <tether/timing/pace.h>

namespace tether::timing {
namespace {

using std::chrono::milliseconds;

/// Ten reads a second of a camera with 20 images a second, each after 60 ms of "detect", 20 ms of
/// it in every fourth one, and a command in between.
record::Record record_of_reads() {
  record::Record record;
  record.header.policy = record::kConservativeBarrier;
  record.header.seed = 1;
  record::SutInfo sut;
  sut.uav = "uav1";
  sut.clock.kind = computer::ClockKind::kCpu;
  record.header.suts = {sut};
  record::SensorInfo camera;
  camera.uav = "uav1";
  camera.name = "camera";
  camera.kind = "camera";
  camera.periodic = true;
  camera.period = milliseconds(50);
  record.header.sensors = {camera};
  for (std::uint64_t i = 0; i < 21; ++i) {
    const auto at = milliseconds(100 * i);
    record::Interaction& read = record.interactions.emplace_back().message;
    read.uav = "uav1";
    read.kind = record::kSensor;
    read.request_at = ExecTime(at);
    read.reply_at = ExecTime(at + milliseconds(30));
    read.st_at_release = SimTime(at + milliseconds(30));
    read.sensor = "camera";
    read.sample_index = 2 * i;
    read.sampled_at = read.st_at_release;
    read.stages = {{"detect", milliseconds(i % 4 == 0 ? 20 : 60)}, {"decide", milliseconds(15)}};
  }
  return record;
}

TEST(Pace, IsThatOfTheImages) {
  const Pace pace = *pace_of(record_of_reads());
  EXPECT_EQ(pace.uav, "uav1");
  EXPECT_EQ(pace.seed, 1u);
  EXPECT_EQ(pace.images, 21u);
  EXPECT_NEAR(pace.read_hz, 10.0, 1e-9);
  EXPECT_NEAR(*pace.offered_hz, 20.0, 1e-9);
  EXPECT_NEAR(pace.median_s, 0.075, 1e-9);
  EXPECT_NEAR(pace.p95_s, 0.075, 1e-9);
  EXPECT_NEAR(*pace.headroom(), 50.0 / 75.0, 1e-9);
  EXPECT_FALSE(pace.keeps_up());
  EXPECT_EQ(pace.reading, 1.0) << "not known";
  ASSERT_EQ(pace.stages.size(), 2u);
  EXPECT_EQ(pace.stages.front().stage, "detect");
}

TEST(Pace, SaysForHowMuchOfTheFlightTheCameraIsRead) {
  record::Record record = record_of_reads();
  record.footer.emplace().st_at_end = SimTime(milliseconds(8000));
  EXPECT_NEAR(pace_of(record)->reading, 0.25, 1e-9);
}

TEST(Pace, HasTheRateOfSetpoints) {
  record::Record record = record_of_reads();
  EXPECT_EQ(pace_of(record)->setpoint_hz, 0.0);
  for (const int at_ms : {0, 10, 40, 90, 140, 1000}) {
    record::AutopilotMessage& sent = record.autopilot.emplace_back().message;
    sent.uav = at_ms == 10 ? "uav2" : "uav1";
    sent.to_controller = true;
    sent.name = at_ms == 40 ? "SET_ATTITUDE_TARGET" : "SET_POSITION_TARGET_LOCAL_NED";
    sent.sent_at = SimTime(milliseconds(at_ms));
  }
  record.autopilot.emplace_back(record.autopilot.back()).message.name = "HEARTBEAT";
  EXPECT_NEAR(pace_of(record)->setpoint_hz, 20.0, 1e-9);
  EXPECT_NEAR(pace_of(record)->setpoint_gap_s, 0.86, 1e-9);
  record.footer.emplace().st_at_end = SimTime(milliseconds(9000));
  EXPECT_NEAR(pace_of(record)->setpoint_gap_s, 8.0, 1e-9);
  record.interactions.back().message.kind = record::kFinish;
  record.interactions.back().message.request_at = ExecTime(milliseconds(6000));
  EXPECT_NEAR(pace_of(record)->setpoint_gap_s, 5.0, 1e-9) << "until the program ends";
  record.autopilot.back().message.name = "COMMAND_LONG";
  record.autopilot.back().message.sent_at = SimTime(milliseconds(3000));
  EXPECT_NEAR(pace_of(record)->setpoint_gap_s, 2.0, 1e-9) << "until it asks for something else";
}

TEST(Pace, HasTheLossesOfSetpointsOfAllPrograms) {
  record::Record record = record_of_reads();
  record.interactions.back().message.uav = "uav2";  // its program ends then
  record.interactions.back().message.request_at = ExecTime(milliseconds(40));
  for (const auto& [at_ms, loss] :
       {std::pair{10, ""}, {15, "keep"}, {20, "hover"}, {30, ""}, {40, "land"}, {50, "land"}}) {
    record::CommandEffect& effect = record.commands.emplace_back().message;
    effect.uav = "uav2";
    effect.applied_at = SimTime(milliseconds(at_ms));
    effect.loss = loss;
  }
  EXPECT_EQ(pace_of(record)->losses, (Pace::Losses{2, SimTime(milliseconds(20)), "uav2", "hover"}));
}

TEST(Pace, ContainsWhatWasComputedWhenTheRunEnded) {
  record::Record record = record_of_reads();
  const ExecTime last = record.interactions.back().message.reply_at;
  record.footer.emplace().et_at_end = {last + std::chrono::seconds(5)};
  record.footer->computing = {"uav1"};
  const Pace pace = *pace_of(record);
  EXPECT_EQ(pace.stages.front().stage, "camera to end");
  EXPECT_NEAR(pace.stages.front().worst_s, 5.0, 1e-9);
  EXPECT_EQ(pace.images, 21u);
  record.interactions.resize(1);  // then the only image takes 5 s at least
  EXPECT_NEAR(
      pace_of(record)->p95_s,
      to_seconds(*record.footer->et_at_end.data() - record.interactions.back().message.reply_at),
      1e-9);
  EXPECT_TRUE(pace_of(record)->is_too_slow_for_camera());
}

TEST(Pace, HasTheSpeedOfAllPrograms) {
  record::Record record = record_of_reads();
  record.header.machine = "here";
  record.header.boards = {{"obc", 2, false}};
  record.header.target = record::TargetInfo{"pi", "ssh://pi", {}};
  record.header.emulator.program = "qemu-arm";
  record.header.suts.push_back(record.header.suts[0]);
  record::SutInfo& other = record.header.suts[1];
  other.uav = "uav2";
  other.clock.factor = 6.0;
  other.board = other.computer = "obc";
  other.pinned_core = 1;
  other.build_id = "0a";
  other.build = {{"argument 1", "x"}, {"library libb.so", "0b"}, {"library liba.so", "0c"}};
  const Speed speed = pace_of(record)->speed;
  ASSERT_EQ(speed.programs.size(), 2u);
  EXPECT_EQ(speed.programs[1], (Speed::Program{.uav = "uav2",
                                               .clock = {computer::ClockKind::kCpu, 6.0},
                                               .board = "obc",
                                               .computer = "obc",
                                               .build = "0a\nargument 1 x",
                                               .libraries = {"liba.so 0c", "libb.so 0b"},
                                               .pinned_core = 1}));
  EXPECT_EQ(speed.boards, record.header.boards);
  EXPECT_EQ(speed.machine, "here");
  EXPECT_EQ(speed.target, "pi ssh://pi");
  EXPECT_EQ(speed.emulator.program, "qemu-arm");
  EXPECT_FALSE(speed.is_scripted());
}

TEST(Speed, IsInstantIfNoProgramIsChargedTime) {
  Speed speed{.programs = {
                  {.clock = {computer::ClockKind::kScripted, 1.0, std::chrono::microseconds(1)}},
                  {.clock = {computer::ClockKind::kScripted, 1.0, std::chrono::microseconds(10)}}}};
  EXPECT_TRUE(speed.is_scripted() && speed.is_instant());
  speed.programs[1].clock.computing = std::chrono::microseconds(11);
  EXPECT_TRUE(speed.is_scripted() && !speed.is_instant());
  speed.programs[1] = {.clock = {computer::ClockKind::kCpu}};
  EXPECT_FALSE(speed.is_scripted() || speed.is_instant());
  EXPECT_FALSE(Speed{}.is_instant());
}

TEST(Pace, CountsComputingBetweenImagesAndEachImageOnce) {
  record::Record record = record_of_reads();
  record.interactions[5].message.kind = record::kCommand;
  record.interactions[5].message.sensor.clear();
  record.interactions[6].message.sampled_at.reset();  // no image was available
  record.interactions[8].message.sample_index = record.interactions[7].message.sample_index;
  EXPECT_EQ(pace_of(record)->images, 18u);
  EXPECT_GT(pace_of(record)->p95_s, 0.1) << "of the images with calls in between";
}

TEST(Pace, KeepsUpIfItReadsNearlyEveryImage) {
  record::Record record = record_of_reads();
  record.header.sensors[0].period = milliseconds(100);
  EXPECT_TRUE(pace_of(record)->keeps_up());
  record.header.sensors[0].periodic = false;
  EXPECT_FALSE(pace_of(record)->keeps_up());
  EXPECT_EQ(pace_of(record)->headroom(), std::nullopt) << "a camera on demand has no rate";
}

TEST(Pace, DoesNotKeepUpIfAFewImagesTakeMuchOfTheTime) {
  record::Record record = record_of_reads();
  record.header.sensors[0].period = milliseconds(100);
  const record::Interaction last = record.interactions.back().message;
  record::Interaction& heavy = record.interactions.emplace_back().message;
  heavy = last;
  heavy.request_at += milliseconds(2000);
  heavy.reply_at += milliseconds(2000);
  heavy.sample_index += 40;
  heavy.stages = {{"detect", milliseconds(1900)}};
  const Pace pace = *pace_of(record);
  EXPECT_NEAR(pace.behind, 0.5, 1e-9);
  EXPECT_TRUE(pace.reads_nearly_every());
  EXPECT_FALSE(pace.keeps_up());
  heavy.stages = {{"detect", milliseconds(90)}};
  EXPECT_TRUE(pace_of(record)->keeps_up()) << "it did not ask for images";
}

TEST(Pace, IsNotKnownWithoutSynchronisationCallsOrCamera) {
  record::Record record = record_of_reads();
  record.header.sensors.clear();
  EXPECT_EQ(pace_of(record)->camera, "");
  EXPECT_EQ(pace_of(record)->stages.size(), 2u);
  record.header.policy = record::kFreeRunning;
  EXPECT_FALSE(pace_of(record));
  record = record_of_reads();
  record.interactions.clear();
  EXPECT_FALSE(pace_of(record));
}

TEST(Pace, OnARealBoardDoesNotTellWaitingApart) {
  record::Record record = record_of_reads();
  record.header.boards = {{"obc", 0, true}};
  record.header.suts[0].board = "obc";
  record.header.suts.push_back(record.header.suts[0]);
  record.header.suts[1].uav = "uav2";
  EXPECT_TRUE(pace_of(record)->shares_real_board);
  EXPECT_EQ(pace_of(record)->shared_board, "");
}

// 75 ms of own work are 150 ms of the board's time, half of it for the other program.
TEST(Pace, OnASharedBoardIncludesWaitingForItsCores) {
  record::Record record = record_of_reads();
  record.header.suts[0].board = "obc";
  record.header.suts.push_back(record.header.suts[0]);
  record.header.suts[1].uav = "uav2";
  EXPECT_EQ(pace_of(record)->waiting, 0.0) << "nothing was shared so far";
  for (std::size_t i = 0; i < record.interactions.size(); ++i) {
    record::Interaction& read = record.interactions[i].message;
    read.request_at = ExecTime(milliseconds(180 * i + 150));
    read.reply_at = ExecTime(milliseconds(180 * (i + 1)));
    read.stages = {{"detect", milliseconds(75)}};
    read.computed = milliseconds(75);
  }
  const Pace pace = *pace_of(record);
  EXPECT_EQ(pace.shared_board, "obc");
  EXPECT_FALSE(pace.shares_real_board);
  EXPECT_EQ(pace.programs, 2u);
  EXPECT_NEAR(pace.median_s, 0.15, 1e-9);
  EXPECT_NEAR(pace.p95_s, 0.15, 1e-9);
  EXPECT_NEAR(pace.waiting, 0.5, 1e-9);
  EXPECT_NEAR(*pace.headroom(), 1.0 / 3.0, 1e-9);
  record.header.suts[1].pinned_core = 0;
  EXPECT_EQ(pace_of(record)->shared_board, "") << "it has the other cores to itself";
}

TEST(Pace, OfSeveralUavsIsThatOfTheSlowest) {
  record::Record record = record_of_reads();
  record::SutInfo fast = record.header.suts[0];
  fast.uav = "uav2";
  record.header.suts.push_back(fast);
  record.header.sensors.push_back(record.header.sensors[0]);
  record.header.sensors.back().uav = "uav2";
  for (std::size_t i = 0; i < 21; ++i) {
    auto copy = record.interactions[i];
    copy.message.uav = "uav2";
    copy.message.stages = {{"detect", milliseconds(1)}};
    record.interactions.push_back(copy);
  }
  EXPECT_EQ(pace_of(record)->uav, "uav1");
}

TEST(Pace, IsTooSlowForItsCameraOnlyIfComputingIsTheReason) {
  Pace pace{.camera = "camera", .read_hz = 9.0, .offered_hz = 30.0, .p95_s = 0.11};
  EXPECT_TRUE(pace.is_too_slow_for_camera());
  pace.p95_s = 0.001;
  EXPECT_FALSE(pace.is_too_slow_for_camera()) << "it sleeps";
  pace.p95_s = 0.04;
  pace.read_hz = 30.0;
  EXPECT_FALSE(pace.is_too_slow_for_camera()) << "it reads every image nevertheless";
  pace.offered_hz.reset();
  EXPECT_FALSE(pace.is_too_slow_for_camera()) << "the camera has no rate";
}

TEST(Pace, CountsTheMessagesThatArrive) {
  record::Record record = record_of_reads();
  record.header.radio.model = "ideal";
  for (const char* outcome : {"delivered", "noise", "delivered"})
    record.radio.emplace_back().message.outcome = outcome;
  EXPECT_EQ(pace_of(record)->radio, record::to_text(record.header.radio));
  EXPECT_EQ(pace_of(record)->messages, 3u);
  EXPECT_EQ(pace_of(record)->messages_arrived, 2u);
}

}  // namespace
}  // namespace tether::timing
