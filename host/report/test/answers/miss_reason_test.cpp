#include "answers/miss_reasons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/verdict.h>

namespace tether::report {
namespace {

using Evidence = MissReason::Evidence;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(MissReasons, AreNotKnownWithoutAReference) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              testing::AllOf(
                  StartsWith("Goal missed: on “board” 5 of 5 flights miss the goal (not met: time "
                             "required ≤ 5 s (5 flights))"),
                  HasSubstr("No condition that is clearly faster and otherwise the same was flown, "
                            "so whether speed matters is not known."),
                  HasSubstr("To see whether speed matters, fly on a faster computer")));
  paces_[board].reset();
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
}

TEST_F(MissReasons, AreSpeedIfAFasterConditionReachesTheGoal) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  const std::size_t host = add("host", 5, 0, measured(0.02));
  program(board).clock.factor = 10.0;
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
  EXPECT_EQ(verdict().conditions[board].miss->evidence, Evidence::kFasterReaches);
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("“host” is fast enough so far: an image costs 20 ms instead of 200 "
                        "ms, 10.0 × less."));
  const auto expect_not_compared = [&](const char* because) {
    EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << because;
    EXPECT_THAT(answers_of({verdict()})[0].rest,
                HasSubstr(std::string("“host” reaches it, but is not compared, since ") + because));
  };
  trials(host)[0].profiles = {"late"};
  expect_not_compared("its sensors or its simulator differ");
  trials(host)[0].profiles = trials(board)[0].profiles;
  trials(host)[0].versions["simulator"] = "Gazebo";
  expect_not_compared("its sensors or its simulator differ");
  trials(host)[0].versions["simulator"] = "MuJoCo";
  paces_[host]->radio = "radio=log_distance";
  expect_not_compared("its radio differs");
  paces_[host]->radio.clear();
  trials(host)[0].real_time_factor = 0.3;
  expect_not_compared("its real_time_factor differs");
  trials(host)[0].real_time_factor = trials(board)[0].real_time_factor;
  program(board).cores = 1;
  expect_not_compared("the number of its cores differs");
  program(board).cores = 0;
  program(board).launcher = "wrapper --wrong";
  expect_not_compared("something else starts its program");
  program(board).launcher.clear();
  constexpr auto kOtherBuild = "its program is another build, or has other libraries";
  program(board).build = "1f";
  expect_not_compared(kOtherBuild);
  program(board).build.clear();
  program(board).libraries = {"liblaw.so 0b"};
  expect_not_compared(kOtherBuild);
  program(board).loader = "library ld-linux-aarch64.so.1";  // only one architecture is known
  expect_not_compared(kOtherBuild);
  program(host).loader = "library ld-linux-x86-64.so.2";
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough) << "the build of another architecture";
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("Its program is another build, for another architecture"));
  program(board).loader = "library ld-mine.so.2";
  expect_not_compared(kOtherBuild);
  program(board).loader = program(host).loader = "";
  program(board).libraries.clear();
  paces_[board]->speed.emulator.cpu_model = "Nehalem";
  paces_[host]->speed.emulator.cpu_model = "max";
  expect_not_compared("its emulated CPU is another model");
  paces_[board]->speed.emulator.cpu_model = "max";
  program(host).clock.factor = 15.0;
  EXPECT_EQ(ruling(board), Ruling::kOtherReason) << "a slower one reaches it";
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("“host” is slower and is fast enough so far."));
}

TEST_F(MissReasons, AreNotOtherOnesIfAFasterAndASlowerConditionReachTheGoal) {
  using std::chrono::milliseconds;
  const std::size_t middle = add("middle", 0, 6, scripted(milliseconds(16)));
  add("slow", 6, 0, scripted(milliseconds(26)));
  add("fast", 6, 0, scripted(milliseconds(2)));
  EXPECT_EQ(ruling(middle), Ruling::kGoalMissed);
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              HasSubstr("“slow” is slower and “fast” is faster, and both reach it: speed matters"));
}

// One that ended early computed other things.
TEST_F(MissReasons, CompareFactorsOfOneMachineAndNotWhatFlightsComputed) {
  const std::size_t board = add("board", 0, 5, measured(0.001));
  program(board).clock.factor = 12.0;
  add("host", 5, 0, measured(0.01));
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain), HasSubstr("its computer is 12 × faster"));
  paces_[board]->speed.machine = "there";
  EXPECT_EQ(ruling(board), Ruling::kOtherReason) << "by what they computed, it is the faster one";
}

