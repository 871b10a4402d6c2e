#include "altered_record.h"
#include "record_generator.h"

#include <vector>

#include <gtest/gtest.h>

// How a run ended, and how much the record has of what.
namespace tether::audit {
namespace {

using record::Record;

TEST(AuditOfTheEnd, FindsWhatTheMessagesContradict) {
  const Record sound = generate({.seed = 7});
  for (const Planted& planted : std::vector<Planted>{
           {"all messages of a topic removed",
            {0},
            [](Record& r) {
              r.footer->topics = {{"/contacts/uav0", 3}};
            }},
           {"lost, although all have finished", {0}, [](Record& r) { r.footer->end = "sut_lost"; }},
           {"before its time limit",
            {0},
            [](Record& r) {
              r.footer->end = "time_limit";
              r.header.time_limit = std::chrono::hours(1);
            }},
           {"a battery that nobody has", {0}, [](Record& r) { r.footer->end = "battery_empty"; }},
           {"a flood of nobody", {0}, [](Record& r) { r.footer->end = "flooded"; }},
           {"an unknown end", {0}, [](Record& r) { r.footer->end = "well"; }},
           {"an expelled SUT that has finished",
            {0},
            [](Record& r) { r.footer->expelled = {"uav0"}; }},
           {"computing after the finish", {5}, [](Record& r) { r.footer->computing = {"uav0"}; }},
           {"a clearance that nobody measured",
            {0},
            [](Record& r) {
              r.footer->clearances = {{"uav0", 1.0, SimTime{}, "wall"}};
            }},
           {"a clearance that the end does not have",
            {0},
            [](Record& r) {
              for (auto& truth : r.ground_truth) truth.message.clearance_m = 1.0;
            }},
           {"less wall time than the last reply took", {0}, [](Record& r) {
              r.header.wall_at_start = from_ns<WallTime>(1);
              r.footer->wall = Duration(1);
            }}}) {
    Record record = sound;
    planted.plant(record);
    EXPECT_EQ(rules_of(record), planted.rules) << planted.what;
  }
}

TEST(AuditOfTheEnd, AcceptsWhatTheMessagesShow) {
  Record record = generate({.seed = 7});
  record.footer->topics = {
      {"/interactions", record.interactions.size()}, {"/images/uav0/camera", 5}, {"/tf", 7}};
  for (const record::SutInfo& sut : record.header.suts) {
    const auto of_uav = [&](const auto& messages) {
      return static_cast<std::uint64_t>(std::ranges::count_if(
          messages, [&](const auto& entry) { return entry.message.uav == sut.uav; }));
    };
    record.footer->topics.push_back({"/commands/" + sut.uav, of_uav(record.commands)});
    record.footer->topics.push_back({"/ground_truth/" + sut.uav, of_uav(record.ground_truth)});
  }
  record.header.time_limit = std::chrono::hours(1);
  record.unloaded = {{"/images/uav0/camera", 5}, {"/tf", 7}, {"/of_others", 9}};
  EXPECT_EQ(rules_of(record), Rules{}) << to_text(audit(record));
  record.unloaded["/images/uav0/camera"] = 4;
  EXPECT_EQ(rules_of(record), Rules{0});
}

TEST(AuditOfTheEnd, AcceptsARunThatItsLimitEnds) {
  Record record = generate({.seed = 7, .stop_at = from_ns<SimTime>(1'000'000'000)});
  record.header.time_limit = record.footer->st_at_end.time_since_epoch();
  EXPECT_EQ(rules_of(record), Rules{}) << to_text(audit(record));
  record.footer->end = "sut_lost";
  EXPECT_EQ(rules_of(record), Rules{0});
  record.header.time_limit += kStep;
  EXPECT_EQ(rules_of(record), Rules{});
  record.footer->end = "finished";
  EXPECT_EQ(rules_of(record), Rules{0});
}

}  // namespace
}  // namespace tether::audit
