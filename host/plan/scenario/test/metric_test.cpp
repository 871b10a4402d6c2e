#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <tether/scenario/metric.h>

namespace tether::scenario {
namespace {

TEST(MetricKinds, HaveDistinctNamesAndLabelsAndAllTheirTexts) {
  std::set<std::string_view> names, labels;
  for (const MetricKind& kind : metric_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_TRUE(labels.insert(kind.label).second) << kind.label;
    EXPECT_FALSE(kind.label.empty() || kind.unit.empty()) << kind.name;
  }
  EXPECT_FALSE(names.empty());
  EXPECT_EQ(unit_suffix("1") + unit_suffix("deg"), "_deg");
}

// Beside a clause that leaves the landing out, the label has to say why its value is 0.
TEST(MetricKinds, SayThatTheClearanceIncludesTheFloor) {
  EXPECT_EQ(find_metric_kind("min_clearance_m")->label, "Least clearance, floor included");
}

// Each kind has one entry there, "`name` [unit]", and nothing else does.
TEST(MetricKinds, AreThoseOfTheGuide) {
  std::ifstream file(TETHER_SOURCE_DIR "/docs/guide/scenario.md");
  const std::string guide(std::istreambuf_iterator<char>(file), {});
  const std::size_t begin = guide.find("The kinds:\n"),
                    end = guide.find("\n\nOther distances", begin);
  ASSERT_LT(begin, end);
  const std::string list = guide.substr(begin, end - begin);
  std::multiset<std::string> told, known;
  const std::regex entry("(^- |; )`(\\w+)`( \\[(\\w+)\\])?:",
                         std::regex::ECMAScript | std::regex::multiline);
  for (std::sregex_iterator at(list.begin(), list.end(), entry), none; at != none; ++at)
    told.insert((*at)[2].str() + ((*at)[4].matched ? unit_suffix((*at)[4].str()) : ""));
  for (const MetricKind& kind : metric_kinds())
    known.insert(std::string(kind.name) + unit_suffix(kind.unit));
  EXPECT_EQ(told, known);
}

}  // namespace
}  // namespace tether::scenario