// A program that computes on purpose for some time does so on each computer.
TEST_F(MissReasons, AreNotShownByTimesOfTheScenarioBesideMeasuredOnes) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  add("on paper", 5, 0, scripted(std::chrono::milliseconds(1)));
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("“on paper” reaches it, but is not compared, since one of the two has "
                        "computing times of the scenario"));
}

TEST_F(MissReasons, CompareScriptedTimesExactly) {
  using std::chrono::microseconds;
  const std::size_t slow = add("6 ms", 0, 5, scripted(microseconds(6000)));
  add("5.9 ms", 5, 0, scripted(microseconds(5900)));
  EXPECT_EQ(ruling(slow), Ruling::kNotFastEnough);
}

TEST_F(MissReasons, AreNotKnownWhereAFasterConditionMeetsSomeOfTheLimits) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  const std::size_t host = add("host", 0, 5, measured(0.002));
  program(board).clock.factor = 100.0;
  EXPECT_EQ(ruling(board), Ruling::kOtherReason);
  for (campaign::TrialResult& trial : trials(host)) {
    trial.metrics[0].value = 1.0;
    trial.clauses = {{.uav = "uav1", .name = "never met", .met = false, .margin = -1.0}};
  }
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("“host” is faster and misses it, too, but meets time required"));
}

// As many flights as failed could have missed the goal.
TEST_F(MissReasons, RestOnFlightsThatEndedAndNotOnThoseThatFailed) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  const std::size_t host = add("host", 5, 0, measured(0.02));
  program(board).clock.factor = 10.0;
  for (int i = 0; i < 6; ++i) {
    trials(host).push_back(trials(host)[0]);
    campaign::invalidate(trials(host).back(), "the SUT was lost");
  }
  EXPECT_EQ(verdict().conditions[host].ruling, Ruling::kUndecided);
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
}

// The sleeping of one thread takes longer by the factor, and none of the board's would.
TEST_F(MissReasons, AreNotKnownIfAFactorAlsoStretchesWhatConcurrentProgramsWait) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  add("host", 5, 0, measured(0.02));
  program(board).concurrent = true;
  program(board).clock = {computer::ClockKind::kWall, 10.0};
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              testing::AllOf(HasSubstr("“host” is faster and is fast enough so far: an image costs "
                                       "20 ms instead of 200 ms, 10.0 × less. That does not show "
                                       "whether speed matters."),
                             HasSubstr("The factor of the wall clock also stretches what the "
                                       "program waits."),
                             HasSubstr("fly on the board itself, or with a factor of 1")));
  program(board).clock.factor = 1.0;
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
}

// 2 of 2 against 0 of 2 is chance, unless all flights of each are one.
TEST_F(MissReasons, NeedMoreThanChance) {
  const std::size_t board = add("board", 0, 2, measured(0.2));
  const std::size_t host = add("host", 2, 0, measured(0.02));
  program(board).clock.factor = 10.0;
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
  for (const std::size_t condition : {board, host})
    for (campaign::TrialResult& trial : trials(condition)) trial.flight_digest = "same";
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
}

TEST_F(MissReasons, AreSpeedIfComputingAloneTakesLongerThanALimit) {
  const std::size_t board = add("board", 0, 1, measured(0.2));
  trials(board)[0].clauses = {{.uav = "uav1",
                               .name = "quick",
                               .margin = -60.0,
                               .unit = "ms",
                               .quantiles = {190.0, 210.0, 230.0},
                               .quantity = "reaction_time",
                               .sensor = "camera",
                               .limit = 150.0,
                               .least_without_computing = 10.0,
                               .median_of_computing = 200.0}};
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              testing::AllOf(StartsWith("Not fast enough in this flight: "),
                             HasSubstr("From a measurement to its command, computing takes 200 ms, "
                                       "longer than “quick” allows.")));
  paces_[board]->unclear = "it probably waits in a loop";
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain), HasSubstr("probably waits in a loop"));
  paces_[board]->unclear.clear();
  trials(board)[0].clauses[0].limit = 9.0;
  EXPECT_EQ(ruling(board), Ruling::kOtherReason) << "sensors alone take 10 ms";
  trials(board)[0].clauses[0].limit = 205.0;
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << "sensors and waiting take the rest";
  trials(board)[0].clauses[0].limit = 15.0;
  trials(board)[0].clauses[0].median_of_computing = 10.0;
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << "a jitter does not contain the computing";
}

