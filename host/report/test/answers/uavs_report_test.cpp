#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tether/report/junit.h>
#include <tether/report/size_report.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Of up to four UAVs: the flights with each number of them, and how many reach the goal.
UavsReport report_of(const std::vector<sizing::UavLevel>& levels, const std::string& digest = "") {
  UavsReport report;
  report.scenario = "four";
  report.named = "/tests/four.toml";
  report.condition = "one for all";
  report.board = "obc";
  report.question.most = 4;
  report.most_flights = 300;
  for (const sizing::UavLevel& level : levels) {
    UavsPoint& point = report.points.emplace_back(UavsPoint{{level.uavs}, {}});
    for (std::size_t i = 0; i < level.flights; ++i) {
      campaign::TrialResult trial;
      trial.seed = i + 1;
      trial.flight_digest = digest;
      trial.outcome =
          i < level.reached ? campaign::Outcome::kGoalReached : campaign::Outcome::kGoalMissed;
      add_flight(point, trial);
    }
  }
  report.answer = sizing::answer_by_uavs(report.question, uav_levels(report.points));
  return report;
}

TEST(UavsReport, AnswersFirst) {
  struct Case {
    std::vector<sizing::UavLevel> levels;
    const char* lead;
    std::size_t sentences;
  };
  for (const Case& c : {Case{{{2, 36, 36}, {3, 2, 0}}, "This board carries 2 UAVs", 1},
                        {{{1, 36, 36}, {2, 2, 0}}, "This board carries 1 UAV", 1},
                        {{{4, 36, 36}}, "This board carries at least 4 UAVs", 1},
                        {{{1, 2, 0}}, "This board does not carry 1 UAV", 1},
                        {{{2, 36, 36}, {3, 9, 8}}, "This board carries at least 2 UAVs", 2}}) {
    const auto answers = uavs_answers(report_of(c.levels));
    EXPECT_EQ(answers.front().lead, c.lead);
    EXPECT_EQ(answers.size(), c.sentences) << c.lead;
  }
  EXPECT_EQ(
      uavs_answers(report_of({{2, 36, 36}, {3, 2, 0}}))[0].rest,
      " (“obc” under “one for all”, 90 % of the flights wanted): with 2 UAVs 36 of 36 flights "
      "reach the goal and with 3 UAVs 0 of 2; 95 %; 38 flights.");
}

TEST(UavsReport, AdvisesToVaryWhatTheSeedsDoNotChange) {
  const std::size_t flights = sizing::kMostCopies + 1;
  const UavsReport report = report_of({{1, flights, flights}}, "01");
  EXPECT_THAT(uavs_advice(report), testing::Contains(HasSubstr("the seeds change nothing")));
  EXPECT_FALSE(is_answered(report));
}

TEST(UavsReport, SaysWhatSharingCostsAndWhatToDo) {
  UavsReport report = report_of({{2, 36, 36}, {3, 2, 0}});
  report.pace.pace = Pace{.stages = {{.stage = "detect", .share = 0.8}},
                          .camera = "camera",
                          .median_s = 0.12,
                          .shared_board = "obc",
                          .programs = 3,
                          .waiting = 0.66};
  EXPECT_EQ(uavs_answers(report)[1].rest,
            ": with 3 UAVs, an image costs 120 ms on the board, 66 % of it waiting for cores.");
  report.pace = pace_at_limit(report);
  EXPECT_THAT(uavs_answers(report).back().rest, HasSubstr("the result of seed "));
  report.pace.pace = Pace{.stages = {{.stage = "detect", .share = 0.8}}, .shared_board = "obc"};
  EXPECT_THAT(uavs_advice(report)[0], HasSubstr("speed up “detect” first"));
  EXPECT_THAT(uavs_advice(report_of({{4, 36, 36}}))[0], StartsWith("To find the limit"));
  EXPECT_THAT(uavs_advice(report_of({{2, 3, 3}}))[0], StartsWith("Fly more"));
}

// The second UAV may fly into a wall.
TEST(UavsReport, DoesNotBlameTheBoardIfHardlyAProgramWaitsForCores) {
  UavsReport report = report_of({{1, 36, 36}, {2, 3, 0}});
  report.pace.pace = Pace{.stages = {{.stage = "detect", .share = 0.8}},
                          .camera = "camera",
                          .median_s = 0.01,
                          .shared_board = "obc",
                          .programs = 2,
                          .waiting = 0.02};
  EXPECT_EQ(uavs_answers(report).front().lead,
            "Goal missed with 2 UAVs; that they share the board is probably not the reason");
  EXPECT_THAT(uavs_advice(report)[0],
              StartsWith("Look at what the added UAV does: `tether run /tests/four.toml "));
  for (const std::string& advice : uavs_advice(report))
    EXPECT_THAT(advice, testing::Not(HasSubstr("speed up")));
  report.pace.pace->shared_board.clear();
  EXPECT_THAT(uavs_answers(report).front().lead, StartsWith("Goal missed")) << "cores of their own";
  report.pace.pace->shares_real_board = true;
  EXPECT_THAT(uavs_answers(report).front().lead, StartsWith("This board carries"));
  report.pace.pace->shares_real_board = false;
  report.pace.pace->shared_board = "obc";
  report.pace.pace->waiting = 0.5;
  report.pace.pace->read_hz = 30.0;
  report.pace.pace->offered_hz = 30.0;
  EXPECT_EQ(uavs_answers(report).front().lead,
            "Goal missed with 2 UAVs; whether sharing the board is the reason is not known");
  EXPECT_THAT(uavs_advice(report)[0], StartsWith("Look at what the added UAV does"));
  report.pace.pace->read_hz = 9.0;
  EXPECT_THAT(uavs_answers(report).front().lead, StartsWith("This board carries"))
      << "the program reads not all images";
}

TEST(UavsReport, HasTheSameAnswerAsJsonPageAndJunit) {
  const UavsReport report = report_of({{2, 36, 36}, {3, 2, 0}});
  const auto json = nlohmann::json::parse(size_json(report));
  EXPECT_EQ(json["axis"], "uavs");
  EXPECT_EQ(json["answer"]["carried"], 2);
  EXPECT_EQ(json["answer"]["too_many"], 3);
  EXPECT_EQ(json["levels"][1]["reached"], 0);
  EXPECT_EQ(json["flights"].size(), 38u);
  const std::string page = size_page(size_answer(report));
  const auto answer = page.find("<strong>This board carries 2 UAVs</strong>");
  ASSERT_NE(answer, std::string::npos);
  EXPECT_LT(answer, page.find("<svg"));
  EXPECT_THAT(page, HasSubstr("90 to 100 %"));
  EXPECT_THAT(to_junit(size_answer(report), "out"), HasSubstr("failures=\"0\""));
  const UavsReport open = report_of({{2, 3, 3}});
  EXPECT_THAT(to_junit(size_answer(open), "out"), HasSubstr("failures=\"1\""));
  EXPECT_EQ(nlohmann::json::parse(size_json(report_of({{4, 36, 36}})))["answer"]["too_many"],
            nullptr);
}

}  // namespace
}  // namespace tether::report
