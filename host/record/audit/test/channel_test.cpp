#include "altered_record.h"
#include "checks.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>

// What becomes of messages, by the settings of the radio.
namespace tether::audit {
namespace {

using record::Record;
using std::chrono::microseconds;

// "a" is 2 m from "b", and sends it a message of 64 bytes: 100 bytes with its header, 100 µs at
// 8 Mbit/s, and 20 µs of preamble.
Record one_message() {
  Record record;
  record.header.step = kStep;
  record.header.suts = {{.uav = "a", .sut = "s", .clock = {computer::ClockKind::kScripted}},
                        {.uav = "b", .sut = "s", .clock = {computer::ClockKind::kScripted}}};
  record::RadioInfo& radio = record.header.radio;
  radio = {.model = "log_distance",
           .data_rate_bit_s = 8e6,
           .inbox_messages = 1,
           .access = "csma",
           .queue_messages = 1};
  radio.header_bytes = 36;
  radio.delay = microseconds(10);
  radio.preamble = microseconds(20);
  radio.slot = microseconds(9);
  radio.bandwidth_hz = 1e6;
  radio.noise_figure_db = 7.0;
  radio.reference_loss_db = 40.0;
  radio.exponent = 2.0;
  radio.wall_loss_db = 6.0;
  for (const int ms : {0, 10})
    for (const char* uav : {"a", "b"}) {
      record::GroundTruth truth{.uav = uav, .at = SimTime(ms * kStep)};
      truth.p_WB_m[0] = *uav == 'b' ? 2.0 : 0.0;
      record.ground_truth.push_back({truth.at, 0, truth});
    }
  const SimTime began(microseconds(1'019));
  record.radio.push_back({SimTime(kStep),
                          0,
                          {.uav = "a",
                           .sequence = 1,
                           .to = "b",
                           .bytes = 64,
                           .sent_at = SimTime(microseconds(1'000)),
                           .at = began + microseconds(120),
                           .outcome = "delivered",
                           .began_at = began,
                           .distance_m = 2.0,
                           .walls = 0,
                           .snr_db = -40.0 - 20.0 * std::log10(2.0) + 174.0 - 60.0 - 7.0}});
  return record;
}

std::size_t channel_findings(const Record& record) {
  Verdict verdict;
  Report report(verdict);
  check_channel(record, Boundaries(kStep), report);
  for (const Finding& finding : verdict.findings) EXPECT_EQ(finding.rule, 0) << finding.what;
  return verdict.findings.size();
}

TEST(AuditOfTheChannel, FindsWhatItsSettingsContradict) {
  EXPECT_EQ(channel_findings(one_message()), 0u);
  for (const Planted& planted : std::vector<Planted>{
           {"another fate", {}, [](Record& r) { r.radio[0].message.outcome = "noise"; }},
           {"a longer message", {}, [](Record& r) { r.radio[0].message.bytes += 1; }},
           {"a later arrival", {}, [](Record& r) { r.radio[0].message.at += kNs; }},
           {"before it was ready",
            {},
            [](Record& r) { r.radio[0].message.sent_at += microseconds(10); }},
           {"another distance", {}, [](Record& r) { *r.radio[0].message.distance_m += 0.1; }},
           {"a wall", {}, [](Record& r) { r.radio[0].message.walls = 1; }},
           {"a better signal", {}, [](Record& r) { *r.radio[0].message.snr_db += 0.1; }},
           {"no signal", {}, [](Record& r) { r.radio[0].message.snr_db.reset(); }},
           {"more power", {}, [](Record& r) { r.header.radio.tx_power_dbm += 0.1; }},
           {"shadowing", {}, [](Record& r) { r.header.radio.shadowing_db = 3.0; }},
           {"a full queue that is not", {}, [](Record& r) {
              record::RadioMessage& m = r.radio[0].message;
              m.outcome = "queue_full";
              m.began_at.reset();
              m.distance_m.reset();
              m.walls.reset();
              m.snr_db.reset();
            }}}) {
    Record record = one_message();
    planted.plant(record);
    EXPECT_GT(channel_findings(record), 0u) << planted.what;
  }
}

// The second message arrives before the first one was received: it has no room.
TEST(AuditOfTheChannel, CountsInboxes) {
  Record record = one_message();
  record.radio.push_back(record.radio[0]);
  record::RadioMessage& second = record.radio[1].message;
  second.sequence = 2;
  second.sent_at += microseconds(500);
  *second.began_at += microseconds(500);
  second.at += microseconds(500);
  EXPECT_EQ(channel_findings(record), 1u);
  second.outcome = "inbox_full";
  EXPECT_EQ(channel_findings(record), 0u);
  record::Interaction& heard = record.interactions.emplace_back().message;
  heard.uav = second.to;
  heard.received = {"autopilot", 1, {}};
  EXPECT_EQ(channel_findings(record), 0u)
      << "what comes from the flight controller waits elsewhere";
  record.interactions.clear();
  record.header.radio.inbox_messages = 2;
  EXPECT_EQ(channel_findings(record), 1u);
}

// "b" transmits while "a" does, and hears nothing.
TEST(AuditOfTheChannel, KnowsWhoTransmits) {
  Record record = one_message();
  record.radio.push_back(record.radio[0]);
  record::RadioMessage& back = record.radio[1].message;
  std::swap(back.uav, back.to);
  EXPECT_EQ(channel_findings(record), 2u);
  record.radio[0].message.outcome = back.outcome = "half_duplex";
  EXPECT_EQ(channel_findings(record), 0u);
}

// Ten messages, of which those that the draws drop are dropped.
TEST(AuditOfTheChannel, OfADistributionIsItsBoundsAndItsDraws) {
  Record good = one_message();
  good.header.radio = {.model = "distribution",
                       .least_delay = microseconds(10),
                       .data_rate_bit_s = 8e6,
                       .inbox_messages = 100,
                       .most_delay = microseconds(30),
                       .loss_probability = 0.4};
  good.radio.clear();
  for (std::uint64_t i = 1; i <= 10; ++i) {
    const SimTime sent_at(microseconds(100 * i));
    KeyedRandom random(
        {.seed = good.header.seed, .stream = random_stream("a", "b", "radio loss"), .index = i});
    good.radio.push_back({sent_at,
                          0,
                          {.uav = "a",
                           .sequence = i,
                           .to = "b",
                           .bytes = 64,
                           .sent_at = sent_at,
                           .at = sent_at + microseconds(64 + 20),
                           .outcome = random.uniform() < 0.4 ? "dropped" : "delivered"}});
  }
  EXPECT_EQ(channel_findings(good), 0u);
  for (const Planted& planted : std::vector<Planted>{
           {"too early", {}, [](Record& r) { r.radio[3].message.at -= microseconds(11); }},
           {"too late", {}, [](Record& r) { r.radio[3].message.at += microseconds(11); }},
           {"another fate",
            {},
            [](Record& r) {
              std::string& outcome = r.radio[3].message.outcome;
              outcome = outcome == "dropped" ? "delivered" : "dropped";
            }},
           {"a loss of a channel", {}, [](Record& r) { r.radio[3].message.outcome = "noise"; }},
           {"a transmission", {}, [](Record& r) { r.radio[3].message.snr_db = 3.0; }},
           {"bursts", {}, [](Record& r) { r.header.radio.burst_begin_probability = 1.0; }}}) {
    Record record = good;
    planted.plant(record);
    EXPECT_GT(channel_findings(record), 0u) << planted.what;
  }
}

TEST(AuditOfTheChannel, OfAnIdealRadioIsItsDelay) {
  Record record = one_message();
  record.header.radio = {.model = "ideal", .least_delay = microseconds(10), .inbox_messages = 1};
  record::RadioMessage& m = record.radio[0].message;
  m = {.uav = "a",
       .sequence = 1,
       .to = "b",
       .bytes = 64,
       .sent_at = m.sent_at,
       .at = m.sent_at + microseconds(10),
       .outcome = "delivered"};
  EXPECT_EQ(channel_findings(record), 0u);
  m.at += kNs;
  EXPECT_EQ(channel_findings(record), 1u);
}

}  // namespace
}  // namespace tether::audit
