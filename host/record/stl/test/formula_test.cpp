#include <gmock/gmock.h>

#include <tether/stl/robustness.h>

namespace tether::stl {
namespace {

TEST(Formula, KeepsOperandsBeforeTheirOperator) {
  const Formula a = Formula::at_least(0, 1.0);
  const Formula b = Formula::always({}, Formula::at_most(1, 2.0));
  const Formula either = Formula::either(Formula::negation(a), b);
  ASSERT_EQ(either.nodes().size(), 5u);
  const Formula::Node& root = either.nodes().back();
  EXPECT_EQ(root.op, Operator::kOr);
  EXPECT_EQ(either.nodes()[root.left].op, Operator::kNot);
  EXPECT_EQ(either.nodes()[root.right].op, Operator::kAlways);
  EXPECT_EQ(either.nodes()[either.nodes()[root.right].left].bound, 2.0);
}

}  // namespace
}  // namespace tether::stl
