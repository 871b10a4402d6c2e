#include "size_arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::runner {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::filesystem::path kData = TETHER_SOURCE_DIR "/data";

// Words with which `tether size` starts: what it would refuse is not said.
TEST(SizeArguments, FlyTheSameScenarioOnASlowerComputer) {
  TrialSpec spec;
  spec.scenario = scenario::load_scenario(kData / "scenarios/face_anchor.toml");
  const auto fly = [&](const char* condition) {
    spec.condition = *spec.scenario.find_condition(condition);
    return size_arguments(spec, scenario::ShippedFiles(kData));
  };
  const auto place = [&](const char* name, const std::string& target) {
    spec.condition = *spec.scenario.find_condition("target, counted");
    place_on(spec.condition, scenario::load_target(kData / ("profiles/targets/" + target)));
    spec.condition.name = name;
    return size_arguments(spec, scenario::ShippedFiles(kData));
  };
  const std::string six = kData / "profiles/targets/six_times_slower.toml";
  const std::string counted = kData / "profiles/targets/counted_host.toml";
  EXPECT_THAT(fly("target, counted"), ElementsAre("face_anchor", "--condition", "target, counted"));
  EXPECT_THAT(place("six_times_slower", "six_times_slower.toml"),
              ElementsAre("face_anchor", "--condition", "host", "--target", six));
  EXPECT_THAT(place("target, counted on counted_host", "counted_host.toml"),
              ElementsAre("face_anchor", "--condition", "target, counted", "--target", counted));
  EXPECT_THAT(place("counted_host", "counted_host.toml"), IsEmpty());  // the default has a factor
  slow_down(spec.condition = *spec.scenario.find_condition("host"), 3.0);
  EXPECT_THAT(size_arguments(spec, scenario::ShippedFiles(kData)),
              ElementsAre("face_anchor", "--condition", "host", "--between", "0.75,40"));
  const ScratchFolder scratch;
  spec.scenario.file = scratch.write("face_anchor.toml", "");
  EXPECT_THAT(fly("host"), ElementsAre(spec.scenario.file.string(), "--condition", "host"));
  spec.waits_for_sut = true;
  EXPECT_THAT(fly("host"), IsEmpty());
  spec.waits_for_sut = false;
  spec.scenario.settings = {{"time_limit_s", "9"}};
  EXPECT_THAT(fly("host"), IsEmpty());
}

TEST(SizeArguments, AreNoneForABoard) {
  TrialSpec spec;
  spec.scenario = scenario::load_scenario(kData / "scenarios/face_anchor.toml");
  scenario::Condition& board = spec.scenario.conditions.front();
  board.computers[0].clock.kind = computer::ClockKind::kWall;
  board.computers[0].target.emplace().ssh = scenario::SshAddress{"pi@board"};
  spec.condition = board;
  EXPECT_THAT(size_arguments(spec, scenario::ShippedFiles(kData)), IsEmpty());
}

}  // namespace
}  // namespace tether::runner
