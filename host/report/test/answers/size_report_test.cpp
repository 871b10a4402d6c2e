#include "sample_size.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

std::vector<std::string> size_sentences(const SizeReport& report) {
  std::vector<std::string> sentences;
  for (const Answer& answer : size_answers(report)) sentences.push_back(answer.lead + answer.rest);
  return sentences;
}

TEST(SizeReport, AnswersFirstThenJudgesTheBoards) {
  const std::vector<std::string> sentences = size_sentences(sample_size());
  ASSERT_THAT(sentences, SizeIs(3));
  EXPECT_EQ(sentences[0],
            "Sufficient up to 3.1 × slower than “target” [2.7, 3.6], 95 %; 10 flights.");
  EXPECT_EQ(sentences[1], "Fast enough: pi.toml (1.9 ×) has 1.6 × headroom.");
  EXPECT_EQ(sentences[2], "Not met: time required ≤ 6.5 s (5 flights).");
}

TEST(SizeReport, SaysBesideTheIntervalThatTheMachinesSpreadIsNotInIt) {
  SizeReport report = sample_size();
  report.synchronised.trials[3].this_run.doubts = {{campaign::Doubt::Kind::kBusyMachine, "", 0.6}};
  EXPECT_EQ(size_sentences(report)[0],
            "Sufficient up to 3.1 × slower than “target” [2.7, 3.6] (without the machine's spread "
            "of 60 %), 95 %; 10 flights.");
}

TEST(SizeReport, SaysWhenTheAnswerIsOutsideTheRange) {
  SizeReport report = sample_size();
  report.synchronised.answer.is_above = true;
  EXPECT_THAT(size_sentences(report)[0], HasSubstr("Sufficient up to 10 × slower"));
  report.question.least = 0.1;
  report.question.most = 0.8;
  EXPECT_THAT(size_sentences(report)[0], HasSubstr("up to 0.8 × the computing time of “target”,"));
  report.question = sample_size().question;
  report.synchronised.answer.is_above = false;
  report.synchronised.answer.is_below = true;
  EXPECT_THAT(size_sentences(report)[0], HasSubstr("Not sufficient: already at 1 ×"));
}

TEST(SizeReport, SaysThatABoundIsOutsideTheRange) {
  SizeReport report = sample_size();
  sizing::Threshold& threshold = report.synchronised.answer.threshold;
  threshold = {0.6, 0.0, std::numeric_limits<double>::infinity()};
  EXPECT_THAT(
      size_sentences(report)[0],
      testing::StartsWith("Undecided: no slowdown of “target” is shown to be sufficient. The limit "
                          "is within [below 1, above 10],"));
  EXPECT_FALSE(is_answered(report));
  report.boards = {{"slow", 20.0}, {"fast", 0.1}};
  for (const Board& board : report.boards)
    EXPECT_EQ(verdict(board, report), BoardVerdict::kUndecided);
}

TEST(SizeReport, HasNoAnswerIfTimePassesUnseen) {
  SizeReport report = sample_size();
  report.boards = {{"fast", 0.1}};
  EXPECT_EQ(verdict(report.boards[0], report), BoardVerdict::kSuffices);
  report.synchronised.trials.resize(2);
  report.synchronised.trials[1].this_run.doubts = {
      {campaign::Doubt::Kind::kUnseenWait, "uav1", 0.4}};
  EXPECT_THAT(size_sentences(report),
              ElementsAre(HasSubstr("No answer: the program of uav1 waited")));
  EXPECT_EQ(verdict(report.boards[0], report), BoardVerdict::kUndecided);
}

TEST(SizeReport, SaysWhatLimitsTheAnswer) {
  SizeReport report = sample_size();
  report.synchronised.answer.is_narrow = false;
  report.synchronised.answer.basis = sizing::Basis::kLevels;
  const std::vector<std::string> sentences = size_sentences(report);
  ASSERT_THAT(sentences, SizeIs(5));
  EXPECT_THAT(sentences[2], HasSubstr("by neighbourhoods of slowdowns"));
  EXPECT_THAT(sentences[3], HasSubstr("wider than a factor of 1.3"));
  report.is_interrupted = true;
  EXPECT_THAT(size_sentences(report)[0], testing::StartsWith("Interrupted, so far: Sufficient"));
  EXPECT_THAT(size_sentences(report)[3], HasSubstr("because the search was interrupted"));
}