// A loop waits for its camera, and a program may wait between an image and its command.
TEST_F(MissReasons, AreNotSpeedByALimitThatComputingIsNoPartOf) {
  const std::size_t board = add("board", 0, 1, measured(0.2));
  const judge::ClauseVerdict clause{.uav = "uav1",
                                    .name = "quick",
                                    .margin = -60.0,
                                    .unit = "ms",
                                    .quantiles = {190.0, 210.0, 230.0},
                                    .quantity = "reaction_time",
                                    .sensor = "camera",
                                    .limit = 150.0,
                                    .least_without_computing = 10.0,
                                    .median_of_computing = 200.0};
  auto& clauses = trials(board)[0].clauses;
  clauses = {clause};
  clauses[0].median_of_computing.reset();
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << "a loop period";
  clauses[0].median_of_computing = 1.0;
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << "it waits";
  clauses = {clause};
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
  program(board).clock.factor = 2.0;
  add("host", 0, 1, measured(0.1));
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << "a faster condition misses it, too";
  const std::size_t slow = add("slow", 0, 1, measured(0.22));
  program(slow).clock.factor = 12.0;
  paces_[1].reset();
  EXPECT_EQ(ruling(board), Ruling::kOtherReason);
  EXPECT_THAT(verdict().conditions[board].miss->text,
              HasSubstr("an image costs 200 ms, and 220 ms on “slow”, which is 6 × slower"));
}

TEST_F(MissReasons, AreNotSpeedByAWallClockThatMeasuresWaitsToo) {
  Pace pace = measured(0.2);
  pace.speed.programs[0].clock.kind = computer::ClockKind::kWall;
  const std::size_t board = add("board", 0, 1, pace);
  trials(board)[0].clauses = {{.uav = "uav1",
                               .name = "quick",
                               .margin = -60.0,
                               .unit = "ms",
                               .quantiles = {190.0, 210.0, 230.0},
                               .limit = 150.0}};
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
}

TEST_F(MissReasons, AreKnownOfWhatHasNothingToDoWithSpeed) {
  struct Cause {
    const char* text;
    void (*plant)(campaign::TrialResult&, Pace&);
  };
  for (const Cause& cause : {
           Cause{"uav1 hits “floor” at ST 0.000 s, before a program can act",
                 [](campaign::TrialResult&trial, Pace&) {
                   trial.contacts = {{.uav = "uav1", .count = 1, .hard = 1}};
                   trial.contacts[0].hardest =
                       record::Contact{.uav = "uav1", .at = {}, .with = "floor"};
                 }},
           {"the battery of uav1 is at 0.01 % at the start",
            [](campaign::TrialResult&trial, Pace&) {
              trial.end = campaign::kEndBatteryEmpty;
              trial.energy = {{.uav = "uav1", .charge_from = 1e-4}};
            }},
       }) {
    scenario_ = {};
    paces_.clear();
    add("board", 0, 1, measured(0.2));
    cause.plant(trials(0)[0], *paces_[0]);
    EXPECT_EQ(ruling(0), Ruling::kOtherReason) << cause.text;
    EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
                testing::AllOf(StartsWith("Goal missed; speed is probably not the reason: "),
                               HasSubstr(std::string("The reason: ") + cause.text + ".")));
  }
}

