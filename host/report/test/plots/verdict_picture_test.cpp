#include "plots/verdict_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

namespace tether::report {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
  return found;
}

Verdict verdict() {
  ConditionVerdict condition{.condition = "a <b>", .flown = 5, .reached = 3, .failed = 1};
  condition.pace = Pace{.stages = {{.stage = "detect", .share = 0.8}, {.stage = "x", .share = 0.2}},
                        .camera = "camera",
                        .images = 9,
                        .offered_hz = 30.0,
                        .median_s = 0.05,
                        .p95_s = 0.06};
  return {.scenario = "turn", .conditions = {condition, {.condition = "not flown"}}};
}

TEST(VerdictPicture, HasASignForEachFlightAndABarForEachStage) {
  const std::string drawings = verdict_picture({{verdict()}});
  EXPECT_EQ(count(drawings, "<svg"), 2u);
  EXPECT_EQ(count(drawings, "<circle"), 3u + 1u);          // reached, failed
  EXPECT_EQ(count(drawings, "stroke-width=\"2.5\""), 2u);  // missed
  EXPECT_EQ(count(drawings, "<rect"), 3u);                 // two stages, the whole
  EXPECT_EQ(count(drawings, "stroke-dasharray"), 1u);      // the camera's period
  EXPECT_EQ(count(drawings, "not flown"), 0u);
  EXPECT_EQ(count(drawings,
                  "aria-label=\"Flights of each condition; a &lt;b&gt;: undecided, 3 of 5 "
                  "reach the goal\""),
            1u);
  EXPECT_EQ(count(drawings, "aria-label=\"Computing time per image; a &lt;b&gt;: 50 ms"), 1u);
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(("<p>" + drawings + "</p>").c_str()), tinyxml2::XML_SUCCESS);
}

TEST(VerdictPicture, HasAPartForWaitingForCores) {
  Verdict shared = verdict();
  shared.conditions[0].pace->waiting = 0.5;
  const std::string drawings = verdict_picture({{shared}});
  EXPECT_EQ(count(drawings, "<rect"), 4u);
  EXPECT_EQ(count(drawings, "50 ms, of it detect 40 %, waiting for cores 50 %"), 2u)
      << "drawn, and for screen readers";
}

TEST(VerdictPicture, ShowsWhatIsKnown) {
  Verdict without = verdict();
  without.conditions[0].pace.reset();
  EXPECT_EQ(count(verdict_picture({{without}}), "<svg"), 1u);
  without.conditions.erase(without.conditions.begin());
  EXPECT_EQ(verdict_picture({{without}}), "");
}

}  // namespace
}  // namespace tether::report
