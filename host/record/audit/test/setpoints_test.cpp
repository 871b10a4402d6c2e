#include "checks.h"
#include "report.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base/time.h>

namespace tether::audit {
namespace {

using record::CommandEffect;
using record::Interaction;
using record::Record;
using std::chrono::microseconds;
using std::chrono::milliseconds;

SimTime st_ms(std::int64_t value) {
  return SimTime(milliseconds(value));
}

record::Setpoint position(double x_m, Duration after = Duration(0)) {
  return {.after = after, .mask = 1, .p_WB_m = {x_m, 0, 1}};
}

void command(Record& record, std::uint64_t sequence, Duration at, Duration latency,
             std::vector<record::Setpoint> setpoints) {
  Interaction m;
  m.uav = "a";
  m.sequence = sequence;
  m.kind = record::kCommand;
  m.request_at = m.reply_at = ExecTime(at);
  m.command_latency = latency;
  m.setpoints = std::move(setpoints);
  const auto arrival = SimTime(at + latency);
  m.effect_at = StepGrid(milliseconds(1)).ceil(arrival);
  m.grid_error = *m.effect_at - arrival;
  m.st_at_arrival = m.st_at_release = StepGrid(milliseconds(1)).floor(SimTime(at));
  record.interactions.push_back({m.st_at_release, 1000 * sequence, m});
}

void effect(Record& record, std::uint64_t sequence, std::uint64_t index, std::int64_t at_ms,
            std::optional<record::Setpoint> setpoint, std::string loss = "") {
  CommandEffect m;
  m.uav = "a";
  m.sequence = sequence;
  m.applied_at = st_ms(at_ms);
  if (setpoint) setpoint->after = Duration(0);
  m.setpoint = setpoint;
  m.index = index;
  m.loss = std::move(loss);
  record.commands.push_back({m.applied_at, 1000 * sequence + 1 + index, m});
}

/// A trajectory that a command interrupts, which a loss follows; then a command that would have
/// overtaken the one before, and arrives with it.
Record sound() {
  Record record;
  record.header.policy = record::kConservativeBarrier;
  record.header.step = milliseconds(1);
  record.header.time_limit = milliseconds(1000);
  record::SutInfo& sut = record.header.suts.emplace_back();
  sut.uav = "a";
  sut.command_latency = microseconds(100);
  sut.max_command_latency = milliseconds(9);
  sut.setpoint_timeout = milliseconds(20);
  sut.on_setpoint_loss = "brake";
  const auto second = position(2, milliseconds(5)), third = position(3, milliseconds(10));
  command(record, 1, milliseconds(10), milliseconds(1), {position(1), second, third});
  effect(record, 1, 0, 11, position(1));
  effect(record, 1, 1, 16, second);
  command(record, 2, milliseconds(18), microseconds(1500), {position(4)});
  effect(record, 2, 0, 20, position(4));
  effect(record, 2, 0, 40, std::nullopt, "brake");  // after 39.5 ms
  command(record, 3, milliseconds(50), milliseconds(5), {position(5)});
  command(record, 4, milliseconds(52), milliseconds(3), {position(6)});
  effect(record, 3, 0, 55, position(5));
  effect(record, 4, 0, 55, position(6));
  record.footer.emplace();
  record.footer->end = "finished";
  record.footer->st_at_end = st_ms(60);
  return record;
}

std::vector<Finding> setpoint_findings(const Record& record) {
  Verdict verdict;
  Report report(verdict);
  const Boundaries grid(record.header.step);
  check_setpoints(record, report);
  check_commands(record, grid, report);
  check_interactions(record, grid, report);
  return verdict.findings;
}

TEST(AuditOfSetpoints, AcceptsWhatTheRulesAllow) {
  for (const Finding& finding : setpoint_findings(sound())) ADD_FAILURE() << finding.what;
}

TEST(AuditOfSetpoints, FindsPlantedFaults) {
  const std::vector<std::pair<std::string, std::function<void(Record&)>>> faults = {
      {"a set-point is changed", [](Record& r) { r.commands[1].message.setpoint->p_WB_m[0] = 9; }},
      {"a set-point is late",
       [](Record& r) { r.commands[1].message.applied_at += milliseconds(1); }},
      {"a set-point is missing", [](Record& r) { r.commands.erase(r.commands.begin() + 1); }},
      {"an interrupted trajectory goes on",
       [](Record& r) {
         auto later = r.commands[1];
         later.message.index = 2;
         later.message.applied_at = st_ms(21);
         later.message.setpoint = position(3);
         r.commands.insert(r.commands.begin() + 2, later);
       }},
      {"a loss is missing", [](Record& r) { r.commands.erase(r.commands.begin() + 3); }},
      {"a loss is early", [](Record& r) { r.commands[3].message.applied_at -= milliseconds(1); }},
      {"a loss has another effect", [](Record& r) { r.commands[3].message.loss = "land"; }},
      {"a loss without a timeout", [](Record& r) { r.header.suts[0].setpoint_timeout = {}; }},
      {"a latency that cannot be drawn",
       [](Record& r) { r.header.suts[0].max_command_latency = milliseconds(2); }},
      {"a latency that is too short",
       [](Record& r) { r.header.suts[0].command_latency = microseconds(1200); }},
      {"a command overtakes", [](Record& r) {
         r.interactions[3].message.command_latency = milliseconds(1);
         r.interactions[3].message.effect_at = st_ms(53);
       }}};
  for (const auto& [name, plant] : faults) {
    Record record = sound();
    plant(record);
    EXPECT_FALSE(setpoint_findings(record).empty()) << name;
  }
}

}  // namespace
}  // namespace tether::audit
