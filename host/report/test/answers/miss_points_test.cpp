#include "answers/miss_reasons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/verdict.h>

namespace tether::report {
namespace {

using testing::HasSubstr;

TEST_F(MissReasons, AreSpeedBetweenPointsOfASweepOverIt) {
  campaign::CampaignResults results;
  for (const int computing_ms : {2, 300}) {
    scenario_ = {};
    paces_.clear();
    const std::size_t reached = computing_ms == 2 ? 6 : 0;
    add("board", reached, 6 - reached, scripted(std::chrono::milliseconds(computing_ms)));
    for (campaign::TrialResult& trial : trials(0)) trial.pace = paces_[0];
    scenario_.scenario = scenario_.swept_from = "turn";
    scenario_.settings = {{"computing_ms", std::to_string(computing_ms)}};
    results.scenarios.push_back(scenario_);
  }
  EXPECT_EQ(verdicts_of(results)[1].conditions[0].ruling, Ruling::kNotFastEnough);
  EXPECT_THAT(answers_of(verdicts_of(results)),
              testing::Contains(testing::Field(
                  &Answer::rest,
                  testing::AllOf(HasSubstr("with computing_ms = 300 (0 of 6 flights). Not met: "),
                                 HasSubstr("“board with computing_ms = 2” is fast enough")))));
}

TEST_F(MissReasons, AreNotAFactorThatVariesTogetherWithAnotherKey) {
  campaign::CampaignResults results;
  for (const int factor : {1, 6}) {
    scenario_ = {};
    const std::size_t reached = factor == 1 ? 6 : 0;
    add("board", reached, 6 - reached, measured(0.02));
    scenario_.scenario = scenario_.swept_from = "turn";
    scenario_.settings = {{"cpu_factor", std::to_string(factor)},
                          {"time_limit_s", factor == 1 ? "21" : "6"}};
    results.scenarios.push_back(scenario_);
  }
  for (const Answer& answer : answers_of(verdicts_of(results)))
    EXPECT_THAT(answer.lead, testing::Not(HasSubstr("slower would do")));
}

// One program flies the wrong way; the other one is too slow.
TEST_F(MissReasons, CountTheOwnGoalOfEachProgram) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  const std::size_t host = add("host", 0, 5, measured(0.02));
  program(board).clock.factor = 10.0;
  for (const std::size_t condition : {board, host})
    for (campaign::TrialResult& trial : trials(condition)) {
      trial.metrics.clear();
      campaign::SutResult first, second;
      first.uav = "uav1";
      first.outcome = "lost";
      second.uav = "uav2";
      second.outcome = "late";
      second.reached_goal = condition == host;
      trial.suts = {first, second};
    }
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              testing::AllOf(HasSubstr("the own goal of uav1's program: lost (5 flights) and the "
                                       "own goal of uav2's program: late (5 flights)"),
                             HasSubstr("but meets the own goal of uav2's program.")));
}

TEST_F(MissReasons, CanBeATimeLimitBelowTheMetricsAlsoIfAFasterOneReachesTheGoal) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  program(board).clock.factor = 10.0;
  add("host", 5, 0, measured(0.02));
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
  for (campaign::TrialResult& trial : trials(board)) {
    trial.end = campaign::kEndTimeLimit;
    trial.sync.st_at_end = SimTime(std::chrono::seconds(5));
    trial.metrics = {{"time_required", "time_required", "Time required", "s", {}, "", {}}};
    trial.metrics[0].max = 20.0;
  }
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
  EXPECT_THAT(verdict().conditions[board].miss->text,
              HasSubstr("the time limit ended the flight at 5 s, before time required of at most "
                        "20 s could be missed"));
  for (campaign::TrialResult& trial : trials(board)) trial.metrics[0].max = 4.0;
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
}

TEST_F(MissReasons, CanBeAnEmptyBattery) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  for (campaign::TrialResult& trial : trials(board)) {
    campaign::UavEnergy& own = trial.energy.emplace_back();
    own.uav = "uav1";
    own.charge_from = 1.0;
    own.spent_J = {400.0, 90.0, 5.0, 5.0, 0.0, 0.0};
  }
  EXPECT_THAT(answers_of({verdict()})[0].rest, HasSubstr("the computer took 2 % of its energy"));
}

// An exit code can mean that the goal was missed, or that the program crashed.
// Both miss it, and the faster one by less: its radio can be why it does.
TEST_F(MissReasons, ArePossibleIfTheFasterConditionHasOne) {
  const std::size_t slow = add("slow", 0, 3, measured(0.2));
  const std::size_t fast = add("fast", 0, 3, measured(0.02));
  for (const std::size_t condition : {slow, fast})
    program(condition).clock.factor = condition == slow ? 10.0 : 1.0;
  for (auto& trial : trials(fast)) trial.metrics[0].value = 5.5;
  EXPECT_THAT(answers_of({verdict()})[0].rest, HasSubstr("but by less"));
  paces_[fast]->messages = 43;
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("A possible reason: of “fast”, which is faster, none of 43 messages"));
}

TEST_F(MissReasons, AreTheSensorsWhereAnEquallyFastConditionWithOthersReachesIt) {
  const std::size_t frozen = add("frozen", 0, 5, measured(0.02));
  trials(add("fast", 5, 0, measured(0.02)))[0].profiles = {"none"};
  EXPECT_EQ(ruling(frozen), Ruling::kGoalMissed);
  const std::string text = verdict_text({verdict()}, Markup::kPlain);
  EXPECT_THAT(text, HasSubstr("“fast” is exactly as fast and reaches it: what differs are its "
                              "sensors"));
  EXPECT_THAT(text, testing::Not(HasSubstr("faster computer")));
}

TEST_F(MissReasons, CanBeThatTheProgramWasStoppedWhileItsClockWentOn) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  for (campaign::TrialResult& trial : trials(board))
    trial.this_run.stopped_program = "process 7 of the SUT of UAV \"uav1\" halted at ST 0.18 s";
  EXPECT_EQ(verdict().advice[0].kind, Advice::Kind::kTryFaster) << "a CPU clock does not go on";
  program(board).clock.kind = computer::ClockKind::kWall;
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("A possible reason: process 7 of the SUT"));
  EXPECT_EQ(verdict().advice[0].kind, Advice::Kind::kFindReason);
}

TEST_F(MissReasons, SaysNoMoreOfAFasterConditionThanItsOwnAnswer) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  program(board).clock.factor = 10.0;
  const std::size_t host = add("host", 5, 0, measured(0.02));
  for (const std::size_t copied : {board, host})
    for (campaign::TrialResult& trial : trials(copied)) trial.flight_digest = "0a";
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("“host” is fast enough in this flight: an image costs"));
}

TEST_F(MissReasons, OfAProgramAsItIsCanBeItsOwnFailure) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  EXPECT_EQ(verdict().advice.size(), 1u);
  for (campaign::TrialResult& trial : trials(board)) {
    campaign::SutResult sut;
    sut.as_is = sut.finished = true;
    trial.suts = {sut};
  }
  const std::vector<Advice> advice = verdict().advice;
  ASSERT_EQ(advice.size(), 2u);
  EXPECT_EQ(advice[0].kind, Advice::Kind::kMendProgram);
  EXPECT_EQ(advice[1].kind, Advice::Kind::kTryFaster);
}

}  // namespace
}  // namespace tether::report
