#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/stl/robustness.h>

namespace tether::stl {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using Node = Formula::Node;
using Doubles = std::vector<double>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SimTime second(std::int64_t s) {
  return SimTime(std::chrono::seconds(s));
}

Interval seconds(std::int64_t from, std::int64_t to) {
  return {std::chrono::seconds(from), std::chrono::seconds(to)};
}

Trace every_second(std::vector<Doubles> signals) {
  Trace trace;
  for (std::size_t i = 0; i < signals.front().size(); ++i)
    trace.at.push_back(second(static_cast<std::int64_t>(i)));
  for (Doubles& values : signals) trace.signals.push_back({"m", std::move(values)});
  return trace;
}

// The definitions of Donzé and Maler (2010), instant by instant.
class Naive {
 public:
  Naive(const Formula& formula, const Trace& trace) : nodes_(formula.nodes()), trace_(trace) {}

  double at(std::size_t i) const { return value(nodes_.back(), i); }

 private:
  double value(const Node& node, std::size_t i) const {
    const auto left = [&](std::size_t j) { return value(nodes_[node.left], j); };
    const auto right = [&](std::size_t j) { return value(nodes_[node.right], j); };
    switch (node.op) {
      case Operator::kAtLeast:
        return trace_.signals[node.signal].values[i] - node.bound;
      case Operator::kAtMost:
        return node.bound - trace_.signals[node.signal].values[i];
      case Operator::kNot:
        return -left(i);
      case Operator::kAnd:
        return std::min(left(i), right(i));
      case Operator::kOr:
        return std::max(left(i), right(i));
      case Operator::kEventually:
      case Operator::kOnce:
        return most(node, i, left);
      case Operator::kAlways:
      case Operator::kHistorically:
        return -most(node, i, [&](std::size_t j) { return -left(j); });
      case Operator::kUntil:
      case Operator::kSince:
        return most(node, i, [&](std::size_t j) {
          double least = right(j);
          for (std::size_t k = std::min(i, j); k <= std::max(i, j); ++k)
            least = std::min(least, left(k));
          return least;
        });
    }
    return 0.0;
  }

  template <class Value>
  double most(const Node& node, std::size_t i, const Value& value) const {
    const bool is_past = node.op == Operator::kOnce || node.op == Operator::kHistorically ||
                         node.op == Operator::kSince;
    const auto& at = trace_.at;
    const Duration to = std::min(node.interval.to, Duration(std::chrono::hours(1)));
    const SimTime begin = is_past ? at[i] - to : at[i] + node.interval.from;
    const SimTime end = is_past ? at[i] - node.interval.from : at[i] + to;
    double most = -kInfinity;
    for (std::size_t j = 0; j < at.size(); ++j) {
      // Value j is in effect in [at[j], at[j + 1]); the trace ends with its last instant.
      const bool has_begun = at[j] <= end;
      const bool is_in_effect = j + 1 < at.size() ? at[j + 1] > begin : at[j] >= begin;
      if (has_begun && is_in_effect) most = std::max(most, value(j));
    }
    return most;
  }

  const std::vector<Node>& nodes_;
  const Trace& trace_;
};

class Drawn {
 public:
  explicit Drawn(std::uint64_t index) : random_({.seed = 21, .stream = 1, .index = index}) {}

  std::size_t below(std::size_t n) { return random_.bits() % n; }

  Trace trace() {
    Trace trace;
    SimTime at(std::chrono::milliseconds(below(50)));
    trace.signals = {{"m", {}}, {"m", {}}};
    for (std::size_t i = 1 + below(24); i > 0; --i) {
      trace.at.push_back(at);
      at += std::chrono::milliseconds(below(2) ? 10 : 1 + below(30));
      for (Signal& signal : trace.signals)
        signal.values.push_back(static_cast<double>(below(9)) - 4.0);
    }
    return trace;
  }

  Interval interval() {
    const Duration from = std::chrono::milliseconds(below(3) * below(40));
    return {from, below(5) ? from + std::chrono::milliseconds(below(80)) : Duration::max()};
  }