TEST(SizeReport, ComparesWithTheUnsynchronisedCondition) {
  SizeReport report = sample_size();
  report.unsynchronised = report.synchronised;
  report.unsynchronised->condition = "free";
  report.unsynchronised->answer.threshold = {6.2, 5.0, 7.0};
  EXPECT_EQ(size_sentences(report)[2],
            "Without synchronisation (“free”), 6.2 × slower would seem sufficient: 2 × too much.");
  report.unsynchronised->answer.threshold.estimate = 0.8;
  EXPECT_THAT(size_sentences(report)[2],
              HasSubstr(", 0.8 × the computing time would seem sufficient"));
}

TEST(SizeReport, AdvisesOnTheStageAndOnWhatIsNotKnown) {
  SizeReport report = sample_size();
  report.boards.clear();
  report.pace.pace.emplace().stages = {{.stage = "detect", .share = 0.81}};
  EXPECT_THAT(
      size_advice(report),
      testing::ElementsAre(
          "For more headroom, speed up “detect” first: it takes 81 % of the computing time.",
          HasSubstr("--target"), HasSubstr("--unsynchronised")));
  report.synchronised.answer.is_below = true;
  report.synchronised.answer.is_narrow = false;
  EXPECT_THAT(size_advice(report),
              testing::IsSupersetOf({HasSubstr("--max-trials"), HasSubstr("Speed up “detect”"),
                                     HasSubstr("--between 0.1,1")}));
}

TEST(SizeReport, NamesTheResultThatDoesNotHaveComputingTimes) {
  SizeReport report = sample_size();
  report.pace = pace_near_answer(report);
  EXPECT_EQ(report.pace.pace, std::nullopt);
  EXPECT_THAT(size_sentences(report).back(),
              testing::AllOf(HasSubstr("not known"), HasSubstr("the result of seed ")));
}

