#include <set>

#include <gtest/gtest.h>

#include <tether/scenario/metric.h>

namespace tether::scenario {
namespace {

TEST(MetricKinds, HaveDistinctNamesAndLabelsAndAllTheirTexts) {
  std::set<std::string_view> names, labels;
  for (const MetricKind& kind : metric_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_TRUE(labels.insert(kind.label).second) << kind.label;
    EXPECT_FALSE(kind.label.empty() || kind.unit.empty() || kind.help.empty()) << kind.name;
  }
  EXPECT_FALSE(names.empty());
  EXPECT_EQ(unit_suffix("1") + unit_suffix("deg"), "_deg");
}

// Beside a clause that leaves the landing out, the label has to say why its value is 0.
TEST(MetricKinds, SayThatTheClearanceIncludesTheFloor) {
  EXPECT_EQ(find_metric_kind("min_clearance_m")->label, "Least clearance, floor included");
}

}  // namespace
}  // namespace tether::scenario
