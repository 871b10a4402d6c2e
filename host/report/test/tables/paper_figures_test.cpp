
#include "tables/paper_figures.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace tether::report {
namespace {

TEST(PaperFigures, AreFoundByTableConditionAndKind) {
  const PaperTable* table = find_paper_table("III");
  ASSERT_NE(table, nullptr);
  EXPECT_EQ(table->find("target", "time_required", "time")->mean, 9.242);
  EXPECT_EQ(table->find("target", "time_required", "time")->stddev, 13.767);
  EXPECT_EQ(table->find("target, no sync", "oscillations", "oscillations")->mean, 0.0);
  EXPECT_EQ(table->find("target", "position_error", "position_error"), nullptr);
  EXPECT_EQ(find_paper_table("VI"), nullptr);
  EXPECT_FALSE(find_paper_table("II")->find("host", "bearing_error", "bearing_error")->stddev);
}

TEST(PaperFigures, OfOneKindAreDistinguishedByName) {
  const PaperTable* table = find_paper_table("I");
  ASSERT_NE(table, nullptr);
  EXPECT_EQ(table->find("host, no sync", "acquisition_time", "range_acquisition_time")->mean, 44.1);
  EXPECT_EQ(table->find("target", "acquisition_time", "imu_acquisition_time"), nullptr);
  EXPECT_TRUE(table->has_metric("acquisition_time", "camera_acquisition_time"));
  EXPECT_FALSE(table->has_metric("acquisition_time", "imu_acquisition_time"));
  EXPECT_EQ(find_paper_table("IV")->find("target", "abeam_error", "x")->mean, 0.106);
}

TEST(PaperFigures, AreUnique) {
  for (const std::string_view number : {"I", "II", "III", "IV", "V"}) {
    const PaperTable* table = find_paper_table(number);
    ASSERT_NE(table, nullptr) << number;
    std::set<std::string> seen;
    for (const PaperFigure& figure : table->figures) {
      const std::string key = std::string(figure.condition) + "/" +
                              std::string(figure.metric_kind) + "/" +
                              std::string(figure.metric_name);
      EXPECT_TRUE(seen.insert(key).second) << number << " " << key;
    }
    EXPECT_EQ(seen.size() % 3, 0u) << number;  // three rows
  }
}

}  // namespace
}  // namespace tether::report