// Perhaps the program needs neither the messages nor the anchor that is far away, and did not run a
// task because it was late.
TEST_F(MissReasons, ArePossibleOfWhatAProgramMayNotNeed) {
  add("board", 0, 1, measured(0.2));
  trials(0)[0].warnings = {
      {Consequence::kDoubtful, {}, "UAV 'uav1'", "starts 76 m from the nearest anchor"}};
  EXPECT_EQ(ruling(0), Ruling::kGoalMissed);
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              HasSubstr("A possible reason: UAV 'uav1' starts 76 m from the nearest anchor. "
                        "Whether speed matters is not known."));
  trials(0)[0].warnings.clear();
  paces_[0]->messages = 7;
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              HasSubstr("A possible reason: none of 7 messages arrives."));
  paces_[0]->messages = 0;
  campaign::TrialResult& trial = trials(0)[0];
  const auto metrics = trial.metrics;
  trial.end = campaign::kEndFinished;
  trial.metrics.clear();
  trial.clauses = {{.uav = "uav1", .name = "near", .limited_by = "the task 'look' did not run"}};
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              HasSubstr("A possible reason: the task 'look' did not run."));
  trial.clauses = {{.uav = "uav1",
                    .name = "reaction",
                    .from = SimTime{},
                    .limited_by = "there is no such command",
                    .quantity = "reaction_time"}};
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              HasSubstr("A possible reason: “reaction” has nothing to judge: there is no such"));
  trial.metrics = metrics;
  add("host", 5, 5, measured(0.02));
  EXPECT_NE(ruling(0), Ruling::kOtherReason);
}

// The program has a stage that was not there when its times were recorded.
TEST_F(MissReasons, AreNotShownByFlightsThatChargeNothingForAStage) {
  const std::size_t board = add("board", 0, 40, measured(0.2));
  const std::size_t replayed = add("replayed", 40, 0, measured(0.02));
  program(board).clock.factor = 10.0;
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
  for (campaign::TrialResult& trial : trials(replayed))
    trial.replay = campaign::ReplayReport{{}, {"extra"}};
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
  EXPECT_THAT(verdict_text({verdict()}, Markup::kPlain),
              HasSubstr("Fast enough, but “extra” is charged nothing: on “replayed”"));
}

// A program that ends its mission because a task was late does not run the next one.
TEST_F(MissReasons, AreNotTheTaskThatDidNotRunIfOneBeforeItWasLate) {
  add("board", 0, 1, measured(0.2));
  campaign::TrialResult& trial = trials(0)[0];
  trial.end = campaign::kEndFinished;
  trial.metrics.clear();
  trial.clauses = {{.uav = "uav1", .name = "near", .limited_by = "the task 'look' did not run"},
                   {.uav = "uav1", .name = "soon", .margin = -1.0, .deadline = SimTime{}}};
  EXPECT_EQ(ruling(0), Ruling::kGoalMissed);
  trial.clauses.pop_back();
  trial.tasks = {{"uav1", "search", {}, {}, "not_reached", ""}};
  EXPECT_EQ(ruling(0), Ruling::kGoalMissed);
}

TEST_F(MissReasons, AreProbablyNotSpeedIfAFasterProgramThatReadsEveryImageMissesToo) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  const std::size_t host = add("host", 0, 5, measured(0.02));
  program(board).clock.factor = 10.0;
  EXPECT_EQ(ruling(board), Ruling::kOtherReason);
  EXPECT_EQ(verdict().conditions[board].miss->evidence, Evidence::kFasterMissesToo);
  EXPECT_EQ(ruling(host), Ruling::kGoalMissed);
  for (campaign::TrialResult& trial : trials(host)) trial.metrics[0].value = 5.3;
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << "speed moves the time that is too long";
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("“host” is faster and misses it, too, but by less: time required."));
  for (campaign::TrialResult& trial : trials(host)) trial.metrics[0].value = 6.0;
  paces_[host]->read_hz = 9.0;
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << "both may be too slow";
  paces_[host] = measured(0.03);
  program(board).clock.factor = 6.7;
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << "a still faster one may reach it";
}

TEST_F(MissReasons, ExcludeTheComputerIfComputingTakesNoTime) {
  add("instant", 0, 5, instant());
  const Verdict alone = verdict();
  EXPECT_EQ(alone.conditions[0].ruling, Ruling::kOtherReason);
  EXPECT_EQ(alone.conditions[0].miss->evidence, Evidence::kInstant);
  EXPECT_THAT(verdict_text({alone}, Markup::kPlain),
              StartsWith("Goal missed; speed is probably not the reason: on “instant” 5 of 5 "
                         "flights miss the goal (not met: time required ≤ 5 s (5 flights))"));
  EXPECT_THAT(advice_of({alone}),
              ElementsAre("Look for the reason in the program, the scenario and its limits."));
  paces_[0] = scripted(std::chrono::milliseconds(1));
  EXPECT_EQ(ruling(0), Ruling::kGoalMissed) << "that is time";
}

