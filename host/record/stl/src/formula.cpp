#include <cassert>

#include <tether/stl/robustness.h>

namespace tether::stl {

Formula Formula::unary(Operator op, const Interval& interval, const Formula& operand) {
  assert(Duration(0) <= interval.from && interval.from <= interval.to);
  Formula formula = operand;
  formula.nodes_.push_back({.op = op, .interval = interval, .left = formula.nodes_.size() - 1});
  return formula;
}

Formula Formula::binary(Operator op, const Interval& interval, const Formula& left,
                        const Formula& right) {
  assert(Duration(0) <= interval.from && interval.from <= interval.to);
  Formula formula = left;
  const std::size_t shift = formula.nodes_.size();
  for (Node node : right.nodes_) {
    node.left += shift;
    node.right += shift;
    formula.nodes_.push_back(node);
  }
  formula.nodes_.push_back(
      {.op = op, .interval = interval, .left = shift - 1, .right = formula.nodes_.size() - 1});
  return formula;
}

Formula Formula::at_least(std::size_t signal, double bound) {
  Formula formula;
  formula.nodes_ = {{.op = Operator::kAtLeast, .signal = signal, .bound = bound}};
  return formula;
}
Formula Formula::at_most(std::size_t signal, double bound) {
  Formula formula;
  formula.nodes_ = {{.op = Operator::kAtMost, .signal = signal, .bound = bound}};
  return formula;
}
Formula Formula::negation(const Formula& operand) {
  return unary(Operator::kNot, {}, operand);
}
Formula Formula::both(const Formula& left, const Formula& right) {
  return binary(Operator::kAnd, {}, left, right);
}
Formula Formula::either(const Formula& left, const Formula& right) {
  return binary(Operator::kOr, {}, left, right);
}
Formula Formula::eventually(const Interval& interval, const Formula& operand) {
  return unary(Operator::kEventually, interval, operand);
}
Formula Formula::always(const Interval& interval, const Formula& operand) {
  return unary(Operator::kAlways, interval, operand);
}
Formula Formula::until(const Formula& left, const Interval& interval, const Formula& right) {
  return binary(Operator::kUntil, interval, left, right);
}
Formula Formula::once(const Interval& interval, const Formula& operand) {
  return unary(Operator::kOnce, interval, operand);
}
Formula Formula::historically(const Interval& interval, const Formula& operand) {
  return unary(Operator::kHistorically, interval, operand);
}
Formula Formula::since(const Formula& left, const Interval& interval, const Formula& right) {
  return binary(Operator::kSince, interval, left, right);
}

}  // namespace tether::stl
