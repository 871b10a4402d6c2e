#include "sample_size.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tether::report {
namespace {

TEST(SizeJson, HasQuestionAnswerFlightsAndBoards) {
  SizeReport report = sample_size();
  report.unsynchronised = report.synchronised;
  const auto json = nlohmann::json::parse(size_json(report));
  EXPECT_EQ(json["schema"], kSizeSchemaVersion);
  EXPECT_EQ(json["question"]["between"][1], 10.0);
  EXPECT_EQ(json["answer"]["threshold"], 3.1);
  EXPECT_EQ(json["answer"]["where"], "within");
  EXPECT_EQ(json["answer"]["basis"], "curve");
  ASSERT_EQ(json["flights"].size(), 10U);
  EXPECT_EQ(json["flights"][0]["metrics"]["time_required"], 2.0);
  EXPECT_EQ(json["flights"][9]["reached"], false);
  EXPECT_EQ(json["boards"][0]["verdict"], "sufficient");
  EXPECT_EQ(json["boards"][0]["calibration"][0], 1.7);
  EXPECT_EQ(json["unsynchronised"]["condition"], "target");
}

}  // namespace
}  // namespace tether::report
