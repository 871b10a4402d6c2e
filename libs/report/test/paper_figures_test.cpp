#include <set>
#include <string>

#include <gtest/gtest.h>

#include <tether/report/paper_figures.h>

namespace tether::report {
namespace {

TEST(PaperFigures, AreFoundByTableConditionAndKind) {
  const PaperTable* table = find_paper_table("III");
  ASSERT_NE(table, nullptr);
  EXPECT_EQ(table->find("target", "time_required")->mean, 9.242);
  EXPECT_EQ(table->find("target", "time_required")->stddev, 13.767);
  EXPECT_EQ(table->find("target, no sync", "oscillations")->mean, 0.0);
  EXPECT_EQ(table->find("target", "position_error"), nullptr);
  EXPECT_EQ(find_paper_table("VI"), nullptr);
  EXPECT_FALSE(find_paper_table("II")->find("host", "bearing_error")->stddev);
}

TEST(PaperFigures, AreThereOnceEach) {
  for (const std::string_view number : {"II", "III", "IV", "V"}) {
    const PaperTable* table = find_paper_table(number);
    ASSERT_NE(table, nullptr) << number;
    std::set<std::string> seen;
    for (const PaperFigure& figure : table->figures) {
      const std::string key = std::string(figure.condition) + "/" + std::string(figure.metric_kind);
      EXPECT_TRUE(seen.insert(key).second) << number << " " << key;
    }
    EXPECT_EQ(seen.size() % 3, 0u) << number;  // three rows
  }
}

}  // namespace
}  // namespace tether::report
