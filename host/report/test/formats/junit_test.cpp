#include "campaign_fixture.h"
#include "sample_size.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <tinyxml2.h>

#include <tether/os/text_file.h>
#include <tether/report/junit.h>
#include <tether/report/report.h>
#include <tether/report/size_report.h>

namespace tether::report {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tinyxml2::XMLElement;

class Junit : public CampaignFixture {
 protected:
  /// Also checks it against the schema.
  const XMLElement& suites(const std::string& xml) {
    const std::string file = scratch_.write("junit.xml", xml);
    const std::string check = "xmllint --noout --schema " TETHER_TEST_DIR "/data/junit.xsd '" +
                              file + "' 2> '" + scratch_.path("log").string() + "'";
    EXPECT_EQ(std::system(check.c_str()), 0) << os::read_file(scratch_.path("log"));
    EXPECT_EQ(document_.Parse(xml.c_str()), tinyxml2::XML_SUCCESS);
    return *document_.RootElement();
  }
  static std::vector<std::string> cases_of(const XMLElement& suite) {
    std::vector<std::string> cases;
    for (const XMLElement* c = suite.FirstChildElement("testcase"); c;
         c = c->NextSiblingElement("testcase")) {
      const XMLElement* problem = c->FirstChildElement();
      cases.push_back(std::string(c->Attribute("name")) +
                      (problem ? std::string(": ") + problem->Name() : ""));
    }
    return cases;
  }

  tinyxml2::XMLDocument document_;
};

TEST_F(Junit, HasACaseForTheOutcomeEachMetricAndEachClause) {
  campaign::TrialResult result = trial("target", 1, 2, 31.5);
  result.outcome = campaign::Outcome::kGoalMissed;
  result.reason = "clause \"near\" <is> missed & so on \x01";
  judge::ClauseVerdict met{.uav = "uav1", .name = "near", .met = true};
  met.margin = 0.5;
  met.unit = "m";
  result.clauses = {met, {.uav = "uav1", .name = "early", .limited_by = "it did not run"}};
  write(result);
  os::write_file_atomically(folder_of("target", 1) / "record.mcap", "a record");
  const XMLElement& suite =
      *suites(to_junit(read_run_results(folder_of("target", 1)), folder_of("target", 1)))
           .FirstChildElement();
  EXPECT_THAT(cases_of(suite), ElementsAre("outcome: failure", "Oscillations",
                                           "Time required: failure", "near", "early: failure"));
  EXPECT_EQ(suite.IntAttribute("tests"), 5);
  EXPECT_EQ(suite.IntAttribute("failures"), 3);
  const XMLElement& property = *suite.FirstChildElement("properties")->FirstChildElement();
  EXPECT_STREQ(property.Attribute("name"), "verdict");
  EXPECT_THAT(property.Attribute("value"),
              StartsWith("Goal missed: on “target” the flight does not meet “early” and time "
                         "required ≤ 30 s. "));
  EXPECT_STREQ(suite.Attribute("timestamp"), "2024-05-01T10:00:00");
  const std::string output = suite.FirstChildElement("system-out")->GetText();
  EXPECT_THAT(output, HasSubstr("[seed-0001 / near]\nmargin: 0.5 m\n"));
  EXPECT_THAT(output, HasSubstr("record: " + (folder_of("target", 1) / "record.mcap").string()));
}

TEST_F(Junit, HasASuiteForEachConditionOfACampaign) {
  std::filesystem::remove(folder_of("target", 2) / "result.json");
  campaign::TrialResult failed = trial("target", 3, 0, 1);
  campaign::invalidate(failed, "the SUT was lost");
  write(failed);
  const XMLElement& all = suites(to_junit(this->all(), out_));
  const XMLElement* host = all.FirstChildElement();
  EXPECT_STREQ(host->Attribute("name"), "turn, host");
  EXPECT_EQ(host->IntAttribute("tests"), 9);
  EXPECT_EQ(host->IntAttribute("failures") + host->IntAttribute("errors"), 0);
  EXPECT_THAT(cases_of(*host->NextSiblingElement()),
              ElementsAre("outcome", "Oscillations", "Time required", "outcome: error",
                          "outcome: error", "Oscillations: error", "Time required: error"));
}

/// The property "verdict" of the only suite.
std::string verdict_in(const XMLElement& all) {
  const XMLElement* property =
      all.FirstChildElement()->FirstChildElement("properties")->FirstChildElement();
  EXPECT_STREQ(property->Attribute("name"), "verdict");
  return property->Attribute("value");
}

TEST_F(Junit, OfASizeHasTheVerdictAndACaseForTheAnswerAndEachBoard) {
  SizeReport report = sample_size();
  report.boards.push_back({"old.toml", 9.0, {}, {}});
  const XMLElement& all = suites(to_junit(size_answer(report), out_));
  EXPECT_THAT(verdict_in(all), StartsWith("Sufficient up to 3.1 × slower"));
  EXPECT_THAT(cases_of(*all.FirstChildElement()),
              ElementsAre("answer", "pi.toml", "old.toml: failure"));
  report.synchronised.trials[1].this_run.doubts = {
      {campaign::Doubt::Kind::kUnseenWait, "uav1", 0.4}};
  const XMLElement& unseen = suites(to_junit(size_answer(report), out_));
  EXPECT_THAT(verdict_in(unseen), StartsWith("No answer: the program of uav1 waited up to about"));
  EXPECT_THAT(cases_of(*unseen.FirstChildElement()),
              ElementsAre("answer: failure", "pi.toml: failure", "old.toml: failure"));
}

TEST_F(Junit, OfNumbersOfUavsHasTheVerdict) {
  UavsReport report;
  report.condition = "all";
  report.board = "obc";
  report.question.most = 2;
  report.answer.too_many = 3;
  EXPECT_THAT(verdict_in(suites(to_junit(size_answer(report), out_))),
              StartsWith("It is not known whether this board carries 1 UAV"));
}

TEST_F(Junit, OfWhatEndedBeforeThereWasAResult) {
  const XMLElement& all = suites(junit_of_error("a.toml", "a.toml:1: \"x\" <is> unknown"));
  EXPECT_THAT(cases_of(*all.FirstChildElement()), ElementsAre("outcome: error"));
}

TEST_F(Junit, AStageThatIsSlowerThanItsLimitFails) {
  timing::Timing now;
  now.scenario = "face_anchor";
  now.board = "pi";
  now.recorded_at = "2026-11-20T10:00:00Z";
  const timing::Comparison change{
      .stages = {{.stage = "detect <1>", .change = 0.2, .low = 0.1, .high = 0.3},
                 {.stage = "decide", .change = 0.05, .low = 0.0, .high = 0.1}},
      .added = {"track"},
      .removed = {},
      .doubt = "Busy machine."};
  const XMLElement& suite = *suites(change_junit(now, now, change, 0.1)).FirstChildElement();
  EXPECT_STREQ(suite.Attribute("name"), "timing of face_anchor");
  EXPECT_STREQ(suite.Attribute("failures"), "1");
  EXPECT_THAT(cases_of(suite), ElementsAre("detect <1>: failure", "decide"));
  EXPECT_STREQ(suite.FirstChildElement("testcase")->FirstChildElement()->Attribute("message"),
               "detect <1> +20 % [+10, +30], beyond the limit of +10 %");
  EXPECT_THAT(suite.FirstChildElement("system-out")->GetText(), HasSubstr("Busy machine."));
}

}  // namespace
}  // namespace tether::report
