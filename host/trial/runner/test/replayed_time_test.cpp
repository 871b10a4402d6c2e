#include "replayed_time.h"

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::runner {
namespace {

class ReplayedTimeTest : public testing::Test {
 protected:
  ReplayedTimeTest() {
    spec_.scenario = scenario::load_scenario(std::filesystem::path(TETHER_SOURCE_DIR) /
                                             "data/scenarios/face_anchor.toml");
    spec_.condition = spec_.scenario.conditions.front();
    spec_.seed = 3;
    spec_.condition.replay = scenario::ReplaySource{.timing = scratch_.path("a.timing")};
    timing_.scenario = "face_anchor";
    timing_.build_id = "0a";
    timing_.board = "pi";
    timing_.clock = "cpu";
    timing_.builds[spec_.scenario.uavs[0].placement.name] = {{"argument 1", "a"}};
    timing_.runs = {{spec_.scenario.uavs[0].placement.name, 3, {{"finish", {{"a", Duration(5)}}}}}};
  }
  ReplayedTime load() {
    timing::write_timing(scratch_.path("a.timing"), timing_);
    return replayed_time(spec_);
  }
  std::string refused_subject() {
    const Error error = bad_file_error([&] { load(); });
    EXPECT_FALSE(error.where().file.empty());
    return error.subject();
  }

  ScratchFolder scratch_;
  TrialSpec spec_;
  timing::Timing timing_;
};

TEST_F(ReplayedTimeTest, GivesEachUavItsTimeAndSaysWhereFrom) {
  const ReplayedTime time = load();
  ASSERT_EQ(time.replays.size(), 1u);
  EXPECT_EQ(time.replays[0].given(), (std::vector<link::StageTime>{{"a", Duration(5)}}));
  EXPECT_EQ(time.from, (record::ReplayInfo{"a.timing", "resampled", "", "pi", "0a"}));
  EXPECT_EQ(time.warnings.size(), 1u);  // few samples
  spec_.condition.replay.reset();
  EXPECT_TRUE(load().replays.empty());
}

// A replay is as doubtful as the runs in which its times were measured.
TEST_F(ReplayedTimeTest, HasTheDoubtsOfTheRunsThatWereMeasured) {
  using Kind = campaign::Doubt::Kind;
  timing_.doubts = {{Kind::kUnseenWait, "uav1", 0.4}, {Kind::kBusyMachine, "", 0.2}};
  EXPECT_EQ(load().doubts,
            (std::vector<campaign::Doubt>{{Kind::kUnseenWait, "uav1", 0.4, "a.timing"},
                                          {Kind::kBusyMachine, "pi", 0.2, "a.timing"}}));
}

TEST_F(ReplayedTimeTest, IsDoubtfulIfItIsOfOtherArguments) {
  timing_.builds["uav1"] = {{"argument 1", "5"}, {"library libc.so.6", "0a"}};
  record::Header header;
  header.suts.resize(1);
  header.suts[0].uav = "uav1";
  header.suts[0].build = {{"argument 1", "5"}, {"library libc.so.6", "0b"}};
  EXPECT_TRUE(of_other_arguments(load(), header).empty()) << "of another architecture";
  header.suts[0].build[0].value = "60";
  const auto warnings = of_other_arguments(load(), header);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].can_change_verdict);
  EXPECT_NE(warnings[0].message.find("argument 1 was \"5\", is \"60\""), std::string::npos);
  spec_.condition.replay->mode = computer::ReplayMode::kScaled;
  spec_.condition.replay->counted.clear();
  EXPECT_TRUE(of_other_arguments(load(), header).empty()) << "it is scaled to another program";
}

TEST_F(ReplayedTimeTest, EachRunIsGivenTheTimeFromItsFirstCallOn) {
  spec_.condition.replay->mode = computer::ReplayMode::kExact;
  const std::vector<link::StageTime> first{{"a", Duration(5)}};
  const auto giver = giver_of(load().replays.at(0));
  link::Hello hello;
  hello.build_id = "0b";
  for (int run = 0; run < 2; ++run) {
    const auto given = giver();
    EXPECT_TRUE(given->other_build(hello));
    EXPECT_TRUE(given->knows("a"));
    EXPECT_FALSE(given->knows("b"));
    EXPECT_EQ(given->given(), first);
    EXPECT_FALSE(given->take("finish", first));
    EXPECT_TRUE(given->given().empty());
    EXPECT_TRUE(given->take("finish", first)) << "the recorded run has ended";
  }
}

TEST_F(ReplayedTimeTest, RefusesTimingThatDoesNotFit) {
  spec_.condition.replay->mode = computer::ReplayMode::kExact;
  spec_.seed = 4;
  EXPECT_EQ(refused_subject(), timing_.runs[0].uav);
  spec_.condition.replay->counted = spec_.condition.replay->timing;
  EXPECT_EQ(refused_subject(), "cpu");
  timing_.scenario = "other";
  EXPECT_EQ(refused_subject(), "other");
}

}  // namespace
}  // namespace tether::runner
