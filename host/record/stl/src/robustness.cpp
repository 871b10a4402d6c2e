#include "sliding_extremum.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include <tether/stl/robustness.h>

// A subformula is computed at the instants that its operator needs, and no others. `Values` has the
// index of its first instant, because operands reach further than their operators.
namespace tether::stl {
namespace {

using Node = Formula::Node;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Robustness at the instants first, first + 1, …
struct Values {
  std::size_t first = 0;
  std::vector<double> of;
};

bool is_past(const Node& node) {
  return node.op == Operator::kOnce || node.op == Operator::kHistorically ||
         node.op == Operator::kSince;
}

/// The instants whose values are in effect in the interval of an operator, one window after the
/// other.
class Windows {
 public:
  /// For the instants from `first` on.
  Windows(const Node& node, const std::vector<SimTime>& at, std::size_t first)
      : at_(at), first_(first) {
    // What is longer than the trace reaches just beyond it.
    const Duration most = at.back() - at.front() + Duration(1);
    const Duration from = std::min(node.interval.from, most);
    const Duration to = std::min(node.interval.to, most);
    begin_after_ = is_past(node) ? -to : from;
    end_after_ = is_past(node) ? -from : to;
  }

  /// Of instant first + i. Call with i = 0, 1, ….
  Window operator()(std::size_t i) {
    const SimTime begin = at_[first_ + i] + begin_after_, end = at_[first_ + i] + end_after_;
    if (end < at_.front() || begin > at_.back()) return {};
    advance(window_.first, begin);
    advance(window_.last, end);
    return window_;
  }

  /// All windows up to that of the instant `last` together; the instant `first` alone if all are
  /// empty.
  Window hull(std::size_t last) const {
    const SimTime begin = at_[first_] + begin_after_, end = at_[last] + end_after_;
    if (end < at_.front() || begin > at_.back()) return {first_, first_};
    return {in_effect(begin), in_effect(end)};
  }

 private:
  /// The last instant that is not after `time`, or else the first.
  std::size_t in_effect(SimTime time) const {
    const auto after = std::upper_bound(at_.begin(), at_.end(), time);
    return after == at_.begin() ? 0 : static_cast<std::size_t>(after - at_.begin() - 1);
  }
  void advance(std::size_t& index, SimTime time) const {
    while (index + 1 < at_.size() && at_[index + 1] <= time) ++index;
  }

  const std::vector<SimTime>& at_;
  std::size_t first_;
  Duration begin_after_{}, end_after_{};
  Window window_{0, 0};
};

class Evaluation {
 public:
  Evaluation(const Formula& formula, const Trace& trace, std::vector<std::vector<double>>& spare)
      : nodes_(formula.nodes()), trace_(trace), spare_(spare) {}

  /// The formula at the instants first … last.
  std::vector<double> at(std::size_t first, std::size_t last) {
    return evaluate(nodes_.back(), first, last).of;
  }
  void give_back(std::vector<double> values) { spare_.push_back(std::move(values)); }

 private:
  Values evaluate(const Node& node, std::size_t first, std::size_t last) {
    switch (node.op) {
      case Operator::kAtLeast:
      case Operator::kAtMost:
        return predicate(node, first, last);
      case Operator::kNot:
        return negation(node, first, last);
      case Operator::kAnd:
      case Operator::kOr:
        return combination(node, first, last);
      case Operator::kEventually:
      case Operator::kOnce:
        return windowed(node, first, last, Extremum::kMax);
      case Operator::kAlways:
      case Operator::kHistorically:
        return windowed(node, first, last, Extremum::kMin);
      case Operator::kUntil:
        return until(node, first, last);
      case Operator::kSince:
        return since(node, first, last);
    }
    return {};
  }

  Values predicate(const Node& node, std::size_t first, std::size_t last) {
    const std::vector<double>& signal = trace_.signals[node.signal].values;
    const double sign = node.op == Operator::kAtLeast ? 1.0 : -1.0;
    Values values = make(first, last);
    for (std::size_t i = first; i <= last; ++i)
      values.of[i - first] = sign * (signal[i] - node.bound);
    return values;
  }

  Values negation(const Node& node, std::size_t first, std::size_t last) {
    Values values = evaluate(nodes_[node.left], first, last);
    for (double& value : values.of) value = -value;
    return values;
  }