TEST(SizeReport, ABoardSufficesIfAllOfItsCalibrationDoes) {
  SizeReport report;
  SizedCondition& sized = report.synchronised;
  sizing::Answer& answer = sized.answer;
  answer.threshold = {3.1, 2.7, 3.6};
  EXPECT_EQ(verdict({"a", 2.6}, report), BoardVerdict::kSuffices);
  EXPECT_EQ(verdict({"a", 2.6, 2.5, 2.8}, report), BoardVerdict::kUndecided);
  EXPECT_EQ(verdict({"a", 3.0}, report), BoardVerdict::kUndecided);
  EXPECT_EQ(verdict({"a", 3.7, 3.5, 4.0}, report), BoardVerdict::kUndecided);
  EXPECT_EQ(verdict({"a", 3.7}, report), BoardVerdict::kDoesNot);
  answer = {};
  answer.is_above = true;
  answer.threshold = {10.0, 10.0, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(verdict({"a", 10.0}, report), BoardVerdict::kSuffices);
  EXPECT_EQ(verdict({"a", 11.0}, report), BoardVerdict::kUndecided);
  answer = {};
  answer.is_below = true;
  answer.threshold = {1.0, 0.0, 1.0};
  EXPECT_EQ(verdict({"a", 1.0}, report), BoardVerdict::kUndecided) << "whether speed matters";
  for (int i = 0; i < 10; ++i) sized.flights.push_back({1.0 + i, i < 5, std::nullopt});
  EXPECT_EQ(verdict({"a", 1.0}, report), BoardVerdict::kDoesNot);
  EXPECT_EQ(verdict({"a", 0.5}, report), BoardVerdict::kUndecided);
}

TEST(SizeReport, BlamesSpeedOnlyIfFasterFlightsReachTheGoalMoreOften) {
  SizeReport report = sample_size();
  SizedCondition& sized = report.synchronised;
  sized.answer.is_below = true;
  EXPECT_TRUE(speed_matters(sized));
  EXPECT_THAT(size_sentences(report)[0], testing::StartsWith("Not sufficient: already at"));
  for (sizing::Flight& flight : sized.flights) flight.reached = false;
  EXPECT_FALSE(speed_matters(sized));
  EXPECT_THAT(size_sentences(report)[0], testing::StartsWith("Goal missed: already at"));
  EXPECT_THAT(size_advice(report), testing::Not(Contains(HasSubstr("peed up"))));
}

TEST(SizeReport, DoesNotCountCopies) {
  SizeReport report = sample_size();
  SizedCondition& sized = report.synchronised;
  campaign::TrialResult trial = sized.trials[0];
  trial.flight_digest = sized.trials[0].flight_digest = "0123456789abcdef";
  EXPECT_TRUE(add_flight(sized, trial, sized.flights[0].slowdown));
  EXPECT_FALSE(add_flight(sized, trial, 9.0)) << "another computer";
  EXPECT_EQ(sized.copies, 1u);
  EXPECT_EQ(sized.trials.size(), 11u);
  EXPECT_THAT(size_sentences(report), Contains(HasSubstr("Not counted: 1 flight more, ")));
}

// All are one flight at several speeds.
TEST(SizeReport, ClaimsNoMoreThanOneFlightIfTheSeedsChangeNothing) {
  SizeReport report = sample_size();
  EXPECT_TRUE(is_answered(report));
  report.synchronised.copies = 1;
  EXPECT_EQ(size_sentences(report)[0],
            "In one flight, sufficient up to 3.1 × slower than “target”, at 10 slowdowns. The "
            "seeds change nothing, so this is one flight at several speeds, and what others do is "
            "not known.");
  EXPECT_EQ(size_sentences(report)[1],
            "Undecided: pi.toml (1.9 ×) may not be fast enough, because the seeds change nothing: "
            "this is one flight.");
  EXPECT_FALSE(is_answered(report));
  EXPECT_THAT(size_advice(report), Contains(HasSubstr("let the world or the start vary")));
  report.synchronised.flights[1].slowdown = report.synchronised.flights[0].slowdown;
  EXPECT_TRUE(is_answered(report)) << "two flights at one slowdown differ";
}

TEST(SizeReport, SaysFirstThatSlowerComputersReachTheGoalAgain) {
  SizeReport report = sample_size();
  SizedCondition& sized = report.synchronised;
  const auto fly = [&](double slowdown, bool reached) {
    sized.flights.insert(sized.flights.end(), 6, {slowdown, reached, std::nullopt});
    sized.trials.insert(sized.trials.end(), 6, sized.trials[0]);
  };
  fly(3.82, false);
  fly(6.2, false);
  EXPECT_EQ(size_sentences(report)[0].substr(0, 10), "Sufficient");
  fly(7.1, true);
  report.boards = {{"fast", 2.0}, {"slow", 3.9}, {"slower", 8.0}};
  EXPECT_THAT(
      size_sentences(report)[0],
      testing::AllOf(testing::StartsWith("Slower computers reach the goal again: 0 of "),
                     HasSubstr("but 6 of 6 flights at "),
                     testing::EndsWith("The limit that follows is below those that fail.")));
  EXPECT_THAT(size_sentences(report)[1], testing::StartsWith("Sufficient up to 3.1"));
  EXPECT_EQ(verdict(report.boards[0], report), BoardVerdict::kSuffices);
  EXPECT_EQ(verdict(report.boards[1], report), BoardVerdict::kDoesNot);
  EXPECT_EQ(verdict(report.boards[2], report), BoardVerdict::kUndecided);
  EXPECT_TRUE(is_answered(report));
  sized.answer.threshold = {7.1, 7.0, 7.4};
  EXPECT_THAT(size_sentences(report)[0], HasSubstr("The limit that follows is too high"));
  EXPECT_EQ(verdict(report.boards[1], report), BoardVerdict::kUndecided);
  EXPECT_FALSE(is_answered(report));
}

campaign::MetricValue limited(double value, std::optional<double> max, std::optional<double> min) {
  campaign::MetricValue metric{"m", "m", "M", "s", value, "", max};
  metric.min = min;
  return metric;
}

TEST(SizeReport, MarginsAreSharesOfTheLimit) {
  EXPECT_EQ(margin_of(limited(4.0, 5.0, {})), 0.2);
  EXPECT_EQ(margin_of(limited(6.0, {}, 5.0)), 0.2);
  EXPECT_EQ(margin_of(limited(6.0, {}, {})), std::nullopt);
  EXPECT_EQ(margin_of(limited(6.0, 0.0, {})), std::nullopt);
  campaign::MetricValue count = limited(1.0, 2.0, {});
  count.unit = "1";
  EXPECT_EQ(margin_of(count), std::nullopt);
}

TEST(SizeReport, AFlightHasTheMarginOfItsWorstMetricIfThatDecided) {
  campaign::TrialResult trial;
  trial.outcome = campaign::Outcome::kGoalReached;
  trial.metrics = {limited(4.0, 5.0, {}), limited(1.0, 5.0, {})};
  EXPECT_EQ(flight_of(trial, 2.0), (sizing::Flight{2.0, true, 0.2}));
  trial.outcome = campaign::Outcome::kGoalMissed;  // for another reason
  EXPECT_EQ(flight_of(trial, 2.0), (sizing::Flight{2.0, false, std::nullopt}));
}

}  // namespace
}  // namespace tether::report
