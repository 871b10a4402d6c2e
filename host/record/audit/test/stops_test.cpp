#include "altered_record.h"
#include "concurrent_generator.h"

#include <string>

#include <gtest/gtest.h>

// Concurrent SUTs: records that keep the rules pass, and each planted violation is found.
namespace tether::audit {
namespace {

using record::Interaction;
using record::Record;
using Stop = record::Logged<record::Stop>;

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

// If the run is interrupted, calls are open, and the last stop may have been for one of them.
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
bool is_poll(const Interaction& m) {
  return m.only_if_available;
}
bool is_finish(const Interaction& m) {
  return m.kind == record::kFinish;
}

const Planted kPlantedStops[] = {
    {"timestamp_decreases",
     {5},
     [](Record& r) {
       Interaction& m = where(r, [&](const Interaction& i) {
         const Interaction* next = with_sequence(r, i.sequence + 1);
         return i.kind == record::kSleep && next && *i.sleep_until > next->request_at + Duration(1);
       });
       m.request_at = with_sequence(r, m.sequence + 1)->request_at + Duration(1);
       set_lag(m);
       set_figures(r);
     }},
    {"st_on_arrival_decreases",
     {4, 5},
     [](Record& r) {
       Interaction& m = where(r, [&](const Interaction& i) {
         const Interaction* before = with_sequence(r, i.sequence - 1);
         return before && before->st_at_arrival == i.st_at_arrival &&
                i.st_at_arrival > SimTime(Duration(5'000'000));
       });
       m.st_at_arrival -= Duration(1'000'000);
       set_lag(m);
       set_figures(r);
     }},
    {"sequence_twice",
     {5},
     [](Record& r) {
       const auto is_one = [&](const Interaction& i) {
         const Interaction* next = with_sequence(r, i.sequence + 1);
         return i.kind == record::kSleep && next && next->st_at_arrival == i.st_at_arrival;
       };
       ++where(r, is_one, 0).sequence;
     }},
    {"too_many_missing", {5}, [](Record& r) { where(r, is_finish, 0).sequence += 100; }},
    {"reply_without_stop",
     {0, 5},
     [](Record& r) {
       r.stops.erase(r.stops.begin() + (&find_stop(r, is_for_a_reply) - r.stops.data()));
       set_figures(r);
     }},
    {"stop_before_reply",
     {5},
     [](Record& r) {
       record::Stop& stop = find_stop(r, is_late).message;
       stop.at = *stop.reply_at - Duration(1);
       set_figures(r);
     }},
    {"stops_decrease",
     {4, 5},
     [](Record& r) {
       Stop& stop = find_stop(r, is_for_a_reply);
       stop.message.at = (&stop - 1)->message.at - Duration(1);
       set_figures(r);
     }},
    {"stop_before_earlier_request",
     {5},
     [](Record& r) {
       const auto is_for_none = [](const record::Stop& s) { return !s.reply_at; };
       find_stop(r, is_for_none, 5).message.at -= Duration(900'000);
     }},
    {"request_before_last_stop",
     {5},
     [](Record& r) {
       find_stop(r, is_for_a_reply).message.at += Duration(30'000'000);
       set_figures(r);
     }},
    {"resumed_before_reply",
     {0, 5},
     [](Record& r) {
       // A second stop follows before the reply of the first.
       const auto first = r.stops.begin() + (&find_stop(r, is_for_a_reply) - r.stops.data());
       Stop second = *first;
       ++second.order;
       second.message.reply_at.reset();
       const auto make_room = [&](auto& messages) {
         for (auto& logged : messages) logged.order += logged.order >= second.order ? 1 : 0;
       };
       make_room(r.interactions);
       make_room(r.commands);
       make_room(r.stops);
       r.stops.insert(first + 1, second);
       set_figures(r);
     }},
    {"st_ahead_of_stop",
     {4, 5},
     [](Record& r) {
       Stop& stop = r.stops.back();
       stop.message.at = same_instant(stop.at) - Duration(1);
       set_figures(r);
     }},
    {"stop_for_another_reply",
     {0},
     [](Record& r) {
       *find_stop(r, is_late).message.reply_at += Duration(1);
       set_figures(r);
     }},
    {"stop_for_no_reply",
     {0},
     [](Record& r) {
       find_stop(r, is_for_a_reply).message.reply_at.reset();
       set_figures(r);
     }},
    {"replies_out_of_order",
     {0, 5},
     [](Record& r) {
       const auto first = std::ranges::adjacent_find(r.interactions, [](auto& a, auto& b) {
         return a.at == b.at && b.order == a.order + 1 && a.message.kind != record::kCommand &&
                b.message.kind != record::kCommand;
       });
       std::swap(first->order, std::next(first)->order);
       std::swap(*first, *std::next(first));
     }},
    {"released_late",
     {0, 3, 4},
     [](Record& r) {
       where(r, [](const auto& m) { return m.kind == record::kSleep; }).st_at_release +=
           Duration(1'000'000);
     }},
    {"et_faster_than_hosts_clock", {5}, [](Record& r) { r.header.suts[0].clock.factor = 0.5; }},
    {"reply_after_finish",
     {5},
     [](Record& r) {
       std::size_t last = r.interactions.size() - 1;
       while (r.interactions[last - 1].at != r.interactions[last].at) --last;
       r.interactions[last - 1].message.kind = record::kFinish;
     }},
    {"no_measurement_although_it_waits",
     {0},
     [](Record& r) {
       where(r, [](const auto& m) { return is_poll(m) && !m.sampled_at; }).only_if_available =
           false;
     }},
    {"poll_that_waited",
     {5},
     [](Record& r) {
       where(r, [](const Interaction& m) {
         return m.sensor == "camera" && m.reply_at > m.request_at;
       }).only_if_available = true;
     }},
    {"stop_of_unknown_uav",
     {0, 5},
     [](Record& r) { find_stop(r, is_for_a_reply).message.uav = "b"; }},
    {"wrong_count_of_stops", {0}, [](Record& r) { ++r.footer->stops; }},
    {"wrong_overshoot", {0}, [](Record& r) { r.footer->largest_overshoot += Duration(1); }},
    {"ended_before_last_stop", {5}, [](Record& r) { r.footer->et_at_end[0] -= Duration(1); }},
};

class PlantedStop : public testing::TestWithParam<Planted> {};

TEST_P(PlantedStop, IsFound) {
  Record record = generate_concurrent({.seed = 11, .threads = 5});
  ASSERT_TRUE(audit(record).passed());
  GetParam().plant(record);
  const Verdict verdict = audit(record);
  EXPECT_EQ(rules_of(verdict), GetParam().rules) << to_text(verdict);
}

INSTANTIATE_TEST_SUITE_P(All, PlantedStop, testing::ValuesIn(kPlantedStops),
                         [](const auto& planted) { return std::string(planted.param.what); });

// A read that returned a measurement is changed to have none. This is found for reads of a new
// measurement and of the latest.
TEST(MissedMeasurement, IsFound) {
  int of_new = 0, of_latest = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Record sound = generate_concurrent({.seed = seed, .threads = 2});
    for (std::size_t i = 0; i < sound.interactions.size(); ++i) {
      if (!is_poll(sound.interactions[i].message) || !sound.interactions[i].message.sampled_at)
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
  const auto of_stops = [](const Finding& finding) {
    return finding.rule == 0 && finding.sequence == 0;
  };
  const Verdict with_stops = audit(record);
  EXPECT_EQ(std::ranges::count_if(with_stops.findings, of_stops), std::ssize(record.stops));
  record.stops.clear();
  set_figures(record);
  const Verdict without = audit(record);
  EXPECT_EQ(std::ranges::count_if(without.findings, of_stops), 0);
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

TEST(FreeRunningConcurrent, EachThreadGetsAnotherMeasurement) {
  EXPECT_TRUE(audit(free_threads(1, 2)).findings.empty()) << to_text(audit(free_threads(1, 2)));
  EXPECT_EQ(rules_of(audit(free_threads(1, 3))), Rules{8}) << "missed a measurement";
}

// A measurement that a later request got was still available.
TEST(FreeRunningConcurrent, ThreadsGetMeasurementsInTheOrderOfRequests) {
  Record record = free_threads(1, 2);
  record.interactions[0].message.sequence = 2;
  record.interactions[1].message.sequence = 1;
  EXPECT_EQ(rules_of(audit(record)), Rules{8});
}

}  // namespace
}  // namespace tether::audit
