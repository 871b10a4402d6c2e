#include "sample_results.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tether/report/verdict.h>

namespace tether::report {
namespace {

TEST(VerdictJson, HasTheAnswerOfEachConditionAndWhatToDoNext) {
  campaign::CampaignResults results;
  results.scenarios.push_back(sample_results({{"host", {1.0, 2.0}}, {"target", {3.0}}}));
  const std::vector<Verdict> verdicts = verdicts_of(results);
  const nlohmann::json all = nlohmann::json::parse(verdicts_json(verdicts));
  ASSERT_EQ(all.size(), 1U);
  const Verdict& verdict = verdicts.front();
  EXPECT_EQ(all[0]["scenario"], verdict.scenario);
  EXPECT_EQ(all[0]["answer"], name(verdict.first()));
  EXPECT_EQ(all[0]["advice"], nlohmann::json(advice_of(verdicts)));
  const nlohmann::json& conditions = all[0]["points"][0]["conditions"];
  ASSERT_EQ(conditions.size(), verdict.conditions.size());
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    EXPECT_EQ(conditions[i]["condition"], verdict.conditions[i].condition);
    EXPECT_EQ(conditions[i]["answer"], name(verdict.conditions[i]));
    EXPECT_EQ(conditions[i]["flights"]["reached"], verdict.conditions[i].reached);
  }
}

// Also if a point of a later condition is the more urgent one.
TEST(VerdictJson, OfASweepHasTheAnswerWithWhichTheTextBegins) {
  campaign::CampaignResults results;
  for (const char* value : {"1", "2"}) {
    auto& point =
        results.scenarios.emplace_back(sample_results({{"host", {1.0}}, {"target", {3.0}}}));
    point.swept_from = "turn";
    point.settings = {{"fault", value}};
  }
  results.scenarios[0].conditions[0].trials[0].outcome = campaign::Outcome::kGoalMissed;
  results.scenarios[1].conditions[1].trials[0].outcome = campaign::Outcome::kFailed;
  const std::vector<Verdict> verdicts = verdicts_of(results);
  const nlohmann::json all = nlohmann::json::parse(verdicts_json(verdicts));
  EXPECT_EQ(all[0]["answer"], name(Ruling::kSetUpFailed));
  EXPECT_EQ(answers_of(verdicts)[0].ruling, Ruling::kSetUpFailed);
}

TEST(VerdictJson, ARunsResultKeepsItsMembers) {
  campaign::CampaignResults results;
  results.scenarios.push_back(sample_results({{"host", {1.0, 2.0}}, {"target", {3.0}}}));
  const Verdict verdict = verdicts_of(results).front();
  const nlohmann::json one =
      nlohmann::json::parse(with_answer(R"({"schema": 3, "outcome": "goal_missed"})", verdict));
  EXPECT_EQ(one["outcome"], "goal_missed");
  EXPECT_EQ(one["answer"]["answer"], name(verdict.first()));
}

}  // namespace
}  // namespace tether::report