  Formula formula(int depth) {
    const std::size_t signal = below(2);
    const double bound = static_cast<double>(below(5)) - 2.0;
    if (depth == 0)
      return below(2) ? Formula::at_least(signal, bound) : Formula::at_most(signal, bound);
    const Formula a = formula(depth - 1);
    switch (below(9)) {
      case 0:
        return Formula::negation(a);
      case 1:
        return Formula::both(a, formula(depth - 1));
      case 2:
        return Formula::either(a, formula(depth - 1));
      case 3:
        return Formula::eventually(interval(), a);
      case 4:
        return Formula::always(interval(), a);
      case 5:
        return Formula::until(a, interval(), formula(depth - 1));
      case 6:
        return Formula::once(interval(), a);
      case 7:
        return Formula::historically(interval(), a);
      default:
        return Formula::since(a, interval(), formula(depth - 1));
    }
  }

 private:
  KeyedRandom random_;
};

TEST(Robustness, EqualsTheDefinitionOnRandomSignalsAndFormulas) {
  for (std::uint64_t index = 0; index < 10'000; ++index) {
    Drawn drawn(index);
    const Trace trace = drawn.trace();
    const Formula formula = drawn.formula(1 + static_cast<int>(drawn.below(3)));
    const Naive naive(formula, trace);
    Doubles expected;
    for (std::size_t i = 0; i < trace.at.size(); ++i) expected.push_back(naive.at(i));
    ASSERT_THAT(Evaluator(trace).robustness(formula), ElementsAreArray(expected))
        << "draw " << index;
    const std::size_t one = drawn.below(trace.at.size());
    ASSERT_EQ(Evaluator(trace).robustness_at(formula, one), expected[one]) << "draw " << index;
  }
}

// The values that RTAMT's tests publish for its discrete-time monitor (Nickovic and Yamaguchi,
// ATVA 2020), on its signal.
TEST(Robustness, EqualsPublishedExamples) {
  const Trace trace = every_second({{100, -1, -2, 5, -1}, {20, -2, 10, 4, -1}});
  const Formula a = Formula::at_least(0, 0.0), b = Formula::at_least(1, 0.0);
  const auto of = [&](const Formula& formula) { return Evaluator(trace).robustness(formula); };
  EXPECT_THAT(of(Formula::negation(a)), ElementsAre(-100, 1, 2, -5, 1));
  EXPECT_THAT(of(Formula::both(a, b)), ElementsAre(20, -2, -2, 4, -1));
  EXPECT_THAT(of(Formula::either(a, b)), ElementsAre(100, -1, 10, 5, -1));
  EXPECT_THAT(of(Formula::either(Formula::negation(a), b)), ElementsAre(20, 1, 10, 4, 1));
  EXPECT_THAT(of(Formula::always({}, a)), ElementsAre(-2, -2, -2, -1, -1));
  EXPECT_THAT(of(Formula::always(seconds(0, 1), a)), ElementsAre(-1, -2, -2, -1, -1));
  EXPECT_THAT(of(Formula::eventually({}, a)), ElementsAre(100, 5, 5, 5, -1));
  EXPECT_THAT(of(Formula::eventually(seconds(0, 1), a)), ElementsAre(100, -1, 5, 5, -1));
  EXPECT_THAT(of(Formula::historically({}, a)), ElementsAre(100, -1, -2, -2, -2));
  EXPECT_THAT(of(Formula::historically(seconds(0, 1), a)), ElementsAre(100, -1, -2, -2, -1));
  EXPECT_THAT(of(Formula::historically(seconds(1, 2), a)), ElementsAre(kInfinity, 100, -1, -2, -2));
  EXPECT_THAT(of(Formula::once({}, a)), ElementsAre(100, 100, 100, 100, 100));
  EXPECT_THAT(of(Formula::once(seconds(0, 1), a)), ElementsAre(100, 100, -1, 5, 5));
  EXPECT_THAT(of(Formula::once(seconds(1, 2), a)), ElementsAre(-kInfinity, 100, 100, -1, 5));
}

TEST(Robustness, OfAnEmptyTraceIsEmpty) {
  const Trace trace{{}, {{"m", {}}}};
  EXPECT_THAT(Evaluator(trace).robustness(Formula::at_least(0, 0.0)), ElementsAre());
}

TEST(Robustness, HasTheUnitThatAllItsSignalsHave) {
  const Trace trace{{second(0)}, {{"m", {0}}, {"s", {0}}}};
  const Formula metres = Formula::at_least(0, 1.0);
  EXPECT_EQ(unit_of(Formula::always({}, metres), trace), "m");
  EXPECT_EQ(unit_of(Formula::both(metres, Formula::at_most(1, 1.0)), trace), "");
}

}  // namespace
}  // namespace tether::stl
