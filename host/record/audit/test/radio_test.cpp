#include "altered_record.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace tether::audit {
namespace {

using record::Record;

// "a" sends at 1.5 ms; it arrives at "b" at 1.7 ms, who receives it, and then nothing until 4 ms.
Record exchange() {
  Record record;
  record.header.policy = record::kConservativeBarrier;
  record.header.step = kStep;
  record.header.suts = {{.uav = "a", .sut = "s", .clock = {computer::ClockKind::kScripted}},
                        {.uav = "b", .sut = "s", .clock = {computer::ClockKind::kScripted}}};
  record.header.radio = {"log_distance", Duration(100'000), 8e6};
  record.interactions = {
      call("a", "send", 1'500'000, 1'500'000, 1), call("b", "receive", 1'000'000, 1'700'000, 1),
      call("b", "receive", 2'000'000, 4'000'000, 2), call("a", "finish", 5'000'000, 5'000'000, 2),
      call("b", "finish", 5'000'000, 5'000'000, 3)};
  record::Interaction& received = record.interactions[1].message;
  received.receive_until = from_ns<ExecTime>(3'000'000);
  received.received = {"a", 1, from_ns<SimTime>(1'700'000)};
  record.interactions[2].message.receive_until = from_ns<ExecTime>(4'000'000);
  record.radio = {{SimTime(kStep),
                   2,
                   {.uav = "a",
                    .sequence = 1,
                    .to = "b",
                    .bytes = 100,
                    .sent_at = from_ns<SimTime>(1'500'000),
                    .at = from_ns<SimTime>(1'700'000),
                    .outcome = "delivered"}}};
  for (std::size_t i = 0; i < record.interactions.size(); ++i)
    record.interactions[i].order = i < 2 ? i : i + 1;
  record.footer.emplace();
  record.footer->end = "finished";
  record.footer->st_at_end = from_ns<SimTime>(5'000'000);
  record.footer->et_at_end = {from_ns<ExecTime>(5'000'000), from_ns<ExecTime>(5'000'000)};
  set_figures(record);
  return record;
}

TEST(AuditOfRadio, AcceptsAnExchange) {
  EXPECT_TRUE(audit(exchange()).passed()) << to_text(audit(exchange()));
}

TEST(AuditOfRadio, FindsViolations) {
  for (const Planted& planted : std::vector<Planted>{
           {"to itself", {0, 1}, [](Record& r) { r.radio[0].message.to = "a"; }},
           {"an unknown outcome",
            {0},
            [](Record& r) {
              r.radio[0].message.outcome = "eaten";
              r.interactions[1].message.received.reset();
              r.interactions[1].message.receive_until = r.interactions[1].message.reply_at;
            }},
           {"two fates",
            {0},
            [](Record& r) {
              r.radio.push_back(r.radio[0]);
              r.radio[1].message.outcome = "noise";
            }},
           {"no fate", {0, 1}, [](Record& r) { r.radio.clear(); }},
           {"not sent", {0}, [](Record& r) { r.interactions[0].message.kind = "finish"; }},
           {"sent at another time",
            {1},
            [](Record& r) { r.radio[0].message.sent_at -= Duration(1); }},
           {"faster than its bytes", {1}, [](Record& r) { r.radio[0].message.bytes = 101; }},
           {"received before it arrived",
            {1},
            [](Record& r) {
              r.radio[0].message.at += Duration(1);
              r.interactions[1].message.received->arrived_at += Duration(1);
            }},
           {"another time of arrival",
            {1},
            [](Record& r) { r.interactions[1].message.received->arrived_at -= Duration(1); }},
           {"received late",
            {3},
            [](Record& r) {
              r.interactions[1].message.reply_at += Duration(1);
              r.interactions[1].message.grid_error += Duration(1);
              set_figures(r);
            }},
           {"missed",
            {3},
            [](Record& r) {
              r.interactions[1].message.received.reset();
              r.interactions[1].message.receive_until = r.interactions[1].message.reply_at;
            }},
           {"an early timeout", {7}, [](Record& r) {
              *r.interactions[2].message.receive_until += Duration(1);
            }}}) {
    Record record = exchange();
    planted.plant(record);
    Rules rules = rules_of(record);
    for (const int rule : planted.rules) EXPECT_TRUE(rules.contains(rule)) << planted.what;
    EXPECT_FALSE(audit(record).passed()) << planted.what;
  }
}

// "b" has several threads. It stops at 1.9 ms for the end of a sleep, and resumes before it hears
// that another reply is due since 1.7 ms.
Record concurrent_exchange() {
  Record record = exchange();
  record.header.suts[1].concurrent = true;
  for (Entry& entry : record.interactions) entry.order = 10 * (entry.order + 1);
  record.radio[0].order = 14;
  record::Interaction& second = record.interactions[2].message;
  second.request_at = from_ns<ExecTime>(2'500'000);
  set_lag(second);
  const auto add_stop = [&](std::uint64_t order, int st_ms, int at_us, int reply_at_us) {
    record::Stop stop{"b", ExecTime(std::chrono::microseconds(at_us)), {}, {}};
    if (reply_at_us > 0) stop.reply_at = ExecTime(std::chrono::microseconds(reply_at_us));
    record.stops.push_back({SimTime(st_ms * kStep), order, stop});
  };
  add_stop(11, 1, 1'000, 0);
  add_stop(12, 1, 1'900, 1'900);
  add_stop(15, 1, 2'200, 1'700);
  add_stop(35, 2, 2'500, 0);
  add_stop(36, 4, 4'000, 4'000);
  add_stop(55, 5, 5'000, 5'000);
  for (Entry& entry : record.interactions)
    if (entry.message.uav == "b" && entry.message.sequence > 1) ++entry.message.sequence;
  Entry sleep = call("b", "sleep", 1'200'000, 1'900'000, 2);
  sleep.order = 13;
  sleep.message.sleep_until = sleep.message.reply_at;
  record.interactions.insert(record.interactions.begin() + 1, sleep);
  set_figures(record);
  return record;
}

TEST(AuditOfRadio, AcceptsThatAThreadedSutHearsOfAMessageAfterAStop) {
  const Record record = concurrent_exchange();
  EXPECT_TRUE(audit(record).passed()) << to_text(audit(record));
  for (const Planted& planted : std::vector<Planted>{
           {"it knew, and resumed",
            {0},
            [](Record& r) { r.stops[1].message.reply_at = r.stops[2].message.reply_at; }},
           {"a reply to a sleep after a later one",
            {0, 5},
            [](Record& r) { std::swap(r.interactions[1].message, r.interactions[2].message); }},
           {"a stop without its reply",
            {0},
            [](Record& r) { r.stops[4].message.reply_at.reset(); }},
           {"a reply that never came", {0}, [](Record& r) {
              r.stops[3].message.reply_at = r.stops[3].message.at;
            }}}) {
    Record bad = concurrent_exchange();
    planted.plant(bad);
    set_figures(bad);
    EXPECT_EQ(rules_of(bad), planted.rules) << planted.what;
  }
}

// Instead of the sleep, another call waits for a message: the first one gets it, and hears so
// later.
TEST(AuditOfRadio, AcceptsThatOneOfTwoThatWaitGetsTheMessage) {
  const auto two_wait = [] {
    Record record = concurrent_exchange();
    record::Interaction& second = record.interactions[1].message;
    second.kind = record::kReceive;
    second.receive_until = second.sleep_until;
    second.sleep_until.reset();
    return record;
  };
  const Record record = two_wait();
  EXPECT_TRUE(audit(record).passed()) << to_text(audit(record));
  Record nobody = two_wait();
  nobody.interactions[2].message.received.reset();
  EXPECT_TRUE(rules_of(nobody).contains(3)) << "both waited, and it had arrived";
}

}  // namespace
}  // namespace tether::audit
