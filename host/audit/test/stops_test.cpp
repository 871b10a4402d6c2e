#include "concurrent_generator.h"

#include <algorithm>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <tether/audit/audit.h>

// Concurrent SUTs: what keeps the rules passes, each planted breach is found.
namespace tether::audit {
namespace {

using record::Interaction;
using record::Record;
using Entry = record::Logged<Interaction>;
using Stop = record::Logged<record::Stop>;
using Rules = std::set<int>;

Rules rules_of(const Verdict& verdict) {
  Rules rules;
  for (const Finding& finding : verdict.findings) rules.insert(finding.rule);
  return rules;
}

class ConcurrentRecord : public testing::TestWithParam<int> {};

TEST_P(ConcurrentRecord, Passes) {
  const int seed = GetParam();
  const Record record = generate_concurrent({.seed = static_cast<std::uint64_t>(seed),
                                             .threads = 1 + seed % 7,
                                             .wall_factor = seed % 3 == 0 ? 0.25 : 1.0});
  ASSERT_GT(record.interactions.size(), 200U);
  ASSERT_GT(record.stops.size(), 100U);
  const Verdict verdict = audit(record);
  EXPECT_TRUE(verdict.passed()) << to_text(verdict);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ConcurrentRecord, testing::Range(1, 41));

// The run breaks off: calls are open, the last stop may have been for one of them.
TEST(ConcurrentRecordCut, PassesWhereverItIsCut) {
  for (std::uint64_t cut = 5; cut < 400; cut += 7) {
    Record record = generate_concurrent({.seed = 3});
    const auto later = [&](const auto& logged) { return logged.order >= cut; };
    std::erase_if(record.interactions, later);
    std::erase_if(record.commands, later);
    std::erase_if(record.stops, later);
    record.footer.reset();
    const Verdict verdict = audit(record);
    EXPECT_TRUE(verdict.findings.empty()) << cut << "\n" << to_text(verdict);
  }
}

Entry& find(Record& record, const std::function<bool(const Interaction&)>& wanted, int skip = 5) {
  for (Entry& entry : record.interactions)
    if (wanted(entry.message) && skip-- == 0) return entry;
  throw std::logic_error("the generated record has no such interaction");
}
Stop& find_stop(Record& record, const std::function<bool(const record::Stop&)>& wanted,
                int skip = 20) {
  for (Stop& stop : record.stops)
    if (wanted(stop.message) && skip-- == 0) return stop;
  throw std::logic_error("the generated record has no such stop");
}
const Interaction* with_sequence(const Record& record, std::uint64_t sequence) {
  const auto found = std::ranges::find_if(
      record.interactions, [&](const Entry& entry) { return entry.message.sequence == sequence; });
  return found == record.interactions.end() ? nullptr : &found->message;
}

bool is_for_a_reply(const record::Stop& stop) {
  return stop.reply_at.has_value();
}
bool is_late(const record::Stop& stop) {
  return stop.reply_at && stop.at > *stop.reply_at + Duration(10);
}
bool is_look(const Interaction& m) {
  return m.only_if_available;
}

// What the footer sums up stays true, so that only the planted breach shows.
void keep_footer(Record& record) {
  record::Footer& footer = *record.footer;
  footer.stops = record.stops.size();
  footer.largest_overshoot = Duration(0);
  for (const Stop& stop : record.stops)
    if (stop.message.reply_at)
      footer.largest_overshoot =
          std::max(footer.largest_overshoot, stop.message.at - *stop.message.reply_at);
}

struct Planted {
  const char* what;
  Rules rules;  ///< exactly these
  std::function<void(Record&)> plant;
};

void PrintTo(const Planted& planted, std::ostream* out) {
  *out << planted.what;
}

const Planted kPlanted[] = {
    {"stamp_goes_back",
     {5},
     [](Record& r) {
       Interaction& m = find(r, [&](const Interaction& i) {
                          const Interaction* next = with_sequence(r, i.sequence + 1);
                          return i.kind == record::kSleep && next &&
                                 *i.sleep_until > next->request_at + Duration(1);
                        }).message;
       const Interaction* next = with_sequence(r, m.sequence + 1);
       m.request_at = next->request_at + Duration(1);
       m.lag = lag(m.request_at, m.st_at_arrival);
       r.footer->largest_lag = std::max(r.footer->largest_lag, m.lag);
     }},
    {"st_on_arrival_goes_back",
     {4, 5},
     [](Record& r) {
       Interaction& m = find(r, [&](const Interaction& i) {
                          const Interaction* before = with_sequence(r, i.sequence - 1);
                          return before && before->st_at_arrival == i.st_at_arrival &&
                                 i.st_at_arrival > SimTime(Duration(5'000'000));
                        }).message;
       m.st_at_arrival -= Duration(1'000'000);
       m.lag = lag(m.request_at, m.st_at_arrival);
       r.footer->largest_lag = std::max(r.footer->largest_lag, m.lag);
     }},
    {"sequence_twice",
     {5},
     [](Record& r) {
       Interaction& m =
           find(
               r,
               [&](const Interaction& i) {
                 const Interaction* next = with_sequence(r, i.sequence + 1);
                 return i.kind == record::kSleep && next && next->st_at_arrival == i.st_at_arrival;
               },
               0)
               .message;
       ++m.sequence;
     }},
    {"too_many_are_missing",
     {5},
     [](Record& r) {
       for (Entry& entry : r.interactions)
         if (entry.message.kind == record::kFinish) entry.message.sequence += 100;
     }},
    {"replied_where_it_had_not_stopped",
     {0, 5},
     [](Record& r) {
       r.stops.erase(r.stops.begin() + (&find_stop(r, is_for_a_reply) - r.stops.data()));
       keep_footer(r);
     }},
    {"stopped_before_the_reply",
     {5},
     [](Record& r) {
       Stop& stop = find_stop(r, is_late);
       stop.message.at = *stop.message.reply_at - Duration(1);
       keep_footer(r);
     }},
    {"stop_goes_back",
     {4, 5},
     [](Record& r) {
       Stop& stop = find_stop(r, is_for_a_reply);
       stop.message.at = (&stop - 1)->message.at - Duration(1);
       keep_footer(r);
     }},
    {"stopped_before_a_request_it_follows",
     {5},
     [](Record& r) {
       Stop& stop = find_stop(
           r, [](const record::Stop& s) { return !s.reply_at; }, 5);
       stop.message.at -= Duration(900'000);
     }},
    {"requested_before_its_last_stop",
     {5},
     [](Record& r) {
       Stop& stop = find_stop(r, is_for_a_reply);
       stop.message.at += Duration(30'000'000);
       keep_footer(r);
     }},
    {"went_on_before_its_reply",
     {0, 5},
     [](Record& r) {
       Stop stop = find_stop(r, is_for_a_reply);
       const std::uint64_t place = stop.order + 1;
       const auto make_room = [&](auto& messages) {
         for (auto& logged : messages) logged.order += logged.order >= place ? 1 : 0;
       };
       make_room(r.interactions);
       make_room(r.commands);
       make_room(r.stops);
       const auto after = r.stops.begin() + (&find_stop(r, is_for_a_reply) - r.stops.data()) + 1;
       stop.order = place;
       stop.message.reply_at.reset();
       r.stops.insert(after, stop);
       (after - 1)->message.at -= Duration(0);
       keep_footer(r);
     }},
    {"st_ahead_of_a_stop",
     {4, 5},
     [](Record& r) {
       Stop& stop = r.stops.back();
       stop.message.at = same_instant(stop.at) - Duration(1);
       keep_footer(r);
     }},
    {"stop_for_another_reply",
     {0},
     [](Record& r) {
       Stop& stop = find_stop(r, is_late);
       *stop.message.reply_at += Duration(1);
       keep_footer(r);
     }},
    {"stop_for_no_reply",
     {0},
     [](Record& r) {
       find_stop(r, is_for_a_reply).message.reply_at.reset();
       keep_footer(r);
     }},
    {"replies_out_of_order",
     {5},
     [](Record& r) {
       for (std::size_t i = 1; i < r.interactions.size(); ++i) {
         Entry& a = r.interactions[i - 1];
         Entry& b = r.interactions[i];
         if (a.at != b.at || b.order != a.order + 1) continue;
         if (a.message.kind == record::kCommand || b.message.kind == record::kCommand) continue;
         std::swap(a.order, b.order);
         std::swap(a, b);
         return;
       }
       throw std::logic_error("no two replies of one ST");
     }},
    {"released_a_step_late",
     {0, 3, 4},
     [](Record& r) {
       find(r, [](const Interaction& m) {
         return m.kind == record::kSleep;
       }).message.st_at_release += Duration(1'000'000);
     }},
    {"et_faster_than_the_hosts_clock", {5}, [](Record& r) { r.header.suts[0].cpu_factor = 0.5; }},
    {"answered_after_its_finish",
     {5},
     [](Record& r) {
       std::size_t last = r.interactions.size() - 1;
       while (r.interactions[last - 1].at != r.interactions[last].at) --last;
       r.interactions[last - 1].message.kind = record::kFinish;
     }},
    {"found_nothing_without_being_asked_to",
     {0},
     [](Record& r) {
       find(r, [](const Interaction& m) {
         return is_look(m) && !m.sampled_at;
       }).message.only_if_available = false;
     }},
    {"a_look_that_waited",
     {5},
     [](Record& r) {
       find(r, [](const Interaction& m) {
         return m.sensor == "camera" && m.reply_at > m.request_at;
       }).message.only_if_available = true;
     }},
    {"stop_of_a_stranger",
     {0, 5},
     [](Record& r) { find_stop(r, is_for_a_reply).message.uav = "b"; }},
    {"stops_miscounted", {0}, [](Record& r) { ++r.footer->stops; }},
    {"overshoot_misstated", {0}, [](Record& r) { r.footer->largest_overshoot += Duration(1); }},
    {"ended_before_its_last_stop", {5}, [](Record& r) { r.footer->et_at_end[0] -= Duration(1); }},
};

class PlantedStop : public testing::TestWithParam<Planted> {};

TEST_P(PlantedStop, IsFound) {
  Record record = generate_concurrent({.seed = 11, .threads = 5});
  ASSERT_TRUE(audit(record).passed());
  GetParam().plant(record);
  const Verdict verdict = audit(record);
  EXPECT_EQ(rules_of(verdict), GetParam().rules) << to_text(verdict);
}

INSTANTIATE_TEST_SUITE_P(All, PlantedStop, testing::ValuesIn(kPlanted),
                         [](const auto& planted) { return std::string(planted.param.what); });

// A look that found a measurement is made to say that it found none: found out whether it asked for
// a new one or for the newest.
TEST(MissedMeasurement, IsFound) {
  int of_new = 0, of_latest = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Record sound = generate_concurrent({.seed = seed, .threads = 2});
    for (std::size_t i = 0; i < sound.interactions.size(); ++i) {
      if (!is_look(sound.interactions[i].message) || !sound.interactions[i].message.sampled_at)
        continue;
      Record record = sound;
      Interaction& m = record.interactions[i].message;
      ++(m.latest ? of_latest : of_new);
      m.sampled_at.reset();
      m.sample_state_at.reset();
      m.available_at.reset();
      m.sample_index = 0;
      m.grid_error = same_instant(m.reply_at) - m.st_at_release;
      EXPECT_TRUE(rules_of(audit(record)).contains(1)) << seed << " " << m.sequence;
    }
  }
  EXPECT_GT(of_new, 0);
  EXPECT_GT(of_latest, 0);
}

TEST(FreeRunningConcurrent, HasNoStops) {
  Record record = generate_concurrent({.seed = 2});
  record.header.policy = record::kFreeRunning;
  const Verdict verdict = audit(record);
  EXPECT_TRUE(std::ranges::any_of(verdict.findings, [](const Finding& finding) {
    return finding.what == "a stop in a free-running record";
  }));
}

// Two threads wait for one sensor: the second gets the measurement after the first one's.
Record free_threads(std::uint64_t first, std::uint64_t second) {
  constexpr Duration kPeriod = std::chrono::milliseconds(10);
  Record record;
  record.header.policy = record::kFreeRunning;
  record.header.step = std::chrono::milliseconds(1);
  record.header.suts.emplace_back().uav = "u";
  record.header.suts[0].concurrent = true;
  record::SensorInfo& imu = record.header.sensors.emplace_back();
  imu.uav = "u";
  imu.name = imu.kind = "imu";
  imu.periodic = true;
  imu.period = kPeriod;
  for (const std::uint64_t index : {first, second}) {
    Entry entry;
    entry.order = record.interactions.size();
    Interaction& read = entry.message;
    read.uav = "u";
    read.sequence = entry.order + 1;
    read.kind = record::kSensor;
    read.sensor = "imu";
    read.sample_index = index;
    read.st_at_arrival = SimTime{} + kPeriod / 2;
    entry.at = read.st_at_release = SimTime{} + index * kPeriod;
    read.sampled_at = read.sample_state_at = read.available_at = entry.at;
    record.interactions.push_back(entry);
  }
  return record;
}

TEST(FreeRunningConcurrent, ThreadsGetMeasurementsOfTheirOwn) {
  EXPECT_TRUE(audit(free_threads(1, 2)).findings.empty()) << to_text(audit(free_threads(1, 2)));
  EXPECT_EQ(rules_of(audit(free_threads(1, 3))), Rules{8}) << "missed a measurement";
}

// That a later request took a measurement is no reason not to get it.
TEST(FreeRunningConcurrent, ThreadsGetThemInTheirOrder) {
  Record record = free_threads(1, 2);
  record.interactions[0].message.sequence = 2;
  record.interactions[1].message.sequence = 1;
  EXPECT_EQ(rules_of(audit(record)), Rules{8});
}

}  // namespace
}  // namespace tether::audit
