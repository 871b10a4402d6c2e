#include "answers/flights.h"
#include "sample_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/report/verdict.h>

namespace tether::report {
namespace {

using campaign::Outcome;
using campaign::TrialResult;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Pace slow_pace() {
  return {.uav = "uav1",
          .seed = 1,
          .stages = {{.stage = "detect", .count = 40, .median_s = 0.09, .share = 0.81}},
          .camera = "camera",
          .images = 40,
          .read_hz = 9.0,
          .offered_hz = 30.0,
          .median_s = 0.1,
          .p95_s = 0.11};
}

// Exact intervals: 6 of 10 has 26 to 88 %, 7 of 10 35 to 93 %, 35 of 35 90.0 to 100 %.
TEST(Verdict, RulesByTheExactIntervalOfTheShare) {
  struct Case {
    std::size_t reached, missed;
    Ruling ruling;
  };
  for (const Case& c : {Case{0, 1, Ruling::kGoalMissed},
                        {1, 0, Ruling::kFastEnoughSoFar},
                        {5, 5, Ruling::kGoalMissed},
                        {6, 4, Ruling::kGoalMissed},
                        {7, 3, Ruling::kUndecided},
                        {10, 0, Ruling::kFastEnoughSoFar},
                        {35, 0, Ruling::kFastEnoughSoFar},
                        {36, 0, Ruling::kFastEnough},
                        {98, 2, Ruling::kFastEnough},
                        {9, 1, Ruling::kUndecided},
                        {0, 0, Ruling::kNotFlown}})
    EXPECT_EQ(ruling_of(flights(c.reached, c.missed)), c.ruling) << c.reached << "+" << c.missed;
  const campaign::Interval interval = exact_interval(7, 10);
  EXPECT_NEAR(interval.low, 0.3475, 1e-4);
  EXPECT_NEAR(interval.high, 0.9333, 1e-4);
}

// What says nothing about the computer, or nothing yet.
TEST(Verdict, HasAnswersBesideYesAndNo) {
  struct Case {
    const char* what;
    void (*change)(campaign::ScenarioResults&);
    Ruling ruling;
    Advice::Kind advice;
  };
  using Kind = Advice::Kind;
  const std::vector<Case> cases = {
      {"no limit",
       [](auto& s) {
         for (auto& trial : s.conditions[0].trials) trial.metrics[0].max.reset();
       },
       Ruling::kNothingToDecide, Kind::kSetLimit},
      {"free-running",
       [](auto& s) {
         for (auto& trial : s.conditions[0].trials) trial.policy = "free_running";
       },
       Ruling::kFreeRunning, Kind::kSynchronise},
      {"set-up",
       [](auto& s) {
         for (auto& trial : s.conditions[0].trials) campaign::invalidate(trial, "no port");
       },
       Ruling::kSetUpFailed, Kind::kMendSetUp},
      {"audit",
       [](auto& s) {
         s.conditions[0].trials[3].audit = campaign::AuditVerdict{false, "late"};
         campaign::invalidate(s.conditions[0].trials[3], "the record breaks the rules of time");
       },
       Ruling::kVoid, Kind::kReadAudit},
      {"causality", [](auto& s) { s.conditions[0].trials[3].sync.causality_violations = 1; },
       Ruling::kVoid, Kind::kReadAudit},
      {"throttled",
       [](auto& s) {
         for (auto& trial : s.conditions[0].trials) {
           trial.outcome = Outcome::kGoalMissed;
           trial.this_run.target.emplace().is_spoiled = true;
         }
       },
       Ruling::kUndecided, Kind::kCoolBoard},
  };
  for (const Case& c : cases) {
    campaign::ScenarioResults scenario = flights(40, 0);
    c.change(scenario);
    const Verdict verdict = verdict_of(scenario);
    EXPECT_EQ(verdict.conditions[0].ruling, c.ruling) << c.what;
    ASSERT_FALSE(verdict.advice.empty()) << c.what;
    EXPECT_EQ(verdict.advice[0].kind, c.advice) << c.what;
  }
}

TEST(Verdict, CountsEachLimitThatWasMissed) {
  campaign::ScenarioResults scenario = flights(3, 5);
  std::vector<TrialResult>& trials = scenario.conditions[0].trials;
  trials[3].clauses = {{.uav = "uav1", .name = "face", .met = false}};
  trials[4].end = campaign::kEndTimeLimit;
  trials[5].contacts = {{.uav = "uav1", .count = 1, .hard = 1}};
  campaign::invalidate(trials[6], "the SUT was lost");
  const ConditionVerdict condition = verdict_of(scenario).conditions[0];
  EXPECT_EQ(condition.flown, 7u);
  EXPECT_EQ(condition.failed, 1u);
  EXPECT_EQ(condition.crashed, 1u);
  EXPECT_THAT(condition.missed,
              ElementsAre(MissedLimit{"time required ≤ 5 s", 4}, MissedLimit{"“face”", 1},
                          MissedLimit{"the time limit", 1}, MissedLimit{"“no crash”", 1}));
  EXPECT_EQ(condition.closest->first, "Time required");
  EXPECT_NEAR(condition.closest->second, -0.2, 1e-12);
  trials[0].clauses = {
      {.uav = "uav1", .name = "turn", .margin = -90.0, .unit = "ms", .limit = 150.0}};
  EXPECT_EQ(verdict_of(scenario).conditions[0].closest, std::pair(std::string("“turn”"), -0.6));
}

TEST(Verdict, KnowsAFlightThatMissedOnlyForWantOfAValue) {
  TrialResult trial = flights(0, 1).conditions[0].trials[0];
  EXPECT_EQ(missed_without_value(trial), "");
  trial.metrics[0].value.reset();
  trial.metrics[0].missing_because = "no estimates";
  EXPECT_EQ(missed_without_value(trial), "time required has no value: no estimates");
  EXPECT_EQ(missed_limits(std::vector<const TrialResult*>{&trial})[0].limit,
            "time required ≤ 5 s (no value: no estimates)");
  campaign::ScenarioResults scenario = flights(0, 1);
  scenario.conditions[0].trials = {trial};
  EXPECT_THAT(
      verdict_text({verdict_of(scenario)}, Markup::kPlain),
      testing::AllOf(HasSubstr("the flight does not meet time required ≤ 5 s (no value: no "
                               "estimates). "),
                     HasSubstr("Let the program report"), testing::Not(HasSubstr("tether size"))));
  trial.end = campaign::kEndTimeLimit;
  EXPECT_EQ(missed_without_value(trial), "");
}

TEST(Verdict, BeginsWithTheMostUrgentConditionThenTheSlowest) {
  campaign::ScenarioResults scenario = flights(10, 0);
  scenario.conditions.push_back(scenario.conditions[0]);
  EXPECT_EQ(verdict_of(scenario, {Pace{.p95_s = 0.1}, Pace{.p95_s = 0.2}}).lead, 1u);
  scenario.conditions.push_back(flights(5, 5).conditions[0]);
  EXPECT_EQ(verdict_of(scenario, {Pace{}, Pace{.p95_s = 0.2}}).lead, 2u);
}

TEST(Verdict, SaysTheAnswerWithItsEvidenceAndWhatToDo) {
  const std::vector<Verdict> verdicts = {verdict_of(flights(5, 5), {slow_pace()})};
  EXPECT_EQ(verdict_text(verdicts, Markup::kMarkdown),
            "**Goal missed**: on “target” 5 of 10 flights miss the goal (not met: time required "
            "≤ 5 s (5 flights)); the camera is read 9.0 times a second instead of 30, and “detect” "
            "takes 81 % of the computing time. No condition that is clearly faster and "
            "otherwise the same was flown, so whether speed matters is not known. They all begin "
            "alike, and differ only in noise and measured "
            "times.\n\n"
            "- To see whether speed matters, fly on a faster computer: `tether size turn "
            "--condition target --between 0.1,2`\n\n");
  const std::string plain = verdict_text(verdicts, Markup::kPlain);
  EXPECT_THAT(plain, StartsWith("Goal missed: on “target”"));
  EXPECT_EQ(plain.find_first_of("*`"), std::string::npos);
}

// A command that the user can type: of that scenario, and quoted.
TEST(Verdict, NamesTheCommandThatFindsTheThreshold) {
  const auto advice = [](std::size_t reached, std::optional<campaign::Sizing> sizing) {
    campaign::ScenarioResults scenario = flights(reached, 10 - reached);
    scenario.conditions[0].trials[0].this_run.sizing = std::move(sizing);
    return advice_of({verdict_of(scenario)}).back();
  };
  EXPECT_THAT(advice(10, campaign::Sizing{"/my own/s.toml", "target, counted"}),
              EndsWith("`tether size '/my own/s.toml' --condition 'target, counted'`"));
  EXPECT_THAT(advice(0, campaign::Sizing{"turn", "host"}), EndsWith("host --between 0.1,2`"));
  EXPECT_THAT(advice(0, campaign::Sizing{"turn", "host", "b.toml"}),
              EndsWith("--target b.toml`"));  // of which the host's time is the unit
  EXPECT_THAT(advice(0, campaign::Sizing{"turn", "host", "", std::pair(0.75, 40.0)}),
              EndsWith("host --between 0.75,40`"));
  EXPECT_EQ(advice(0, {}), "To see whether speed matters, fly on a faster computer.");
  EXPECT_THAT(advice(10, {}), StartsWith("To find the headroom, "));
}

// A real board cannot be slowed down.
TEST(Verdict, OfARealBoardAdvisesToSizeAVirtualTargetOfIt) {
  campaign::ScenarioResults scenario = flights(10, 0);
  campaign::ThisRun& run = scenario.conditions[0].trials[0].this_run;
  run.sizing.reset();
  run.target = {.name = "pi", .address = "ssh://pi"};
  EXPECT_THAT(advice_of({verdict_of(scenario)}).back(), StartsWith("A real board cannot"));
}

TEST(Verdict, NamesTheSlowestConditionThatWouldDo) {
  campaign::ScenarioResults scenario = flights(0, 10);
  scenario.conditions.push_back(flights(10, 0).conditions[0]);
  scenario.conditions.push_back(flights(10, 0).conditions[0]);
  scenario.conditions[1].condition = "slow host";
  scenario.conditions[2].condition = "host";
  Pace host = slow_pace(), slow_host = slow_pace();
  host.median_s = 0.01;
  slow_host.median_s = 0.025;
  host.speed.target = "host";
  slow_host.speed.target = "slow host";
  EXPECT_THAT(answers_of({verdict_of(scenario, {slow_pace(), slow_host, host})})[0].rest,
              HasSubstr(" “slow host” is fast enough so far: an image costs 25 ms instead of "
                        "100 ms, 4.0 × less."));
}

TEST(Verdict, OfASweepOverTheFactorSaysHowSlowWouldDo) {
  const auto point = [](const std::string& rate, const std::string& factor, std::size_t missed) {
    campaign::ScenarioResults scenario = flights(10 - missed, missed);
    scenario.settings = {{"rate_hz", rate}, {"cpu_factor", factor}};
    return verdict_of(scenario);
  };
  const std::vector<Answer> answers =
      answers_of({point("10", "12", 10), point("10", "2", 0), point("10", "6", 0),
                  point("20", "2", 0), point("30", "2", 10), point("30", "6", 0)});
  EXPECT_EQ(answers[0].lead, "Up to 6 × slower would do");
  EXPECT_EQ(answers[0].rest,
            ": “target” with rate_hz = 10 is fast enough so far at cpu_factor = 6, and goal "
            "missed at 12.");
  EXPECT_EQ(answers[1].lead, "Up to 2 × slower would do");
  EXPECT_THAT(answers[1].rest, EndsWith("at cpu_factor = 2, the largest that was flown."));
  EXPECT_THAT(answers[2].lead, Not(HasSubstr("would do")));  // at 30: not even the least
}

TEST(Verdict, OfASweepSaysWhatItsHeadlineDoesNotKnow) {
  const auto point = [](const std::string& factor, std::vector<Warning> warnings) {
    campaign::ScenarioResults scenario = flights(2, 0);  // copies
    for (TrialResult& trial : scenario.conditions[0].trials) trial.flight_digest = "same";
    scenario.settings = {{"cpu_factor", factor}};
    scenario.conditions[0].trials[0].warnings = std::move(warnings);
    return verdict_of(scenario);
  };
  EXPECT_EQ(answers_of({point("2", {}), point("4", {})})[0].lead,
            "In one flight each, up to 4 × slower would do");
  Warning wind{Consequence::kBehavesDifferent, {}, "<wind>", "is not represented"};
  wind.can_change_verdict = true;
  EXPECT_THAT(answers_of({point("2", {wind}), point("4", {})})[0].lead,
              EndsWith(", but not everything is simulated as written, or is doubtful"));
}

TEST(Verdict, ThatIsGoodNamesWhatIsDoubtful) {
  campaign::ScenarioResults scenario = flights(10, 0);
  scenario.conditions[0].trials[3].warnings = {
      {Consequence::kDoubtful, {}, "UAV 'uav1'", "starts inside 'room'"}};
  EXPECT_THAT(verdict_text({verdict_of(scenario)}, Markup::kPlain),
              AllOf(StartsWith("Doubtful whether fast enough so far: "),
                    HasSubstr("Doubtful, which can change the answer: UAV 'uav1' starts inside "
                              "'room'.")));
}

TEST(Verdict, TakesThePaceOfItsFlightsAndNamesAResultWithoutOne) {
  campaign::CampaignResults results;
  results.scenarios = {flights(1, 1)};
  EXPECT_THAT(verdicts_of(results)[0].conditions[0].unknown_pace, HasSubstr("earlier version"));
  EXPECT_THAT(answers_of(verdicts_of(results))[0].rest,
              HasSubstr("The computing times are not known: the result of seed "));
  for (campaign::TrialResult& trial : results.scenarios[0].conditions[0].trials) {
    trial.pace = slow_pace();
    trial.pace->seed = trial.seed;
  }
  const ConditionVerdict condition = verdicts_of(results)[0].conditions[0];
  EXPECT_EQ(condition.unknown_pace, "");
  EXPECT_EQ(condition.pace->seed, results.scenarios[0].conditions[0].trials[1].seed)
      << "of the flight that missed the goal";
}

TEST(Verdict, SaysWhatItsWordsRestOn) {
  const auto text = [](const campaign::ScenarioResults& scenario) {
    return verdict_text({verdict_of(scenario)}, Markup::kPlain);
  };
  EXPECT_THAT(text(flights(7, 3)), HasSubstr("Undecided: on “target” 3 of 10 flights miss"));
  EXPECT_THAT(text(flights(7, 3)), HasSubstr("Fly more: if this share continues, "));
  EXPECT_THAT(advice_of({verdict_of(flights(7, 3), {slow_pace()})}),
              testing::Not(testing::Contains(HasSubstr("Speed up"))));
  EXPECT_THAT(text(flights(10, 0)), HasSubstr("36 flights decide"));
  EXPECT_THAT(text(flights(9, 1)), HasSubstr("so near to 9 of 10"));
  EXPECT_THAT(text(flights(1, 0)), StartsWith("Fast enough in this flight: "));
  EXPECT_THAT(text(flights(0, 1)),
              StartsWith("Goal missed: on “target” the flight does not meet time "
                         "required ≤ 5 s. "));
  campaign::ScenarioResults part = flights(8, 0);
  part.conditions[0].planned = 10;
  campaign::invalidate(part.conditions[0].trials[0], "no port");
  EXPECT_THAT(text(part),
              HasSubstr("1 flight failed and is not counted: no port. 2 flights have no result."));
  campaign::ScenarioResults stopped = flights(0, 0);
  stopped.conditions[0].planned = 10;
  EXPECT_THAT(text(stopped),
              AllOf(StartsWith("No answer: of 10 flights planned on “target”, none has ended."),
                    HasSubstr("--resume")));
}

TEST(Verdict, DoubtsTheComputerIsTheCauseIfEveryImageIsRead) {
  Pace pace = slow_pace();
  pace.read_hz = 30.0;
  const Verdict verdict = verdict_of(flights(0, 10), {pace});
  ASSERT_FALSE(verdict.advice.empty());
  EXPECT_EQ(verdict.advice[0].kind, Advice::Kind::kTryFaster);
}

TEST(Verdict, NamesTheSlowestBoardOfAFleet) {
  Pace pace = slow_pace();
  pace.boards = {{.board = "pi", .uavs = {"uav1"}, .median_s = 0.04, .p95_s = 0.05, .alone = 0.61},
                 {.board = "nano", .uavs = {"uav2", "uav3"}, .median_s = 0.1, .p95_s = 0.11}};
  const auto answers = [&] { return answers_of({verdict_of(flights(0, 10), {pace})}); };
  ASSERT_EQ(answers().size(), 2u);
  EXPECT_EQ(answers()[1].lead, "Slowest board");
  EXPECT_EQ(answers()[1].rest,
            ": “nano” of “target”. An image costs 100 ms on “nano” (uav2 and uav3; at most 110 ms "
            "in 95 %) and 40 ms on “pi” (uav1; at most 50 ms in 95 %). Of the wall time, the "
            "simulation waited 61 % for “pi” alone.");
  for (BoardPace& board : pace.boards) board.median_s = board.p95_s = 0.0;
  EXPECT_THAT(answers()[1].rest, StartsWith(": “pi” of “target”. Of the wall time"));
  pace.boards[0].flights = 10;
  pace.boards[0].slowest_in = 9;
  pace.boards[0].alone_range = {0.5, 0.7};
  EXPECT_EQ(answers()[1].rest,
            ": “pi” of “target”, in 9 of 10 flights. Of the wall time, the simulation waited 61 % "
            "(50 % to 70 %) for “pi” alone. These are means over the flights, with the least and "
            "the largest of a flight.");
  pace.boards[0].alone.reset();
  EXPECT_EQ(answers().size(), 1u) << "nothing is known of the boards";
}

TEST(Verdict, SaysWhatAnImageCostsOnASharedBoard) {
  Pace pace = slow_pace();
  pace.shared_board = "obc";
  pace.programs = 2;
  pace.waiting = 0.48;
  Verdict verdict = verdict_of(flights(10, 0), {pace});
  verdict.conditions[0].sizing = {.scenario = "pair", .condition = "one for all"};
  EXPECT_THAT(answers_of({verdict})[0].rest,
              HasSubstr("an image costs 100 ms on “obc”, 48 % of it waiting for the cores that 2 "
                        "programs share, and “detect” takes 81 % of the computing time"));
  verdict.advice.push_back({Advice::Kind::kSpeedUpStage, "detect"});
  EXPECT_THAT(advice_of({verdict}).back(), HasSubstr("Computing and waiting for cores take up to"));
  EXPECT_THAT(advice_of({verdict})[1],
              HasSubstr("; to find how many UAVs it carries: `tether size pair --condition "
                        "'one for all' --axis uavs`"));
  EXPECT_THAT(stages_table({verdict}).notes,
              testing::Contains(HasSubstr(": 100 ms, 48 % of it waiting for the cores of “obc”,")));
}

TEST(Verdict, OfASweepGroupsItsPointsByTheirRuling) {
  std::vector<Verdict> verdicts;
  for (const std::size_t missed : {0U, 0U, 10U}) {
    campaign::ScenarioResults point = flights(10, missed);
    point.swept_from = "turn";
    point.settings = {{"cpu_factor", std::to_string(verdicts.size() + 1)}};
    verdicts.push_back(verdict_of(point));
  }
  verdicts.push_back(verdict_of(flights(36, 0)));
  const auto groups = by_scenario(verdicts);
  ASSERT_EQ(groups.size(), 2u);
  const std::vector<Answer> answers = answers_of(groups[0]);
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_EQ(answers[0].lead, "Up to 2 × slower would do");
  EXPECT_EQ(answers[1].lead, "Goal missed") << "the most urgent ruling first";
  EXPECT_EQ(answers[2].lead, "Fast enough so far");
  EXPECT_EQ(answers[2].rest,
            ": “target” with cpu_factor = 1 (10 of 10 flights) and cpu_factor = 2 (10 of 10 "
            "flights). They all begin alike, and differ only in noise and measured times.");
  EXPECT_EQ(answers[3].lead, "Differences");
  EXPECT_THAT(answers[3].rest, StartsWith(": 2 of 3 pairs of points differ in how often"));
  EXPECT_THAT(advice_of(groups[0])[0], StartsWith("cpu_factor = 3: "));
  EXPECT_EQ(rulings_table(groups[0]).rows.size(), 3u);
}

// Audits of records that were cut, and tables of nothing, hide the cause.
TEST(Verdict, OfAFlightThatFailedHasOneCauseAndOneAction) {
  campaign::ScenarioResults scenario = flights(1, 0);
  TrialResult& trial = scenario.conditions[0].trials[0];
  trial.end = "sut_lost";
  trial.audit = campaign::AuditVerdict{false, "late"};
  campaign::invalidate(trial, "lost the SUT of \"uav1\"");
  EXPECT_EQ(verdict_text({verdict_of(scenario)}, Markup::kPlain),
            "No answer: lost the SUT of \"uav1\".\n  → Fix this, then fly again.\n\n");
  trial.end = campaign::kEndInterrupted;
  trial.reason = "interrupted";
  EXPECT_EQ(verdict_text({verdict_of(scenario)}, Markup::kPlain),
            "No answer: interrupted.\n  → You stopped the flight: fly again.\n\n");
  trial.this_run.doubts = {{campaign::Doubt::Kind::kUnseenWait, "uav1", 7.0}};
  EXPECT_THAT(
      verdict_text({verdict_of(scenario)}, Markup::kPlain),
      testing::AllOf(
          StartsWith("No answer: interrupted. The program of uav1 waited up to about 7 s on "
                     "something that Tether does not see.\n"),
          HasSubstr("Wait by the client library")));
}

TEST(Verdict, CountsCopiesOfAFlightOnce) {
  campaign::ScenarioResults scenario = flights(40, 0);
  std::vector<TrialResult>& trials = scenario.conditions[0].trials;
  for (TrialResult& trial : trials) trial.flight_digest = "same";
  const Verdict verdict = verdict_of(scenario);
  EXPECT_EQ(verdict.conditions[0].ruling, Ruling::kFastEnoughSoFar);
  EXPECT_EQ(verdict.conditions[0].share, exact_interval(1, 1));
  EXPECT_THAT(verdict_text({verdict}, Markup::kPlain),
              testing::AllOf(StartsWith("Fast enough in this flight: on “target” one flight, flown "
                                        "40 times, reaches the goal within the limits."),
                             HasSubstr("the seeds change nothing")));
  EXPECT_EQ(rulings_table({verdict}).rows[0][3], "one flight, 40 times");
  trials[7].flight_digest = "another";
  EXPECT_THAT(verdict_text({verdict_of(scenario)}, Markup::kPlain),
              StartsWith("Fast enough so far: on “target” 40 of 40 flights (2 different ones) "
                         "reach the goal"));
}

// A script that starts the program is the same after the program was built again.
TEST(Verdict, IsUndecidedIfFlightsAreOfDifferentBuilds) {
  auto results = sample_results({{"host", {4.0, 4.0, 4.0}}});
  auto& trials = results.conditions[0].trials;
  for (campaign::TrialResult& trial : trials)
    trial.pace = Pace{.speed = {.programs = {{.uav = "uav1", .build = "35ed\nfile log 1"}}}};
  trials[1].pace->speed.programs[0].build = "35ed\nfile log 2";
  EXPECT_EQ(verdict_of(results).first().ruling, Ruling::kNothingToDecide) << "the program's file";
  trials[2].pace->speed.programs[0].build = "3f07\nfile log 1";
  for (campaign::TrialResult& trial : trials) trial.metrics[0].max = 5.0;
  EXPECT_THAT(verdict_text({verdict_of(results)}, Markup::kPlain),
              HasSubstr("The flights are of different builds of the program"));
  trials[2].pace->speed.programs[0].build = "35ed";
  trials[2].pace->speed.programs[0].libraries = {"liblaw.so 0b"};
  trials[0].pace->speed.programs[0].libraries = {"liblaw.so 0a"};
  trials[1].pace = trials[0].pace;
  EXPECT_THAT(verdict_text({verdict_of(results)}, Markup::kPlain),
              testing::AllOf(testing::StartsWith("Undecided"),
                             HasSubstr("The flights are of different builds of liblaw.so"),
                             testing::Not(HasSubstr("Fly more"))));
}

TEST(Verdict, HasNoAnswerIfTimePassesUnseen) {
  campaign::ScenarioResults scenario = flights(1, 0);
  std::vector<campaign::Doubt>& doubts = scenario.conditions[0].trials[0].this_run.doubts;
  doubts = {{campaign::Doubt::Kind::kUnseenWait, "uav1", 4.86}};
  EXPECT_THAT(verdict_text({verdict_of(scenario)}, Markup::kPlain),
              testing::AllOf(
                  StartsWith("No answer: the program of uav1 waited up to about 4.9 s on something "
                             "that Tether does not see."),
                  HasSubstr("→ Wait by the client library (sleep_for")));
  doubts[0] = {campaign::Doubt::Kind::kParallelThreads, "uav1", 1.9};
  EXPECT_THAT(verdict_text({verdict_of(scenario)}, Markup::kPlain),
              StartsWith("No answer: threads of the program of uav1 computed in parallel (1.9 × "));
}

TEST(Verdict, OfASweepNamesWhatLimitsItsPoints) {
  campaign::ScenarioResults windy = flights(10, 0), lost = flights(1, 0);
  Warning wind{Consequence::kMissing, {}, "<wind>", "is not simulated"};
  wind.can_change_verdict = true;
  for (campaign::TrialResult& trial : windy.conditions[0].trials) trial.warnings = {wind};
  campaign::invalidate(lost.conditions[0].trials[0], "the board is not found");
  for (campaign::ScenarioResults* point : {&windy, &lost}) {
    point->swept_from = "turn";
    point->settings = {{"world", point == &windy ? "\"windy\"" : "\"lost\""}};
  }
  const std::vector<Answer> answers = answers_of({verdict_of(windy), verdict_of(lost)});
  EXPECT_THAT(answers[0].rest, HasSubstr("The first reason: the board is not found."));
  EXPECT_EQ(answers[1].lead, "Fast enough so far, but not everything is simulated as written");
  EXPECT_THAT(answers[1].rest, HasSubstr("<wind>"));
}

TEST(Verdict, NamesWhatOfTheWorldIsMissing) {
  campaign::ScenarioResults scenario = flights(1, 0);
  Warning warning{Consequence::kMissing, {}, "<wind>", "is not simulated; remove it"};
  warning.can_change_verdict = true;
  scenario.conditions[0].trials[0].warnings = {warning};
  EXPECT_THAT(verdict_text({verdict_of(scenario)}, Markup::kPlain),
              testing::AllOf(StartsWith("Fast enough in this flight, but not everything is "
                                        "simulated as written: "),
                             HasSubstr("which can change the answer: <wind> is not simulated.\n")));
}

TEST(Verdict, OfSeveralScenariosBeginsWithTheMostUrgent) {
  campaign::ScenarioResults missed = flights(0, 10);
  missed.scenario = "search";
  EXPECT_THAT(verdict_text({verdict_of(flights(10, 0)), verdict_of(missed)}, Markup::kPlain),
              StartsWith("search: Goal missed: "));
}

TEST(Verdict, TablesHaveHeadroomIntervalsAndStages) {
  const std::vector<Verdict> verdicts = {verdict_of(flights(7, 3), {slow_pace()})};
  EXPECT_THAT(rulings_table(verdicts).rows,
              ElementsAre(ElementsAre("target", "undecided", "7 of 10", "35 to 93 %", "0.3 ×",
                                      "Time required: 20 % beyond")));
  const Table stages = stages_table(verdicts);
  EXPECT_THAT(stages.rows,
              ElementsAre(ElementsAre("target", "detect", "40", "90.000", "0.000", "81.0 %")));
  EXPECT_THAT(stages.notes,
              testing::Contains(HasSubstr("Per image of “camera”: 100 ms of computing")));
}

}  // namespace
}  // namespace tether::report
