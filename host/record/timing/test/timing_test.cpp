#include "sample_timing.h"

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::timing {
namespace {

record::Interaction interaction(std::string kind, std::int64_t request_ns, std::int64_t reply_ns) {
  record::Interaction entry;
  entry.uav = "uav1";
  entry.kind = std::move(kind);
  entry.sensor = entry.kind == record::kSensor ? "camera" : "";
  entry.request_at = from_ns<ExecTime>(request_ns);
  entry.reply_at = from_ns<ExecTime>(reply_ns);
  return entry;
}

record::Record sample_record() {
  record::Record record;
  record.header.scenario = "face_anchor";
  record.header.policy = record::kConservativeBarrier;
  record.header.seed = 7;
  record::SutInfo sut;
  sut.uav = "uav1";
  sut.sut = "sut 1.0";
  sut.clock.kind = computer::ClockKind::kCpu;
  sut.clock.factor = 6.0;
  sut.build_id = "0a";
  sut.build = {{"argument 1", "30"}};
  record.header.suts = {sut};
  record.interactions = {{{}, 0, interaction("sensor", 10, 40)},
                         {{}, 1, interaction("command", 65, 65)}};
  record.interactions[1].message.stages = {{"detect", Duration(20)},
                                           {"camera to command", Duration(5)}};
  return record;
}

TEST(Timing, TakesStagesOrNamesThemByCalls) {
  const Timing timing = of_record(sample_record(), "a.mcap", "2026-11-20T10:00:00Z");
  ASSERT_EQ(timing.runs.size(), 1u);
  EXPECT_EQ(timing.clock, "cpu*6");
  EXPECT_EQ(
      timing.runs[0],
      (timing::Run{"uav1",
                   7,
                   {{"camera", {{"start to camera", Duration(10)}}},
                    {"command", {{"detect", Duration(20)}, {"camera to command", Duration(5)}}}}}));
}

TEST(Timing, RefusesRecordsWithoutMeasuredTime) {
  record::Record free = sample_record(), replayed = free, mixed = free;
  free.header.policy = record::kFreeRunning;
  replayed.header.suts[0].replay.emplace();
  mixed.header.suts.push_back(mixed.header.suts[0]);
  mixed.header.suts[1].sut = "other";
  for (const auto& [record, subject] : {std::pair(free, "policy"), std::pair(replayed, "uav1")}) {
    const Error error = bad_file_error([&, &record = record] { of_record(record, "a.mcap", ""); });
    EXPECT_EQ(error.where().file, "a.mcap");
    EXPECT_EQ(error.subject(), subject);
  }
  EXPECT_EQ(bad_file_error([&] { of_record(mixed, "a.mcap", ""); }).subject(), "uav1");
}

TEST(Timing, UavsOfOneFlightAreOneRun) {
  Timing timing = sample_timing(1);
  EXPECT_EQ(runs_text(timing), "1 run");
  timing.runs.push_back({"uav2", timing.runs[0].seed, {}});
  EXPECT_EQ(runs_text(timing), "1 run of 2 UAVs");
  timing.runs.push_back({"uav1", timing.runs[0].seed + 1, {}});
  EXPECT_EQ(runs_text(timing), "2 runs of 2 UAVs");
}

TEST(Timing, AddsRunsOfTheSameProgramOnly) {
  Timing timing = sample_timing(1), more = timing;
  more.runs[0].seed = 9;
  more.recorded_at = "2026-11-21T00:00:00Z";
  add(timing, more, "b.mcap");
  EXPECT_EQ(timing.runs.size(), 2u);
  EXPECT_EQ(timing.recorded_at, more.recorded_at);
  EXPECT_EQ(samples_of(timing).at("detect").size(), 60u);
  EXPECT_EQ(samples_of(timing, "uav2").size(), 0u);
  const auto subject_of = [&](const Timing& other) {
    return bad_file_error([&] { add(timing, other, "c.mcap"); }).subject();
  };
  EXPECT_EQ(subject_of(more), "seed");
  Timing other = more;
  other.build_id = "0b";
  EXPECT_EQ(subject_of(other), "build id");
  other = more;
  other.runs[0].seed = 9;
  other.builds["uav1"][0].value = "60";
  EXPECT_EQ(subject_of(other), "uav1");
  other = more;
  other.scenario = "move_forward";
  EXPECT_EQ(subject_of(other), "scenario");
}

TEST(Timing, KnowsStagesThatTheProgramDidNotName) {
  const Timing timing = sample_timing();
  EXPECT_TRUE(is_between_calls(timing, "start to camera"));
  EXPECT_TRUE(is_between_calls(timing, "camera to command"));
  EXPECT_FALSE(is_between_calls(timing, "detect"));
}

TEST(Timing, NamesWhatDiffersBetweenBuilds) {
  const Build was = {{"argument 1", "--fast"}, {"argument 2", "3000000"}, {"library a.so", "0a"}};
  EXPECT_EQ(difference(was, was), std::nullopt);
  Build is = was;
  is[1].value = "60000000";
  EXPECT_EQ(difference(was, is), "argument 2 was \"3000000\", is \"60000000\"");
  is = {was[0], was[1], {"library b.so", "0b"}};
  EXPECT_EQ(difference(was, is),
            "library a.so was \"0a\", is missing; library b.so was missing, is \"0b\"");
  EXPECT_EQ(difference({}, {{"a", ""}, {"b", ""}, {"c", ""}, {"d", ""}, {"e", ""}}),
            "a was missing, is \"\"; b was missing, is \"\"; c was missing, is \"\"; and 2 more");
}

}  // namespace
}  // namespace tether::timing
