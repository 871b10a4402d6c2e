#include <set>

#include <gtest/gtest.h>

#include <tether/scenario/metric.h>

namespace tether::scenario {
namespace {

TEST(MetricKinds, HaveDistinctNamesAndAllTheirTexts) {
  std::set<std::string_view> names;
  for (const MetricKind& kind : metric_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_FALSE(kind.label.empty());
    EXPECT_FALSE(kind.unit.empty());
    EXPECT_FALSE(kind.help.empty());
    EXPECT_EQ(find_metric_kind(kind.name), &kind);
  }
  EXPECT_EQ(find_metric_kind("none"), nullptr);
}

TEST(UnitSuffix, IsEmptyForCounts) {
  EXPECT_EQ(unit_suffix("1"), "");
  EXPECT_EQ(unit_suffix("deg"), "_deg");
}

}  // namespace
}  // namespace tether::scenario
