#include "altered_record.h"
#include "record_generator.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <tether/audit/audit.h>
#include <tether/base/random.h>

namespace tether::audit {
namespace {

using record::Interaction;
using record::Record;
using std::chrono::milliseconds;

constexpr Duration kSecond{1'000'000'000};

class ValidRecord : public ::testing::TestWithParam<int> {};

TEST_P(ValidRecord, Passes) {
  GeneratorOptions options;
  options.seed = static_cast<std::uint64_t>(GetParam());
  options.suts = 1 + GetParam() % 4;
  options.step = Duration(GetParam() % 3 == 0 ? 4'000'000 : 1'000'000);
  options.wall_times = GetParam() % 5 != 0;
  if (GetParam() % 2 == 0) options.stop_at = from_ns<SimTime>(1'000'000'000);
  const Record record = generate(options);
  ASSERT_GT(record.interactions.size(), 30U);
  ASSERT_FALSE(record.commands.empty());
  const Verdict verdict = audit(record);
  EXPECT_TRUE(verdict.passed()) << to_text(verdict);
  EXPECT_TRUE(verdict.synchronised);
  EXPECT_EQ(verdict.interactions, record.interactions.size());
  EXPECT_EQ(verdict.largest_grid_error, record.footer->largest_grid_error);
  EXPECT_LT(verdict.largest_grid_error, options.step);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ValidRecord, ::testing::Range(1, 61));

// One SUT that twice computes for `grown` of its ET in `elapsed` of the host's clock.
Record wall_clocked(Duration grown, Duration elapsed) {
  Record record = generate({.seed = 4, .suts = 1, .interactions_per_sut = 3});
  record.header.suts[0].clock.kind = computer::ClockKind::kWall;
  WallTime wall = from_ns<WallTime>(5'000'000'000);
  ExecTime et{};
  SimTime st{};
  record.commands.clear();
  for (Entry& entry : record.interactions) {
    const std::uint64_t sequence = entry.message.sequence;
    Interaction& m = entry.message = {};
    m.uav = record.header.suts[0].uav;
    m.sequence = sequence;
    m.kind = sequence == 3 ? record::kFinish : record::kSleep;
    m.request_at = et += sequence == 1 ? Duration(0) : grown;
    m.wall_at_arrival = wall += elapsed;
    m.reply_at = et += sequence == 3 ? Duration(0) : 7 * kStep;  // waiting takes no wall time
    m.wall_at_release = wall += Duration(10);
    m.sleep_until = m.reply_at;
    m.st_at_arrival = st;
    set_lag(m);
    m.st_at_release = entry.at = st = SimTime(m.reply_at.time_since_epoch() / kStep * kStep);
    m.grid_error = same_instant(m.reply_at) - st;
  }
  record.footer->et_at_end = {et};
  return record;
}

// Only growth can breach rule 5 in such a record.
std::ptrdiff_t growth_findings(const Record& record) {
  const Verdict verdict = audit(record);
  return std::ranges::count(verdict.findings, 5, &Finding::rule);
}

struct Growth {
  const char* clock;
  Duration grown, elapsed;
  int findings;
  int cores = 0;
  double factor = 1.0;
};

// Wall clock: 1 ms and a thousandth of tolerance. CPU clock: on every core a tick of 10 ms and a
// thousandth. With an unknown number of cores, as in records of Tether 0.1.0, 1024 are allowed.
TEST(Audit, EtGrowsNoFasterThanTheHostsClockAllows) {
  const Duration two_cores = 2 * (kSecond + milliseconds(1)) + milliseconds(20);
  const Duration many_cores = 1024 * (kSecond + milliseconds(1)) + kSecond;
  for (const Growth& c : {Growth{"wall", kSecond, kSecond, 0},
                          {"wall", kSecond / 2, kSecond, 0},  // the link takes time
                          {"wall", kSecond + milliseconds(2), kSecond, 0},
                          {"wall", kSecond + milliseconds(2) + kNs, kSecond, 2},
                          {"wall", milliseconds(1), Duration(0), 0},
                          {"wall", milliseconds(1) + kNs, Duration(0), 2},
                          {"cpu", two_cores, kSecond, 0, 2},
                          {"cpu", two_cores + kNs, kSecond, 2, 2},
                          {"cpu", two_cores + kNs, kSecond, 0, 3},
                          {"cpu", 6 * two_cores, kSecond, 0, 2, 6.0},
                          {"cpu", 6 * two_cores + 2 * kNs, kSecond, 2, 2, 6.0},
                          {"cpu", many_cores, kSecond, 0},
                          {"cpu", many_cores + kNs, kSecond, 2},
                          {"scripted", 2 * kSecond, kSecond, 0}}) {
    Record record = wall_clocked(c.grown, c.elapsed);
    record.header.suts[0].clock.kind = *computer::clock_kind(c.clock);
    record.header.suts[0].cores = c.cores;
    record.header.suts[0].clock.factor = c.factor;
    EXPECT_EQ(growth_findings(record), c.findings) << c.clock << " " << c.grown.count();
  }
}

// Its other threads and processes may have computed since the reply before that.
TEST(Audit, EtOfAProgramAsItIsGrowsDuringItsCalls) {
  for (const auto& [grown, findings] :
       {std::pair{2 * kSecond, 0}, {3 * kSecond + milliseconds(500), 1}}) {
    Record record = wall_clocked(grown, kSecond);
    record.header.suts[0].clock.kind = computer::ClockKind::kCpu;
    record.header.suts[0].cores = 1;
    EXPECT_EQ(growth_findings(record), 2);
    record.header.suts[0].as_is = true;
    EXPECT_LE(growth_findings(record), findings);
  }
}

// All SUTs are started at the start of the run.
TEST(Audit, TheFirstRequestIsComparedWithTheStart) {
  Record record = wall_clocked(Duration(0), Duration(0));
  for (Entry& entry : record.interactions) {
    entry.message.request_at += std::chrono::hours(1);
    entry.message.reply_at += std::chrono::hours(1);
  }
  const auto without_start = growth_findings(record);
  record.header.wall_at_start = from_ns<WallTime>(4'999'000'000);
  EXPECT_EQ(growth_findings(record), without_start + 1);
  record.header.wall_at_start = from_ns<WallTime>(5'000'000'000) - std::chrono::hours(1);
  EXPECT_EQ(growth_findings(record), without_start);
}

// By a whole number of readings, at least one.
TEST(Audit, EtGrowsByTheReadingsOfAScriptedClock) {
  for (const auto& [grown, findings] : {std::pair(2 * kStep, 1), {2 * kStep + kNs, 3}}) {
    Record record = wall_clocked(grown, kSecond);
    record.header.suts[0].clock.kind = computer::ClockKind::kScripted;
    record.header.suts[0].clock.computing = 2 * kStep;
    EXPECT_EQ(growth_findings(record), findings);  // the first call is at ET 0
  }
}

TEST(Audit, EtIsComparedOnlyWithKnownWallTimes) {
  Record record = wall_clocked(2 * kSecond, kSecond);
  record.interactions[1].message.wall_at_arrival = WallTime{};
  EXPECT_EQ(growth_findings(record), 1);
  record.interactions[1].message.wall_at_release = WallTime{};
  EXPECT_EQ(growth_findings(record), 0);
}

TEST(Audit, AUavThatStartsInsideSomethingMayBePushedOut) {
  Record record = generate({.seed = 4, .suts = 1});
  record.header.reports_contacts = true;
  const std::string& uav = record.header.suts[0].uav;
  for (std::size_t i = 1; i < record.ground_truth.size(); ++i)
    record.ground_truth[i].message.p_WB_m[2] += 0.3;
  EXPECT_FALSE(audit(record).passed());
  record.contacts.push_back({SimTime{}, 0, {uav, SimTime{}, "wall", 0.0}});
  EXPECT_TRUE(audit(record).passed()) << to_text(audit(record));
  record.contacts[0].message.at = SimTime(kSecond);
  EXPECT_FALSE(audit(record).passed());
}

TEST(Audit, UnstampedRequestsAreANote) {
  Record record = generate({.suts = 1});
  record.header.suts[0].clock.kind = computer::ClockKind::kUnstamped;
  record.header.suts[0].required_clock = computer::Clock{computer::ClockKind::kUnstamped};
  for (Entry& entry : record.interactions) entry.message.stamped = false;
  const Verdict verdict = audit(record);
  EXPECT_TRUE(verdict.passed()) << to_text(verdict);
  EXPECT_EQ(verdict.notes.size(), 1U);
}

TEST(Audit, WithoutItsEndARecordDoesNotPass) {
  EXPECT_FALSE(audit(Record{}).passed());
  Record record = generate({});
  record.footer.reset();
  record.damage = "damaged at byte 5: the file is truncated";
  const Verdict verdict = audit(record);
  EXPECT_TRUE(verdict.findings.empty()) << to_text(verdict);
  EXPECT_FALSE(verdict.complete);
  EXPECT_FALSE(verdict.passed());
  EXPECT_EQ(verdict.reached, record::last_time(record));
  EXPECT_EQ(verdict.notes, std::vector{"the record is " + record::describe_damage(record)});
}

// A command whose reply is still held when the run ends has its effect but no interaction.
TEST(Audit, CommandHeldAtTheEndIsNoOrphan) {
  Record record = generate({.stop_at = from_ns<SimTime>(1'000'000'000)});
  std::uint64_t last = 0;
  for (const Entry& entry : record.interactions)
    last = entry.message.uav == "uav0" ? entry.message.sequence : last;
  record.commands.push_back({record.footer->st_at_end,
                             record.interactions.back().order + 1000,
                             {"uav0", last + 1, record.footer->st_at_end, 0, 0, 0, 0}});
  EXPECT_EQ(rules_of(record), Rules{});
  record.commands.back().message.sequence = last + 2;
  EXPECT_EQ(rules_of(record), Rules{2});
}

TEST(Audit, FindingsArePrintableLines) {
  Record record = generate({});
  record.header.policy = "con\nser\x1b[2J";
  record.interactions.front().message.uav = "a\nb";
  const Verdict verdict = audit(record);
  ASSERT_FALSE(verdict.passed());
  EXPECT_EQ(verdict.findings.front().what, "unknown policy \"con?ser?[2J\"");
  for (const Finding& finding : verdict.findings) {
    for (const char c : finding.uav + finding.what) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
  }
}

Record free_running() {
  Record record = generate({});
  record.header.policy = record::kFreeRunning;
  for (Entry& entry : record.interactions) {
    entry.message.st_at_arrival = entry.message.st_at_release;
    entry.message.lag = Duration(0);
    if (entry.message.sample_state_at) entry.message.sample_state_at = entry.message.st_at_arrival;
    if (entry.message.sleep_until)
      entry.message.sleep_until = from_ns<ExecTime>(to_ns(entry.message.st_at_release));
  }
  record.footer->largest_lag = Duration(0);
  return record;
}

TEST(Audit, FreeRunningIsNotSynchronised) {
  const Verdict verdict = audit(free_running());
  EXPECT_FALSE(verdict.synchronised);
  EXPECT_TRUE(verdict.passed()) << to_text(verdict);
}

TEST(Audit, WhatTakesEffectIsWhatWasCommanded) {
  for (const bool is_free : {false, true}) {
    Record record = is_free ? free_running() : generate({});
    record.commands[5].message.vx_H_m_s *= -1.0;
    EXPECT_EQ(rules_of(record), Rules{2});
  }
  Record record = generate({});
  where(record, [](const Interaction& m) { return m.kind == record::kCommand; }).command.reset();
  EXPECT_EQ(rules_of(record), Rules{0});
}

Interaction& first_reading(Record& record) {
  return std::ranges::find_if(
             record.interactions,
             [](const Entry& entry) { return entry.message.kind == record::kSensor; })
      ->message;
}

// A read that was answered at once, as one that skips it.
TEST(Audit, NothingOfTheFutureIsSkipped) {
  Record record = generate({});
  Interaction& skip = where(record, [&](const Interaction& m) {
    const auto& sensors = record.header.sensors;
    return m.kind == record::kSensor && m.reply_at == m.request_at && !m.latest && m.sampled_at &&
           std::ranges::any_of(sensors, [&](const record::SensorInfo& sensor) {
             return sensor.uav == m.uav && sensor.name == m.sensor && sensor.periodic;
           });
  });
  skip.only_if_available = true;
  skip.skipped_to = skip.sample_index;
  skip.sampled_at.reset();
  skip.sample_state_at.reset();
  skip.available_at.reset();
  skip.seen_anchors.reset();
  skip.grid_error = same_instant(skip.reply_at) - skip.st_at_release;
  EXPECT_TRUE(audit(record).passed()) << to_text(audit(record));
  *skip.skipped_to += 1'000'000;
  EXPECT_TRUE(rules_of(record).contains(1));
}

// A read that arrived before its periodic sensor measured.
Record waiting_for_next(Duration wait) {
  Record record = free_running();
  Interaction& read = first_reading(record);
  const Duration released = read.st_at_release.time_since_epoch(), period = 10 * kStep;
  read.sample_index = static_cast<std::uint64_t>(released / period);
  record.header.sensors = {{read.uav, read.sensor, "imu", true, period, released % period}};
  read.sampled_at = read.st_at_release;
  read.st_at_arrival = read.st_at_release - wait;
  return record;
}

// At 30 Hz, measurements are between the boundaries. The read after one that was released at its
// boundary comes before the instant of that measurement.
Record waiting_between_boundaries(Duration wait) {
  Record record = waiting_for_next(wait);
  record.header.sensors[0].phase += 2 * kStep / 3;
  *first_reading(record).sampled_at += 2 * kStep / 3;
  return record;
}

TEST(Audit, FreeRunningReadsMayWaitForTheNextMeasurement) {
  for (const Record& record : {waiting_for_next(9 * kStep), waiting_between_boundaries(10 * kStep)})
    EXPECT_TRUE(audit(record).passed()) << to_text(audit(record));
}

TEST(Audit, BreachesInFreeRunningReadsAreFound) {
  using Alter = std::function<void(Interaction&)>;
  const std::pair<Record, std::vector<Alter>> cases[] = {
      {free_running(),
       {[](auto& m) { m.st_at_arrival -= kStep; }, [](auto& m) { *m.sample_state_at += kStep; },
        [](auto& m) { *m.sample_state_at -= kStep; }, [](auto& m) { *m.sample_state_at += kNs; }}},
      {waiting_for_next(9 * kStep),
       {[](auto& m) { *m.sampled_at -= kNs; }, [](auto& m) { m.sample_index += 1; },
        [](auto& m) { m.only_if_available = true; }}},
      {waiting_for_next(11 * kStep), {[](auto&) {}}},  // missed a measurement
      {waiting_between_boundaries(11 * kStep), {[](auto&) {}}}};
  for (const auto& [sound, alterations] : cases) {
    for (const Alter& alter : alterations) {
      Record record = sound;
      alter(first_reading(record));
      EXPECT_EQ(rules_of(record), Rules{8}) << to_text(audit(record));
    }
  }
}

TEST(Audit, BreachesInFreeRunningRecordsAreFound) {
  const auto altered = [](Record record, auto alter) {
    alter(record);
    return rules_of(record);
  };
  const Record held = waiting_for_next(9 * kStep), immediate = free_running();
  EXPECT_EQ(altered(held, [](auto& r) { r.header.sensors[0].periodic = false; }), Rules{8});
  EXPECT_EQ(altered(held, [](auto& r) { r.header.sensors.clear(); }), Rules{8});
  EXPECT_EQ(
      altered(immediate, [](auto& r) { r.interactions.back().message.st_at_arrival -= kStep; }),
      Rules{8})
      << "a finish";
  for (const Duration change : {-kStep, kNs, kStep}) {
    Record late = immediate;
    *std::ranges::find_if(late.interactions, [](const Entry& entry) {
       return entry.message.sleep_until.has_value();
     })->message.sleep_until += change;
    EXPECT_EQ(rules_of(late), change > Duration(0) ? Rules{8} : Rules{}) << change.count();
  }
  EXPECT_EQ(altered(immediate, [](auto& r) { r.footer->interactions -= 1; }), Rules{0});
  EXPECT_EQ(altered(immediate, [](auto& r) { r.ground_truth.erase(r.ground_truth.begin()); }),
            Rules{0});
  EXPECT_EQ(altered(immediate, [](auto& r) { first_reading(r).sample_state_at.reset(); }),
            Rules{0});
}

TEST(Audit, FindingsAreBounded) {
  Record record = generate({.interactions_per_sut = 5000});
  for (Entry& entry : record.interactions) entry.message.lag -= kNs;
  const Verdict verdict = audit(record);
  EXPECT_EQ(verdict.findings.size(), kMaxFindings);
  EXPECT_GT(verdict.further_findings, 0U);
}

// Each change of a single time is found, and no value breaks the audit.
TEST(Audit, RandomChangesOfTimesAreFound) {
  const Record valid = generate({.seed = 9, .interactions_per_sut = 60, .wall_times = false});
  KeyedRandom random({.seed = 2});
  constexpr std::int64_t kExtremes[] = {0, -1, std::numeric_limits<std::int64_t>::max(),
                                        std::numeric_limits<std::int64_t>::min()};
  for (int round = 0; round < 1000; ++round) {
    Record record = valid;
    Interaction& m = record.interactions[random.bits() % record.interactions.size()].message;
    const bool extreme = random.bits() % 4 == 0;
    const std::int64_t value = kExtremes[random.bits() % 4];
    const Duration change(1 + random.bits() % 5'000'000);
    const auto alter = [&](auto& time) {
      using Time = std::decay_t<decltype(time)>;
      const Time before = time;
      time = extreme ? from_ns<Time>(value) : time - change;
      return time != before;
    };
    const unsigned which = random.bits() % 4;
    const bool changed = which == 0   ? alter(m.request_at)
                         : which == 1 ? alter(m.reply_at)
                         : which == 2 ? alter(m.st_at_release)
                                      : alter(m.st_at_arrival);
    EXPECT_EQ(audit(record).findings.empty(), !changed) << "round " << round;
  }
}

}  // namespace
}  // namespace tether::audit
