#include "altered_record.h"

#include <vector>

#include <gtest/gtest.h>

namespace tether::audit {
namespace {

using record::Record;

// The battery has a charge of 0.9 at 1 ms and of 0.5 at 3 ms; "a" reads it at 3 ms and at 4.5 ms.
Record readings() {
  Record record;
  record.header.policy = record::kConservativeBarrier;
  record.header.step = kStep;
  record.header.suts = {{.uav = "a", .sut = "s", .clock = {computer::ClockKind::kScripted}}};
  for (const auto& [ms, charge] : {std::pair{1, 0.9}, {3, 0.5}, {5, 0.3}})
    record.batteries.push_back(
        {SimTime(ms * kStep), 0, {.uav = "a", .at = SimTime(ms * kStep), .charge = charge}});
  std::uint64_t sequence = 0;
  for (const auto& [us, charge] : {std::pair{3'000, 0.5}, {4'500, 0.4}, {5'000, 0.0}}) {
    record::Interaction m;
    m.uav = "a";
    m.sequence = ++sequence;
    m.kind = charge > 0.0 ? record::kBattery : record::kFinish;
    if (charge > 0.0) m.battery = {.charge = charge};
    m.request_at = m.reply_at = from_ns<ExecTime>(1'000 * std::int64_t{us});
    m.st_at_arrival = m.st_at_release = from_ns<SimTime>(floor_ns(to_ns(m.reply_at), 1'000'000));
    m.grid_error = same_instant(m.reply_at) - m.st_at_release;
    set_lag(m);
    record.interactions.push_back({m.st_at_release, sequence, m});
  }
  record.footer.emplace();
  record.footer->end = "finished";
  record.footer->st_at_end = SimTime(5 * kStep);
  record.footer->et_at_end = {ExecTime(5 * kStep)};
  set_figures(record);
  return record;
}

TEST(AuditOfBattery, AcceptsReadings) {
  EXPECT_TRUE(audit(readings()).passed()) << to_text(audit(readings()));
}

TEST(AuditOfBattery, FindsViolations) {
  for (const Planted& planted : std::vector<Planted>{
           {"no battery in the record", {0}, [](Record& r) { r.batteries.clear(); }},
           {"nothing read", {0}, [](Record& r) { r.interactions[0].message.battery.reset(); }},
           {"a finish that reads",
            {0},
            [](Record& r) { r.interactions[2].message.battery = {.charge = 0.3}; }},
           {"another voltage",
            {1},
            [](Record& r) { r.interactions[0].message.battery->voltage_V = 1.0; }},
           {"older than it says",
            {1},
            [](Record& r) { r.interactions[1].message.battery->charge = 0.6; }},
           {"of the future", {1}, [](Record& r) {
              r.interactions[1].message.battery->charge = 0.2;
            }}}) {
    Record record = readings();
    planted.plant(record);
    EXPECT_EQ(rules_of(record), planted.rules) << planted.what;
  }
}

}  // namespace
}  // namespace tether::audit
