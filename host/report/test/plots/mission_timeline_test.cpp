#include "plots/mission_timeline.h"

#include <gmock/gmock.h>
#include <tinyxml2.h>

namespace tether::report {
namespace {

using ::testing::HasSubstr;

SimTime st(int s) {
  return SimTime(std::chrono::seconds(s));
}

TEST(MissionTimeline, HasABarForEachTaskAndALaneForEachClause) {
  campaign::TrialResult trial;
  EXPECT_EQ(mission_timeline(trial, "uav1"), "");
  trial.tasks = {{"uav1", "find <it>", st(0), st(3), "reached", ""}};
  judge::ClauseVerdict met{.uav = "uav1", .name = "near", .met = true};
  met.margin = 0.25;
  met.unit = "m";
  met.from = st(0);
  met.to = met.decided_at = st(20);
  met.margins = {{st(0), 1.0}, {st(20), 0.25}};
  judge::ClauseVerdict missed{.uav = "uav1", .name = "early"};
  missed.deadline = st(40);
  trial.clauses = {met, missed, {.uav = "uav2", .name = "of another"}};

  const std::string svg = mission_timeline(trial, "uav1");
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS);
  EXPECT_NE(document.RootElement()->FirstChildElement("polyline"), nullptr);
  int circles = 0;
  std::string texts;
  for (const auto* e = document.RootElement()->FirstChildElement(); e;
       e = e->NextSiblingElement()) {
    circles += e->Name() == std::string("circle") ? 1 : 0;
    if (e->Name() == std::string("text")) texts += std::string(e->GetText()) + "|";
  }
  EXPECT_EQ(circles, 1);
  for (const char* text :
       {"find <it>|reached|", "near|+0.25 m|", "early|missed|", "|0|5|10|15|20|25|30|35|40|"})
    EXPECT_THAT(texts, HasSubstr(text));
  EXPECT_THAT(texts, testing::Not(HasSubstr("another")));
}

}  // namespace
}  // namespace tether::report
