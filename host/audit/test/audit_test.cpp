#include "record_generator.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <tether/audit/audit.h>
#include <tether/base/random.h>

namespace tether::audit {
namespace {

using record::Interaction;
using record::Record;
using Entry = record::Logged<Interaction>;
using Rules = std::set<int>;

constexpr Duration kStep{1'000'000};

Rules rules_of(const Verdict& verdict) {
  Rules rules;
  for (const Finding& finding : verdict.findings) {
    rules.insert(finding.rule);
  }
  return rules;
}

// ---- What keeps the rules passes
// -----------------------------------------------------------------

class ValidRecord : public ::testing::TestWithParam<int> {};

TEST_P(ValidRecord, Passes) {
  GeneratorOptions options;
  options.seed = static_cast<std::uint64_t>(GetParam());
  options.suts = 1 + GetParam() % 4;
  options.step = Duration(GetParam() % 3 == 0 ? 4'000'000 : 1'000'000);
  options.wall_times = GetParam() % 5 != 0;
  if (GetParam() % 2 == 0) {
    options.stop_at = from_ns<SimTime>(1'000'000'000);
  }
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

// ---- ET of a wall clock against the host's
// ---------------------------------------------------------

// One SUT that computes for `grown` of its ET while `elapsed` goes by on the host, twice.
Record wall_clocked(Duration grown, Duration elapsed) {
  Record record = generate({.seed = 4, .suts = 1, .interactions_per_sut = 3});
  record.header.suts[0].clock = "wall";
  WallTime wall = from_ns<WallTime>(5'000'000'000);
  ExecTime et{};
  SimTime st{};
  record.commands.clear();
  for (Entry& entry : record.interactions) {
    const bool last = entry.message.sequence == 3;
    Interaction m;
    m.uav = entry.message.uav;
    m.sequence = entry.message.sequence;
    m.kind = last ? record::kFinish : record::kSleep;
    m.request_at = et += entry.message.sequence == 1 ? Duration(0) : grown;
    m.wall_at_arrival = wall += elapsed;
    m.reply_at = et += last ? Duration(0) : 7 * kStep;  // waiting costs no wall time
    m.wall_at_release = wall += Duration(10);
    m.sleep_until = m.reply_at;
    m.st_at_arrival = st;
    m.lag = lag(m.request_at, st);
    st = SimTime(m.reply_at.time_since_epoch() / kStep * kStep);
    m.st_at_release = st;
    m.grid_error = same_instant(m.reply_at) - st;
    entry.message = m;
    entry.at = st;
  }
  record.footer->et_at_end = {et};
  return record;
}

// Counts rule 5 alone, which nothing but growth can break in such a record.
std::size_t growth_findings(Record record) {
  const Verdict verdict = audit(record);
  return static_cast<std::size_t>(std::ranges::count_if(
      verdict.findings, [](const Finding& finding) { return finding.rule == 5; }));
}

TEST(Audit, EtByAWallClockGrowsNoFasterThanTheHostsWallTime) {
  using std::chrono::milliseconds;
  const auto s = Duration(1'000'000'000);
  EXPECT_EQ(growth_findings(wall_clocked(s, s)), 0U);
  EXPECT_EQ(growth_findings(wall_clocked(s / 2, s)), 0U);  // the link takes time
  // 1 ms and a thousandth are granted, not a nanosecond more.
  EXPECT_EQ(growth_findings(wall_clocked(s + milliseconds(2), s)), 0U);
  EXPECT_EQ(growth_findings(wall_clocked(s + milliseconds(2) + Duration(1), s)), 2U);
  EXPECT_EQ(growth_findings(wall_clocked(milliseconds(1), Duration(0))), 0U);
  EXPECT_EQ(growth_findings(wall_clocked(milliseconds(1) + Duration(1), Duration(0))), 2U);
}

std::size_t too_much(const Record& record) {
  const Verdict verdict = audit(record);
  return static_cast<std::size_t>(
      std::ranges::count_if(verdict.findings, [](const Finding& finding) {
        return finding.what.find(" ns too much") != std::string::npos;
      }));
}

// All SUTs go on when the run starts.
TEST(Audit, TheFirstRequestIsComparedWithTheStart) {
  Record record = wall_clocked(Duration(0), Duration(0));
  for (Entry& entry : record.interactions) {
    entry.message.request_at += std::chrono::hours(1);
    entry.message.reply_at += std::chrono::hours(1);
  }
  EXPECT_EQ(too_much(record), 0U);
  record.header.wall_at_start = from_ns<WallTime>(4'999'000'000);
  EXPECT_EQ(too_much(record), 1U);
  record.header.wall_at_start = from_ns<WallTime>(5'000'000'000) - std::chrono::hours(1);
  EXPECT_EQ(too_much(record), 0U);
}

Record cpu_clocked(Duration grown, Duration elapsed, int cores, double factor = 1.0) {
  Record record = wall_clocked(grown, elapsed);
  record.header.suts[0].clock = "cpu";
  record.header.suts[0].cores = cores;
  record.header.suts[0].cpu_factor = factor;
  return record;
}

TEST(Audit, CpuTimeGrowsNoFasterThanOnAllCoresAtOnce) {
  using std::chrono::milliseconds;
  const auto s = Duration(1'000'000'000);
  // A tick of each core and a thousandth are granted, not a nanosecond more.
  const Duration most = 2 * (s + milliseconds(1)) + milliseconds(20);
  EXPECT_EQ(growth_findings(cpu_clocked(most, s, 2)), 0U);
  EXPECT_EQ(growth_findings(cpu_clocked(most + Duration(1), s, 2)), 2U);
  EXPECT_EQ(growth_findings(cpu_clocked(most + Duration(1), s, 3)), 0U);
  EXPECT_EQ(growth_findings(cpu_clocked(6 * most, s, 2, 6.0)), 0U);
  EXPECT_EQ(growth_findings(cpu_clocked(6 * most + Duration(2), s, 2, 6.0)), 2U);
}

// So it is in records of Tether 0.1.0, and where somebody else starts the SUT.
TEST(Audit, OfAnUnknownMachineManyCoresAreBelieved) {
  const auto s = Duration(1'000'000'000);
  const Duration most = 1024 * (s + Duration(1'000'000)) + s;
  EXPECT_EQ(growth_findings(cpu_clocked(most, s, 0)), 0U);
  EXPECT_EQ(growth_findings(cpu_clocked(most + Duration(1), s, 0)), 2U);
}

TEST(Audit, ALineNamesTheFirstFinding) {
  Verdict verdict;
  verdict.complete = true;
  verdict.interactions = 3;
  verdict.findings = {{5, "uav1", 2, {}, "ET grew by 3 ns too much"}, {4, "uav1", 3, {}, "b"}};
  EXPECT_EQ(to_line(verdict),
            "FAILED: 2 findings in 3 interactions: rule 5 (ST 0.000000 s, uav1 #2): ET grew by 3 "
            "ns too much");
  verdict.findings.clear();
  EXPECT_EQ(to_line(verdict) + "\n", to_text(verdict));
}

TEST(Audit, EtIsComparedWithWallTimeOnlyWhereBothSayTheSame) {
  const Duration s(1'000'000'000);
  const Record fast = wall_clocked(2 * s, s);
  for (const char* clock : {"cpu", "scripted"}) {
    Record record = fast;
    record.header.suts[0].clock = clock;
    EXPECT_EQ(growth_findings(record), 0U) << clock;
  }
  Record record = fast;
  record.interactions[1].message.wall_at_arrival = WallTime{};
  EXPECT_EQ(growth_findings(record), 1U);
  record.interactions[1].message.wall_at_release = WallTime{};
  EXPECT_EQ(growth_findings(record), 0U);
}

// ---- Other verdicts
// --------------------------------------------------------------------------------

TEST(Audit, UnstampedIsANoteAndNoFinding) {
  Record record = generate({.suts = 1});
  record.header.suts[0].clock = "unstamped";
  for (Entry& entry : record.interactions) {
    entry.message.stamped = false;
  }
  const Verdict verdict = audit(record);
  EXPECT_TRUE(verdict.passed()) << to_text(verdict);
  ASSERT_EQ(verdict.notes.size(), 1U);
  EXPECT_NE(verdict.notes[0].find("rule 6"), std::string::npos);
}

TEST(Audit, WithoutItsEndARecordDoesNotPass) {
  Record record = generate({});
  record.footer.reset();
  record.damage = "damaged at byte 5: the file ends too early";
  const Verdict verdict = audit(record);
  EXPECT_TRUE(verdict.findings.empty()) << to_text(verdict);
  EXPECT_FALSE(verdict.complete);
  EXPECT_FALSE(verdict.passed());
  ASSERT_EQ(verdict.notes.size(), 1U);
  EXPECT_NE(verdict.notes[0].find("byte 5"), std::string::npos);
}

// A command whose reply is still held when the run ends has its effect but no interaction.
TEST(Audit, CommandHeldAtTheEndIsNoOrphan) {
  Record record = generate({.stop_at = from_ns<SimTime>(1'000'000'000)});
  std::uint64_t last = 0;
  for (const Entry& entry : record.interactions) {
    last = entry.message.uav == "uav0" ? entry.message.sequence : last;
  }
  record.commands.push_back({record.footer->st_at_end,
                             record.interactions.back().order + 1000,
                             {"uav0", last + 1, record.footer->st_at_end, 0, 0, 0, 0}});
  EXPECT_TRUE(audit(record).passed()) << to_text(audit(record));
  record.commands.back().message.sequence = last + 2;
  EXPECT_EQ(rules_of(audit(record)), Rules{2});
}

TEST(Audit, TellsOfForeignNamesInPrintableLines) {
  Record record = generate({});
  record.header.policy = "con\nser\x1b[2J";
  record.interactions.front().message.uav = "a\nb";
  const Verdict verdict = audit(record);
  ASSERT_FALSE(verdict.passed());
  EXPECT_EQ(verdict.findings.front().what, "unknown policy \"con?ser?[2J\"");
  const std::string text = to_text(verdict);
  for (std::size_t i = 0; i < text.size(); ++i)
    EXPECT_TRUE(static_cast<unsigned char>(text[i]) >= 0x20 || text[i] == '\n') << i;
  EXPECT_EQ(text.find("a\nb"), std::string::npos);
}

Record free_running() {
  Record record = generate({});
  record.header.policy = record::kFreeRunning;
  for (Entry& entry : record.interactions) {
    entry.message.st_at_arrival = entry.message.st_at_release;
    entry.message.lag = Duration(0);
    if (entry.message.sample_state_at) {
      entry.message.sample_state_at = entry.message.st_at_arrival;
    }
  }
  record.footer->largest_lag = Duration(0);
  return record;
}

TEST(Audit, FreeRunningIsNotSynchronised) {
  const Verdict verdict = audit(free_running());
  EXPECT_FALSE(verdict.synchronised);
  EXPECT_TRUE(verdict.passed()) << to_text(verdict);
}

TEST(Audit, FreeRunningMustNotHold) {
  Record record = free_running();
  record.interactions[3].message.st_at_arrival -= kStep;
  EXPECT_EQ(rules_of(audit(record)), Rules{8});
}

Interaction& first_reading(Record& record) {
  return std::ranges::find_if(
             record.interactions,
             [](const Entry& entry) { return entry.message.kind == record::kSensor; })
      ->message;
}

TEST(Audit, FreeRunningReadsTheStateOnArrival) {
  for (const Duration off : {kStep, -kStep, Duration(1)}) {
    Record record = free_running();
    *first_reading(record).sample_state_at += off;
    const Verdict verdict = audit(record);
    EXPECT_EQ(rules_of(verdict), Rules{8}) << to_text(verdict);
    EXPECT_EQ(verdict.findings.size(), 1U);
  }
  Record record = free_running();
  first_reading(record).sample_state_at.reset();
  EXPECT_EQ(rules_of(audit(record)), Rules{0});
}

// A read that came a while before its periodic sensor measured.
Record waiting_for_next(Duration wait) {
  Record record = free_running();
  record.header.sensors = {{.uav = first_reading(record).uav,
                            .name = first_reading(record).sensor,
                            .kind = "imu",
                            .periodic = true,
                            .period = 10 * kStep,
                            .phase = Duration(0)}};
  Interaction& read = first_reading(record);
  read.sample_index =
      static_cast<std::uint64_t>(read.st_at_release.time_since_epoch() / (10 * kStep));
  record.header.sensors[0].phase =
      read.st_at_release.time_since_epoch() - read.sample_index * 10 * kStep;
  read.sampled_at = read.st_at_release;
  read.st_at_arrival = read.st_at_release - wait;
  return record;
}

TEST(Audit, FreeRunningReadsMayWaitForTheNextMeasurement) {
  const Verdict verdict = audit(waiting_for_next(9 * kStep));
  EXPECT_TRUE(verdict.passed()) << to_text(verdict);
}

// At 30 Hz the measurements lie between the boundaries. The read after one that was released at its
// boundary comes before its instant.
TEST(Audit, FreeRunningReadsMayFollowAMeasurementBetweenBoundaries) {
  const auto between = [](Duration wait) {
    Record record = waiting_for_next(wait);
    constexpr Duration kBehind = 2 * kStep / 3;
    record.header.sensors[0].phase += kBehind;
    *first_reading(record).sampled_at += kBehind;
    return record;
  };
  EXPECT_TRUE(audit(between(10 * kStep)).passed()) << to_text(audit(between(10 * kStep)));
  EXPECT_EQ(rules_of(audit(between(11 * kStep))), Rules{8}) << "missed a measurement";
}

TEST(Audit, FreeRunningReadsMayNotWaitForAnythingElse) {
  const auto altered = [](const std::function<void(Record&)>& alter) {
    Record record = waiting_for_next(9 * kStep);
    alter(record);
    return rules_of(audit(record));
  };
  EXPECT_EQ(rules_of(audit(waiting_for_next(11 * kStep))), Rules{8}) << "missed a measurement";
  EXPECT_EQ(altered([](Record& r) { *first_reading(r).sampled_at -= Duration(1); }), Rules{8});
  EXPECT_EQ(altered([](Record& r) { first_reading(r).sample_index += 1; }), Rules{8});
  EXPECT_EQ(altered([](Record& r) { r.header.sensors[0].periodic = false; }), Rules{8});
  EXPECT_EQ(altered([](Record& r) { r.header.sensors.clear(); }), Rules{8});
}

TEST(Audit, FreeRunningRecordsMustBeConsistent) {
  Record record = free_running();
  record.footer->interactions -= 1;
  record.ground_truth.erase(record.ground_truth.begin());
  EXPECT_EQ(rules_of(audit(record)), Rules{0});
}

TEST(Audit, EmptyRecordDoesNotPass) {
  EXPECT_FALSE(audit(Record{}).passed());
}

TEST(Audit, FindingsAreBounded) {
  Record record = generate({.interactions_per_sut = 5000});
  for (Entry& entry : record.interactions) {
    entry.message.lag -= Duration(1);
  }
  const Verdict verdict = audit(record);
  EXPECT_EQ(verdict.findings.size(), kMaxFindings);
  EXPECT_GT(verdict.further_findings, 0U);
}

// Any single time changed anywhere is noticed, and nothing that a record can say breaks the audit.
TEST(Audit, RandomChangesOfTimesAreNoticed) {
  const Record valid = generate({.seed = 9, .interactions_per_sut = 60, .wall_times = false});
  KeyedRandom random({.seed = 2});
  constexpr std::int64_t kExtremes[] = {0, -1, std::numeric_limits<std::int64_t>::max(),
                                        std::numeric_limits<std::int64_t>::min()};
  for (int round = 0; round < 3000; ++round) {
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
    bool changed = false;
    switch (random.bits() % 4) {
      case 0:
        changed = alter(m.request_at);
        break;
      case 1:
        changed = alter(m.reply_at);
        break;
      case 2:
        changed = alter(m.st_at_release);
        break;
      default:
        changed = alter(m.st_at_arrival);
    }
    EXPECT_EQ(audit(record).findings.empty(), !changed) << "round " << round;
  }
}

// One to two seconds of CPU time; the limit leaves room for sanitizers.
TEST(Audit, AMillionInteractionsWithinSeconds) {
  const Record record = generate({.suts = 4, .interactions_per_sut = 250'000});
  ASSERT_EQ(record.interactions.size(), 1'000'000U);
  const std::clock_t start = std::clock();
  const Verdict verdict = audit(record);
  const double spent_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_TRUE(verdict.passed()) << to_text(verdict);
  RecordProperty("seconds", std::to_string(spent_s));
  EXPECT_LT(spent_s, 20.0);
}

}  // namespace
}  // namespace tether::audit
