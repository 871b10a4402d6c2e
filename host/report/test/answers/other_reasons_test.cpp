#include "sample_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/verdict.h>

namespace tether::report {
namespace {

using Evidence = OtherReason::Evidence;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Flights of one UAV under conditions that differ in what the tests set.
class OtherReasons : public testing::Test {
 protected:
  /// @return the index of the condition.
  std::size_t add(const std::string& name, std::size_t reached, std::size_t missed, Pace pace) {
    std::vector<double> times_s(reached, 4.0);
    times_s.resize(reached + missed, 6.0);
    scenario_.conditions.push_back(sample_results({{name, times_s}}).conditions[0]);
    for (campaign::TrialResult& trial : scenario_.conditions.back().trials) {
      trial.policy = "conservative_barrier";
      trial.metrics[0].max = 5.0;
      trial.profiles = {"paper_streaming"};
      trial.versions["simulator"] = "MuJoCo";
      trial.suts = {{.uav = "uav1", .sut = "s", .clock = "cpu", .reached_goal = true}};
      if (!trial.metrics[0].is_met()) trial.outcome = campaign::Outcome::kGoalMissed;
    }
    paces_.emplace_back(std::move(pace));
    return paces_.size() - 1;
  }
  Verdict verdict() const { return verdict_of(scenario_, paces_); }
  Ruling ruling(std::size_t condition) const { return verdict().conditions[condition].ruling; }
  std::vector<campaign::TrialResult>& trials(std::size_t condition) {
    return scenario_.conditions[condition].trials;
  }
  Speed::Program& program(std::size_t condition) { return paces_[condition]->speed.programs[0]; }

  /// A program that is measured: an image costs so much.
  static Pace measured(double image_s) {
    Pace pace{.uav = "uav1",
              .stages = {{.stage = "detect", .count = 40, .share = 1.0}},
              .camera = "camera",
              .read_hz = 30.0,
              .offered_hz = 30.0,
              .median_s = image_s,
              .p95_s = image_s};
    pace.speed.programs = {{.uav = "uav1", .clock = "cpu"}};
    pace.speed.machine = "here";
    return pace;
  }
  static Pace scripted(Duration computing) {
    Pace pace = measured(to_seconds(computing));
    pace.speed.programs = {{.uav = "uav1", .clock = "scripted", .computing = computing}};
    pace.speed.machine.clear();
    return pace;
  }
  static Pace instant() { return scripted(std::chrono::microseconds(1)); }

  campaign::ScenarioResults scenario_;
  std::vector<std::optional<Pace>> paces_;
};

TEST_F(OtherReasons, AreSoughtOnlyWithAReference) {
  const std::size_t board = add("board", 0, 5, measured(0.02));
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough) << "although it reads every image";
  paces_[board].reset();
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
}

TEST_F(OtherReasons, ExcludeTheComputerIfComputingTakesNoTime) {
  add("instant", 0, 5, instant());
  const Verdict alone = verdict();
  EXPECT_EQ(alone.conditions[0].ruling, Ruling::kOtherReason);
  EXPECT_EQ(alone.conditions[0].other_reason->evidence, Evidence::kInstant);
  EXPECT_THAT(verdict_text({alone}, Markup::kPlain),
              StartsWith("Goal missed for another reason than speed: on “instant” 5 of 5 flights "
                         "miss the goal (missed: time required ≤ 5 s (5 flights))"));
  EXPECT_THAT(advice_of({alone}),
              ElementsAre("Look for the reason in the program, the scenario and its limits."));
  paces_[0] = scripted(std::chrono::milliseconds(1));
  EXPECT_EQ(ruling(0), Ruling::kNotFastEnough) << "that is time";
}

TEST_F(OtherReasons, ExcludeTheComputerIfTheGoalIsMissedWithoutComputingToo) {
  const std::size_t board = add("board", 0, 5, measured(0.02));
  const std::size_t reference = add("instant", 1, 9, instant());
  EXPECT_EQ(ruling(board), Ruling::kOtherReason);
  EXPECT_EQ(verdict().conditions[board].other_reason->evidence, Evidence::kInstantMissesToo);
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("“instant” misses it too, although computing takes no time there."));
  trials(reference)[0].profiles = {"late"};
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough) << "other sensors";
  trials(reference)[0].profiles = trials(board)[0].profiles;
  trials(reference)[0].versions["simulator"] = "Gazebo";
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough) << "another simulator";
}

