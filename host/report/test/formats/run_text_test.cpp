#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/report/report.h>

namespace tether::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SimTime at(double s) {
  return SimTime{} + duration_from_seconds(s);
}

/// The text after the answer and its advice, which an empty line ends.
std::string summary(const std::string& text) {
  return text.substr(text.find("\n\n") + 2);
}

campaign::MetricValue metric(const char* label, const char* unit, std::optional<double> value) {
  campaign::MetricValue metric;
  metric.name = metric.kind = metric.label = label;
  metric.unit = unit;
  metric.value = value;
  return metric;
}

campaign::TrialResult flight() {
  campaign::TrialResult result;
  result.scenario = "turn";
  result.condition = "host";
  result.seed = 7;
  result.policy = "conservative_barrier";
  result.clock.kind = computer::ClockKind::kCpu;
  result.outcome = campaign::Outcome::kGoalReached;
  result.end = campaign::kEndFinished;
  result.reason = "every SUT reached its goal within the limits";
  result.sync.st_at_end = at(1.5614);
  result.sync.interactions = 50;
  result.this_run.wall = duration_from_seconds(1.182);
  return result;
}

campaign::TrialResult eventful_flight() {
  campaign::TrialResult result = flight();
  result.metrics = {metric("Oscillations", "1", 0.0), metric("Time required", "s", 1.56142),
                    metric("Least clearance", "m", std::nullopt)};
  result.metrics[0].max = 1.0;
  result.metrics[1].min = 0.5;
  result.metrics[2].missing_because = "the simulator measures no distances";
  judge::ClauseVerdict near{.uav = "uav1", .name = "near", .met = true, .margin = 0.25};
  near.unit = "m";
  near.decided_at = at(1.25);
  near.limited_by = "0.75 m at ST 0.5 s";
  result.clauses = {near, {.uav = "uav1", .name = "early"}};
  campaign::UavEnergy energy{.uav = "uav1"};
  energy.spent_J[0] = 123.456;
  energy.charge_from = 1.0;
  energy.charge_to = 0.75;
  energy.least_voltage_V = 12.0712;
  result.energy = {energy};
  record::Contact& hardest = result.contacts.emplace_back().hardest.emplace();
  hardest.with = "room";
  hardest.at = at(1.25);
  hardest.speed_m_s = 0.3021;
  record::Clearance& nearest = result.contacts[0].nearest.emplace();
  nearest.min_m = 0.94;
  nearest.to = "room";
  nearest.at = at(1.07);
  result.contacts[0].uav = "uav1";
  result.contacts[0].count = 1;
  result.contacts.emplace_back().uav = "uav2";
  result.emulator.program = "qemu-x86_64 7.2";
  result.emulator.cpu_model = "Nehalem";
  result.target = "pi";
  result.sync.stops = campaign::StopFigures{3, duration_from_seconds(0.00125)};
  result.profiles = {"paper_streaming", "mine"};
  result.versions = {{"simulator", "MuJoCo 2.2.2"}, {"tether", "1.0"}};
  result.warnings = {{Consequence::kMissing, {}, "model 'tree'", "is not found"},
                     {Consequence::kLooksDifferent, {}, "light 'sun'", "is brighter"}};
  result.audit = campaign::AuditVerdict{true, "passed: 50 interactions"};
  result.this_run.notes = {"the disk was full"};
  return result;
}

TEST(RunText, ListsEachMetricClauseAndUavAndHowTheRunWasFlown) {
  const ScratchFolder scratch;
  EXPECT_EQ(summary(run_text(eventful_flight(), scratch.path("run"))),
            R"(turn under "host", seed 7: goal_reached: every SUT reached its goal within the limits
  Oscillations          0  (limit 1)
  Time required         1.561 s  (at least 0.5)
  Least clearance       none: the simulator measures no distances
  near                  met, margin 0.25 m, decided at ST 1.250 s; 0.75 m at ST 0.5 s
  early                 MISSED
  energy of uav1        123.46 J: lift 123.5 J, moving 0 J, idle 0 J, computing 0 J, sensors 0 J, resistance 0 J
  charge of uav1        75.0 % left of 100.0 %, enough for 3.0 more such flights; at least 12.07 V
  uav1                  1 contact, the hardest with 'room' at ST 1.25 s and 0.302 m/s; least clearance 0.94 m, to 'room' at ST 1.07 s
  uav2                  contacts not reported
  simulated             1.561 s in 1.182 s of wall time, 50 interactions
  clock                 counted by qemu-x86_64 7.2, CPU model Nehalem
  target                pi
  stops of all threads  3, at most 1.250 ms late
  profiles              paper_streaming, mine
  simulator             MuJoCo 2.2.2
  missing               model 'tree'
  audit                 passed: 50 interactions
  note                  the disk was full
)");
}

TEST(RunText, BeginsWithTheAnswer) {
  const ScratchFolder scratch;
  campaign::TrialResult result = flight();
  result.metrics = {metric("Time required", "s", 4.0)};
  result.metrics[0].max = 3.0;
  result.outcome = campaign::Outcome::kGoalMissed;
  EXPECT_THAT(run_text(result, scratch.path("run")),
              testing::StartsWith(
                  "Goal missed: on “host” the flight does not meet time required ≤ "
                  "3 s. No condition that is clearly faster and otherwise the same was flown"));
}

TEST(RunText, NamesTheRecordOnlyIfThereIsOne) {
  const ScratchFolder scratch;
  EXPECT_THAT(run_text(flight(), scratch.path(".")), Not(HasSubstr("  record ")));
  const std::filesystem::path record = scratch.write("record.mcap", "");
  EXPECT_THAT(run_text(flight(), record.parent_path()),
              HasSubstr("  record     " + record.string() + "\n"));
}

TEST(RunText, SaysWhatTheTimeOfAnUnstampedClockIncludes) {
  const ScratchFolder scratch;
  campaign::TrialResult result = flight();
  result.clock.kind = computer::ClockKind::kUnstamped;
  EXPECT_THAT(run_text(result, scratch.path("run")),
              HasSubstr("  clock      unstamped: the coordinator measured the SUT's time, which "
                        "includes the link's\n"));
}

TEST(RunText, OfAFailedRunHasNoTableOfNothing) {
  const ScratchFolder scratch;
  campaign::TrialResult result = flight();
  result.metrics = {metric("Time required", "s", std::nullopt)};
  result.clauses = {{.uav = "uav1", .name = "early"}};
  campaign::invalidate(result, "the SUT was lost");
  result.metrics[0].missing_because = result.reason;
  result.end = "sut_lost";
  EXPECT_EQ(run_text(result, scratch.path("run")),
            "No answer: the SUT was lost.\n  → Fix this, then fly again.\n\n"
            "turn under \"host\", seed 7: failed\n"
            "  ended  at ST 1.561 s, after 50 interactions\n");
}

}  // namespace
}  // namespace tether::report
