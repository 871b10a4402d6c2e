#include "files/sdf_rules.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

struct Case {
  const char* parent;
  const char* child;
  double value;
  bool holds;
};

constexpr Case kCases[] = {
    {"inertial", "mass", 1e-6, true},
    {"inertial", "mass", 0.0, false},
    {"noise", "stddev", 0.0, true},
    {"noise", "stddev", -1e-9, false},
    {"material", "diffuse", 1.0, true},
    {"material", "diffuse", 1.01, false},
    {"camera", "horizontal_fov", 3.14, true},
    {"camera", "horizontal_fov", 3.1401, false},
    {"camera", "horizontal_fov", 0.005, true},
    {"camera", "horizontal_fov", 0.0049, false},
    {"image", "width", 4096.0, true},
    {"image", "width", 4097.0, false},
    {"image", "height", 0.0, false},
    {"inertial", "mass", 1e6, true},
    {"inertial", "mass", 1.001e6, false},
    {"box", "size", 1e5, true},
    {"box", "size", 1.001e5, false},
    {"range", "min", 0.0, true},
    {"ode", "mu", -1e-9, false},
    {"sensor", "update_rate", -1.0, false},
    {"link", "pose", -1e5, true},
    {"link", "pose", -1.001e5, false},
    {"box", "size", std::numeric_limits<double>::quiet_NaN(), false},
};

TEST(SdfRules, SayWhichValuesAreAllowed) {
  for (const Case& given : kCases) {
    const ValueRule* rule = find_rule(given.parent, given.child);
    ASSERT_NE(rule, nullptr) << given.parent << "/" << given.child;
    EXPECT_EQ(rule->holds(given.value), given.holds) << given.child << " " << given.value;
    EXPECT_TRUE(std::string(rule->allowed).starts_with("it must"));
  }
}

TEST(SdfRules, BoundThePositionOfAPoseAndNothingUnknown) {
  EXPECT_EQ(find_rule("link", "pose")->count, 3u);
  EXPECT_EQ(find_rule("plane", "normal"), nullptr);
  EXPECT_EQ(find_rule("attenuation", "mass"), nullptr);
}

}  // namespace
}  // namespace tether::sim
