#include "sample_timing.h"

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/link/codec.h>
#include <tether/timing/replay.h>

namespace tether::timing {

using computer::ReplayMode;
using computer::UnknownStages;
namespace {

using Times = std::vector<link::StageTime>;

/// What a program is charged whose call has these stages.
Times taken(const Replay& replay, const std::vector<std::string>& stages) {
  Times times;
  for (const std::string& stage : stages) {
    Duration computing{0};
    for (const link::StageTime& given : replay.given())
      if (given.stage == stage) computing = given.computing;
    times.push_back({stage, computing});
  }
  return times;
}

TEST(Replay, ExactGivesEachCallItsTime) {
  const Timing timing = sample_timing();
  Replay replay(timing, {.mode = ReplayMode::kExact}, "uav1", 2);
  EXPECT_EQ(replay.other_build("0a", timing.builds.at("uav1")), std::nullopt);
  for (const Call& call : timing.runs[1].calls) {
    ASSERT_EQ(replay.given(), call.stages);
    ASSERT_EQ(replay.take(call.call, call.stages), std::nullopt);
  }
  EXPECT_TRUE(replay.given().empty());
  const auto difference = replay.take("camera", {});
  ASSERT_TRUE(difference);
  EXPECT_NE(difference->find("after 60 calls"), std::string::npos);
}

TEST(Replay, ExactNamesTheFirstCallThatDiffers) {
  const Timing timing = sample_timing();
  const Call& first = timing.runs[0].calls[0];
  const Call& second = timing.runs[0].calls[1];
  Times more = second.stages, slower = second.stages;
  more.push_back({"learn", Duration(0)});
  slower[1].computing += Duration(1);
  for (const auto& [call, stages, named] :
       {std::tuple("sleep", second.stages, "\"command\""),
        std::tuple("command", more, "\"detect\""), std::tuple("command", slower, "\"detect\"")}) {
    Replay replay(timing, {.mode = ReplayMode::kExact}, "uav1", 1);
    ASSERT_EQ(replay.take(first.call, first.stages), std::nullopt);
    const auto difference = replay.take(call, stages);
    ASSERT_TRUE(difference) << call;
    EXPECT_EQ(difference->find("call 2"), 0u) << *difference;
    EXPECT_NE(difference->find(named), std::string::npos) << *difference;
  }
}

TEST(Replay, MultipliesTimesByTheSlowdown) {
  const Timing timing = sample_timing();
  Replay as_recorded(timing, {}, "uav1", 7), slower(timing, {.slowdown = 2.5}, "uav1", 7);
  ASSERT_FALSE(as_recorded.given().empty());
  for (std::size_t i = 0; i < as_recorded.given().size(); ++i)
    EXPECT_NEAR(to_seconds(slower.given()[i].computing),
                2.5 * to_seconds(as_recorded.given()[i].computing), 1e-9);
}

// What a stage is given depends on seed and index only, not on other stages or calls.
TEST(Replay, ResampledDrawsByStageAndIndex) {
  const Timing timing = sample_timing();
  const auto known = samples_of(timing).at("detect");
  const auto draws = [&](std::uint64_t seed, bool with_others) {
    Replay replay(timing, {}, "uav1", seed);
    std::vector<double> out;
    for (int i = 0; i < 200; ++i) {
      if (with_others) {
        EXPECT_FALSE(replay.take("camera", taken(replay, {"command to camera"})));
      }
      const Times times = taken(replay, {"detect"});
      EXPECT_FALSE(replay.take("command", times));
      out.push_back(static_cast<double>(times[0].computing.count()));
      EXPECT_NE(std::ranges::find(known, out.back()), known.end());
    }
    return out;
  };
  EXPECT_EQ(draws(1, false), draws(1, true));
  EXPECT_NE(draws(1, false), draws(2, false));
}

TEST(Replay, ScalesByCountedWork) {
  Timing timing = sample_timing();
  for (const auto& [stage, times] : samples_of(timing)) timing.counted_ns[stage] = 1000.0;
  Timing counted = sample_timing(1);
  for (Call& call : counted.runs[0].calls)
    for (link::StageTime& time : call.stages)
      time.computing = Duration(time.stage == "detect" ? 1200 : 1000);
  const Replay plain(timing, {}, "uav1", 3);
  const Replay scaled(timing, {.mode = ReplayMode::kScaled, .counted = counted}, "uav1", 3);
  for (const std::string stage : {"detect", "camera to command"}) {
    const double before = static_cast<double>(taken(plain, {stage})[0].computing.count());
    const double now = static_cast<double>(taken(scaled, {stage})[0].computing.count());
    EXPECT_NEAR(now / before, stage == "detect" ? 1.2 : 1.0, 1e-6) << stage;
  }
  timing.counted_ns.erase("detect");
  const Error error = bad_file_error(
      [&] { Replay(timing, {.mode = ReplayMode::kScaled, .counted = counted}, "uav1", 3); });
  EXPECT_EQ(error.subject(), "detect");
}

TEST(Replay, StagesThatAreUnknownAreTreatedAsAsked) {
  const Timing timing = sample_timing();
  Timing counted = sample_timing(1, 1);
  counted.runs[0].calls.push_back({"command", {{"learn", Duration(77)}}});
  for (const auto& [unknown, stage, charged] : {std::tuple(UnknownStages::kRefused, "learn", -1),
                                                std::tuple(UnknownStages::kZero, "learn", 0),
                                                std::tuple(UnknownStages::kCounted, "learn", 77),
                                                std::tuple(UnknownStages::kCounted, "other", -1)}) {
    Replay replay(timing, {.unknown = unknown, .counted = counted}, "uav1", 1);
    EXPECT_FALSE(replay.knows(stage));
    const Times times = taken(replay, {stage});
    EXPECT_EQ(replay.take("command", times).has_value(), charged < 0)
        << static_cast<int>(unknown) << stage;
    EXPECT_EQ(times[0].computing.count(), std::max(charged, 0))
        << static_cast<int>(unknown) << stage;
  }
}

TEST(Replay, RefusesTimingThatDoesNotFit) {
  Timing timing = sample_timing();
  const auto subject_of = [&](const ReplaySetting& setting, const char* uav, std::uint64_t seed) {
    const Error error = bad_file_error([&] { Replay(timing, setting, uav, seed); });
    return error.subject();
  };
  EXPECT_EQ(subject_of({}, "uav9", 1), "uav9");
  EXPECT_EQ(subject_of({.mode = ReplayMode::kExact}, "uav1", 9), "uav1");
  Timing old = timing;
  old.builds.clear();
  EXPECT_NO_THROW(Replay(old, {}, "uav1", 1));
  timing.builds.swap(old.builds);
  EXPECT_EQ(subject_of({.mode = ReplayMode::kExact}, "uav1", 1), "build");
  timing.build_id.clear();
  EXPECT_EQ(subject_of({.mode = ReplayMode::kExact}, "uav1", 1), "build_id");
  for (std::size_t i = 0; i <= link::kMaxStages; ++i)
    timing.runs[0].calls[0].stages.push_back({"s" + std::to_string(i), Duration(1)});
  EXPECT_EQ(subject_of({}, "uav1", 1), "uav1");
}

}  // namespace
}  // namespace tether::timing
