#include <gtest/gtest.h>

#include <tether/report/table.h>

namespace tether::report {
namespace {

Table small_table() {
  Table table;
  table.title = "Table 1";
  table.headings = {{{"", 1}, {"Time (s)", 2}}, {{"Where", 1}, {"mean", 1}, {"sd", 1}}};
  table.rows = {{"host", "2.48", "0.03"}, {"target, no sync", "10.5", "–"}};
  table.notes = {"A note."};
  return table;
}

TEST(ToText, MakesRoomForAWideHeading) {
  Table table;
  table.headings = {{{"", 1}, {"a wide heading", 2}}, {{"x", 1}, {"a", 1}, {"b", 1}}};
  table.rows = {{"r", "1", "2"}};
  EXPECT_EQ(to_text(table),
            "   a wide heading\n"
            "x  a            b\n"
            "─────────────────\n"
            "r  1            2\n");
}

TEST(ToMarkdown, JoinsHeadingsAndEscapes) {
  EXPECT_EQ(to_markdown(small_table()),
            "### Table 1\n"
            "\n"
            "| Where | Time (s), mean | Time (s), sd |\n"
            "|:---|---:|---:|\n"
            "| host | 2.48 | 0.03 |\n"
            "| target, no sync | 10.5 | – |\n"
            "\n"
            "A note.\n");
  Table special;
  special.headings = {{{"a|b", 1}}};
  special.rows = {{"x\ny|z"}};
  EXPECT_EQ(to_markdown(special), "| a\\|b |\n|:---|\n| x y\\|z |\n");
}

TEST(ToCsv, QuotesSpecialCharacters) {
  Table table;
  table.headings = {{{"condition", 1}, {"reason", 1}}};
  table.rows = {{"target, no sync", "it said \"no\""}, {"host", "2.48"}};
  EXPECT_EQ(to_csv(table),
            "condition,reason\r\n"
            "\"target, no sync\",\"it said \"\"no\"\"\"\r\n"
            "host,2.48\r\n");
  EXPECT_EQ(to_csv(Table{}), "\r\n");
  EXPECT_EQ(to_text(Table{}), "");
}

}  // namespace
}  // namespace tether::report
