#include "sizing_of.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::runner {
namespace {

using campaign::Sizing;

const std::filesystem::path kData = TETHER_SOURCE_DIR "/data";

// What it would refuse is not said.
TEST(SizingOf, FliesTheSameScenarioOnASlowerComputer) {
  TrialSpec spec;
  spec.scenario = scenario::load_scenario(kData / "scenarios/face_anchor.toml");
  const auto fly = [&](const char* condition) {
    spec.condition = *spec.scenario.find_condition(condition);
    return sizing_of(spec, scenario::ShippedFiles(kData));
  };
  const auto place = [&](const char* from, const std::string& target) {
    spec.condition = *spec.scenario.find_condition(from);
    place_on(spec.condition, scenario::load_target(kData / ("profiles/targets/" + target)));
    spec.condition.moved_from = from;
    spec.condition.name += " on the target";
    return sizing_of(spec, scenario::ShippedFiles(kData));
  };
  const std::string six = kData / "profiles/targets/six_times_slower.toml";
  const std::string counted = kData / "profiles/targets/counted_host.toml";
  EXPECT_EQ(fly("target, counted"), (Sizing{"face_anchor", "target, counted"}));
  EXPECT_EQ(place("host", "six_times_slower.toml"), (Sizing{"face_anchor", "host", six}));
  EXPECT_EQ(place("target, counted", "counted_host.toml"),
            (Sizing{"face_anchor", "target, counted", counted}));
  EXPECT_FALSE(place("host", "counted_host.toml"));  // the default has a factor
  slow_down(spec.condition = *spec.scenario.find_condition("host"), 3.0);
  EXPECT_EQ(sizing_of(spec, scenario::ShippedFiles(kData)),
            (Sizing{"face_anchor", "host", "", std::pair(0.75, 40.0)}));
  const ScratchFolder scratch;
  spec.scenario.file = scratch.write("face_anchor.toml", "");
  EXPECT_EQ(fly("host"), (Sizing{spec.scenario.file.string(), "host"}));
  spec.waits_for_sut = true;
  EXPECT_FALSE(fly("host"));
  spec.waits_for_sut = false;
  spec.scenario.settings = {{"time_limit_s", "9"}};
  EXPECT_FALSE(fly("host"));
}

TEST(SizingOf, IsNoneForABoard) {
  TrialSpec spec;
  spec.scenario = scenario::load_scenario(kData / "scenarios/face_anchor.toml");
  scenario::Condition& board = spec.scenario.conditions.front();
  board.computers[0].clock.kind = computer::ClockKind::kWall;
  board.computers[0].target.emplace().ssh = scenario::SshAddress{"pi@board"};
  spec.condition = board;
  EXPECT_FALSE(sizing_of(spec, scenario::ShippedFiles(kData)));
}

}  // namespace
}  // namespace tether::runner