  Values combination(const Node& node, std::size_t first, std::size_t last) {
    Values values = evaluate(nodes_[node.left], first, last);
    Values right = evaluate(nodes_[node.right], first, last);
    const bool is_and = node.op == Operator::kAnd;
    for (std::size_t i = 0; i < values.of.size(); ++i)
      values.of[i] =
          is_and ? std::min(values.of[i], right.of[i]) : std::max(values.of[i], right.of[i]);
    give_back(std::move(right.of));
    return values;
  }

  Values windowed(const Node& node, std::size_t first, std::size_t last, Extremum extremum) {
    Windows windows(node, trace_.at, first);
    const Window all = windows.hull(last);
    Values operand = evaluate(nodes_[node.left], all.first, all.last);
    Values values = make(first, last);
    slide(extremum, operand.of, operand.first, windows, values.of);
    give_back(std::move(operand.of));
    return values;
  }

  // φ U[a,b] ψ = ◇[a,b] ψ ∧ □[0,a] (φ U ψ), where φ U ψ may look as far as the last window does.
  Values until(const Node& node, std::size_t first, std::size_t last) {
    const std::size_t end = std::max(last, Windows(node, trace_.at, first).hull(last).last);
    Values left = evaluate(nodes_[node.left], first, end);
    Values right = evaluate(nodes_[node.right], first, end);
    double later = -kInfinity;  // `left` becomes φ U ψ
    for (std::size_t i = left.of.size(); i-- > 0;)
      left.of[i] = later = std::min(left.of[i], std::max(right.of[i], later));
    return meet(node, first, last, std::move(left), std::move(right));
  }

  // The mirror image.
  Values since(const Node& node, std::size_t first, std::size_t last) {
    const std::size_t begin = std::min(first, Windows(node, trace_.at, first).hull(last).first);
    Values left = evaluate(nodes_[node.left], begin, last);
    Values right = evaluate(nodes_[node.right], begin, last);
    double earlier = -kInfinity;  // `left` becomes φ S ψ
    for (std::size_t i = 0; i < left.of.size(); ++i)
      left.of[i] = earlier = std::min(left.of[i], std::max(right.of[i], earlier));
    return meet(node, first, last, std::move(left), std::move(right));
  }

  /// `right` somewhere in the window, and `unbounded` everywhere from the instant to the window.
  Values meet(const Node& node, std::size_t first, std::size_t last, Values unbounded,
              Values right) {
    Values values = make(first, last), between = make(first, last);
    slide(Extremum::kMax, right.of, right.first, Windows(node, trace_.at, first), values.of);
    Windows windows(node, trace_.at, first);
    const auto gap = [&](std::size_t i) {
      const Window window = windows(i);
      if (window.is_empty()) return window;
      return is_past(node) ? Window{window.last, first + i} : Window{first + i, window.first};
    };
    slide(Extremum::kMin, unbounded.of, unbounded.first, gap, between.of);
    for (std::size_t i = 0; i < values.of.size(); ++i)
      values.of[i] = std::min(values.of[i], between.of[i]);
    for (Values* used : {&unbounded, &right, &between}) give_back(std::move(used->of));
    return values;
  }

  Values make(std::size_t first, std::size_t last) {
    Values values{first, {}};
    if (!spare_.empty()) {
      values.of = std::move(spare_.back());
      spare_.pop_back();
    }
    values.of.resize(last - first + 1);
    return values;
  }

  const std::vector<Node>& nodes_;
  const Trace& trace_;
  std::vector<std::vector<double>>& spare_;
};

}  // namespace

std::vector<double> Evaluator::robustness(const Formula& formula) {
  if (trace_.at.empty()) return {};
  return Evaluation(formula, trace_, spare_).at(0, trace_.at.size() - 1);
}

double Evaluator::robustness_at(const Formula& formula, std::size_t instant) {
  assert(instant < trace_.at.size());
  Evaluation evaluation(formula, trace_, spare_);
  std::vector<double> values = evaluation.at(instant, instant);
  const double value = values.front();
  evaluation.give_back(std::move(values));
  return value;
}

std::string unit_of(const Formula& formula, const Trace& trace) {
  const std::string* unit = nullptr;
  for (const Node& node : formula.nodes()) {
    if (node.op != Operator::kAtLeast && node.op != Operator::kAtMost) continue;
    const std::string& own = trace.signals[node.signal].unit;
    if (unit && *unit != own) return "";
    unit = &own;
  }
  return unit ? *unit : "";
}

}  // namespace tether::stl