TEST_F(MissReasons, ExcludeTheComputerIfTheGoalIsMissedWithoutComputingToo) {
  const std::size_t board = add("board", 0, 5, measured(0.02));
  const std::size_t reference = add("instant", 1, 9, instant());
  EXPECT_EQ(ruling(board), Ruling::kOtherReason);
  EXPECT_EQ(verdict().conditions[board].miss->evidence, Evidence::kInstantMissesToo);
  EXPECT_THAT(answers_of({verdict()})[0].rest,
              HasSubstr("“instant” misses it too, although computing takes no time there."));
  trials(reference)[0].profiles = {"late"};
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed) << "other sensors";
}

// Between the two, some speed suffices.
TEST_F(MissReasons, LeaveItOpenIfAnotherSpeedSuffices) {
  const std::size_t board = add("board", 0, 5, measured(0.2));
  add("instant", 0, 5, instant());
  add("host", 5, 0, measured(0.02));
  program(board).clock.factor = 10.0;
  EXPECT_EQ(ruling(board), Ruling::kNotFastEnough);
}

TEST_F(MissReasons, ExcludeTheComputerIfItReachesTheGoalUnderAnotherCondition) {
  const std::size_t poor = add("poor radio", 0, 5, scripted(std::chrono::milliseconds(10)));
  const std::size_t good = add("fast board", 5, 0, scripted(std::chrono::milliseconds(10)));
  const std::size_t slow = add("slow board", 0, 5, scripted(std::chrono::milliseconds(700)));
  EXPECT_EQ(ruling(poor), Ruling::kOtherReason);
  EXPECT_EQ(ruling(good), Ruling::kFastEnoughSoFar);
  EXPECT_EQ(ruling(slow), Ruling::kNotFastEnough);
  EXPECT_EQ(verdict().lead, slow);
  EXPECT_THAT(answers_of({verdict()})[1].rest,
              HasSubstr("“fast board” has the same computer and sensors, and reaches it."));
  EXPECT_EQ(rulings_table({verdict()}).rows[poor][1], "goal missed, probably for another reason");

  scenario_.conditions.pop_back();
  paces_.pop_back();
  EXPECT_THAT(advice_of({verdict()}), ElementsAre("Look for the reason in what differs from “fast "
                                                  "board”, such as the radio."));
}

TEST_F(MissReasons, CompareOnlyWhatIsEquallyFast) {
  const std::size_t poor = add("poor radio", 0, 5, measured(0.02));
  const std::size_t good = add("good radio", 5, 0, measured(0.02));
  ASSERT_EQ(ruling(poor), Ruling::kOtherReason);
  const Pace before = *paces_[poor];
  const auto expect_not = [&](const char* what) {
    EXPECT_EQ(ruling(poor), Ruling::kGoalMissed) << what;
    paces_[poor] = before;
  };
  program(poor).clock.factor = 6.0;
  paces_[poor]->radio = "poor";
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
TEST_F(MissReasons, DoNotRestOnAFlightThatFailed) {
  const std::size_t board = add("board", 0, 6, measured(0.02));
  const std::size_t reference = add("instant", 0, 6, instant());
  trials(reference)[1].versions["simulator"] = "Gazebo";
  for (const std::size_t condition : {board, reference}) {
    campaign::invalidate(trials(condition)[0], "no port");
    trials(condition)[0].versions.clear();
  }
  EXPECT_EQ(ruling(board), Ruling::kGoalMissed);
}

// With so few flights, chance explains the difference.
TEST_F(MissReasons, DoNotBuildOnChance) {
  const std::size_t poor = add("poor radio", 0, 1, measured(0.02));
  add("good radio", 2, 0, measured(0.02));
  EXPECT_EQ(ruling(poor), Ruling::kGoalMissed);
}

TEST_F(MissReasons, AreNotSoughtWhereTheFlightsLeaveItOpen) {
  const std::size_t poor = add("poor radio", 7, 3, measured(0.02));
  add("good radio", 36, 0, measured(0.02));
  EXPECT_EQ(ruling(poor), Ruling::kUndecided);
  const std::size_t none = add("not flown", 0, 0, measured(0.02));
  EXPECT_EQ(ruling(none), Ruling::kNotFlown);
}

}  // namespace
}  // namespace tether::report