// Between the two, some speed suffices.
TEST_F(OtherReasons, LeaveItAtTheSpeedIfAnotherSpeedSuffices) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  add("instant", 0, 5, instant());
  add("host", 5, 0, measured(0.02));
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
}

// The results do not say whether their radio is the same.
TEST_F(OtherReasons, OfSeveralUavsNeedAnEquallyFastReference) {
  const std::size_t board = add("board", 0, 5, measured(0.02));
  const std::size_t reference = add("instant", 0, 5, instant());
  for (const std::size_t condition : {board, reference})
    trials(condition)[0].suts.push_back(trials(condition)[0].suts[0]);
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
}

TEST_F(OtherReasons, ExcludeTheComputerIfItReachesTheGoalUnderAnotherCondition) {
  const std::size_t poor = add("poor radio", 0, 5, scripted(std::chrono::milliseconds(10)));
  const std::size_t good = add("fast board", 5, 0, scripted(std::chrono::milliseconds(10)));
  const std::size_t slow = add("slow board", 0, 5, scripted(std::chrono::milliseconds(700)));
  EXPECT_EQ(ruling(poor), Ruling::kOtherReason);
  EXPECT_EQ(ruling(good), Ruling::kFastEnoughSoFar);
  EXPECT_EQ(ruling(slow), Ruling::kNotFastEnough);
  EXPECT_EQ(verdict().lead, slow);
  EXPECT_THAT(answers_of({verdict()})[1].rest,
              HasSubstr("“fast board” has the same computer and sensors, and reaches it."));
  EXPECT_EQ(rulings_table({verdict()}).rows[poor][1], "goal missed for another reason");

  scenario_.conditions.pop_back();
  paces_.pop_back();
  EXPECT_THAT(advice_of({verdict()}), ElementsAre("Look for the reason in what differs from “fast "
                                                  "board”, such as the radio."));
}

TEST_F(OtherReasons, CompareOnlyWhatIsEquallyFast) {
  const std::size_t poor = add("poor radio", 0, 5, measured(0.02));
  const std::size_t good = add("good radio", 5, 0, measured(0.02));
  ASSERT_EQ(ruling(poor), Ruling::kOtherReason);
  const Pace before = *paces_[poor];
  const auto expect_not = [&](const char* what) {
    EXPECT_EQ(ruling(poor), Ruling::kNotFastEnough) << what;
    paces_[poor] = before;
  };
  program(poor).cpu_factor = 6.0;
  expect_not("a slower computer");
  program(poor).board = "shared";
  expect_not("a shared board");
  paces_[poor]->speed.machine = "there";
  expect_not("another machine");
  paces_[poor]->speed.target = "pi ssh://pi";
  expect_not("another target");
  paces_[poor]->p95_s = 0.03;
  expect_not("images that cost more");
  paces_[poor]->camera.clear();
  expect_not("unknown costs");
  trials(poor)[0].profiles.clear();
  expect_not("other sensors");
  trials(poor)[0].profiles = trials(good)[0].profiles;
  EXPECT_EQ(ruling(poor), Ruling::kOtherReason);
}

// Which says nothing of sensors and simulator.
TEST_F(OtherReasons, DoNotRestOnAFlightThatFailed) {
  const std::size_t board = add("board", 0, 6, measured(0.02));
  const std::size_t reference = add("instant", 0, 6, instant());
  trials(reference)[1].versions["simulator"] = "Gazebo";
  for (const std::size_t condition : {board, reference}) {
    campaign::invalidate(trials(condition)[0], "no port");
    trials(condition)[0].versions.clear();
  }
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
}

// With so few flights, chance explains the difference.
TEST_F(OtherReasons, DoNotBuildOnChance) {
  const std::size_t poor = add("poor radio", 0, 1, measured(0.02));
  add("good radio", 2, 0, measured(0.02));
  EXPECT_EQ(ruling(poor), Ruling::kNotFastEnough);
}

TEST_F(OtherReasons, OfOneFlightSaySo) {
  add("instant", 0, 1, instant());
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              StartsWith("Goal missed in this flight for another reason than speed: "));
}

TEST_F(OtherReasons, AreNotSoughtWhereTheFlightsLeaveItOpen) {
  const std::size_t poor = add("poor radio", 7, 3, measured(0.02));
  add("good radio", 36, 0, measured(0.02));
  EXPECT_EQ(ruling(poor), Ruling::kUndecided);
  const std::size_t none = add("not flown", 0, 0, measured(0.02));
  EXPECT_EQ(ruling(none), Ruling::kUndecided);
}

}  // namespace
}  // namespace tether::report
