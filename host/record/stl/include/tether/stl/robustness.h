#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tether/base/time.h>

/// The quantitative semantics of STL (Donzé and Maler, "Robust satisfaction of temporal logic over
/// real-valued signals", FORMATS 2010): by how much a trace satisfies (≥ 0) or violates (< 0) a
/// formula, in the unit of its signals.
///
/// Every subformula is a signal on the instants of the trace. An interval [a, b] at instant t means
/// the values in effect at some time in [t + a, t + b] (of the past: [t − b, t − a]), as far as the
/// trace goes. If it lies beyond the trace altogether, kEventually, kUntil, kOnce and kSince give
/// −∞ and kAlways and kHistorically give +∞.
namespace tether::stl {

// ---- Signal temporal logic (STL) with bounded operators of the past and the future (Maler and
// Nickovic, 2004). Pure; independent of records and missions.

/// A quantity as a piecewise-constant function of time: each value holds until the next instant.
struct Signal {
  std::string unit;
  std::vector<double> values;  ///< one for each instant of the trace; none is NaN
};

/// Signals with the same instants. The trace ends with its last instant.
struct Trace {
  std::vector<SimTime> at;  ///< strictly increasing
  std::vector<Signal> signals;
};

/// Bounds of a temporal operator: distances from the instant at which it is evaluated; inclusive.
/// @pre 0 ≤ from ≤ to
struct Interval {
  Duration from{0};
  Duration to = Duration::max();
};

enum class Operator {
  kAtLeast,
  kAtMost,
  kNot,
  kAnd,
  kOr,
  kEventually,
  kAlways,
  kUntil,
  kOnce,
  kHistorically,
  kSince,
};

/// A formula of STL. A value; its parts are copied when it becomes part of another formula.
class Formula {
 public:
  /// A subformula: the operator and, if it has them, its operands as indices of earlier nodes.
  struct Node {
    Operator op;
    std::size_t signal = 0;  ///< of kAtLeast and kAtMost
    double bound = 0.0;      ///< of the same, in the signal's unit
    Interval interval{};     ///< of the temporal operators
    std::size_t left = 0;    ///< or the only operand
    std::size_t right = 0;
  };

  /// `signal`: index in Trace::signals.
  static Formula at_least(std::size_t signal, double bound);
  static Formula at_most(std::size_t signal, double bound);
  static Formula negation(const Formula& operand);
  static Formula both(const Formula& left, const Formula& right);
  static Formula either(const Formula& left, const Formula& right);
  /// At some instant of the interval.
  static Formula eventually(const Interval& interval, const Formula& operand);
  /// At every instant of the interval.
  static Formula always(const Interval& interval, const Formula& operand);
  /// `right` at an instant of the interval, and `left` from now to that instant, inclusive.
  static Formula until(const Formula& left, const Interval& interval, const Formula& right);
  /// The mirror images of the last three: the interval lies before the instant.
  static Formula once(const Interval& interval, const Formula& operand);
  static Formula historically(const Interval& interval, const Formula& operand);
  static Formula since(const Formula& left, const Interval& interval, const Formula& right);

  /// Operands come before their operator; the last node is the formula.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  static Formula unary(Operator op, const Interval& interval, const Formula& operand);
  static Formula binary(Operator op, const Interval& interval, const Formula& left,
                        const Formula& right);

  std::vector<Node> nodes_;
};

/// Evaluates formulas over a trace. Each operator takes time and memory linear in the length of the
/// trace: windows by Lemire's algorithm ("Streaming maximum-minimum filter using no more than three
/// comparisons per element", 2006), kUntil and kSince by the rewriting of Donzé, Ferrère and Maler
/// ("Efficient robust monitoring for STL", CAV 2013). Memory is kept for the next formula. Not
/// thread-safe. @pre the trace outlives it, and has every signal of the formulas.
class Evaluator {
 public:
  explicit Evaluator(const Trace& trace) : trace_(trace) {}

  /// At each instant of the trace.
  std::vector<double> robustness(const Formula& formula);
  /// At the instant of that index only; computes no more than this needs.
  /// @pre instant < trace.at.size()
  double robustness_at(const Formula& formula, std::size_t instant);

 private:
  const Trace& trace_;
  std::vector<std::vector<double>> spare_;
};

/// The unit that all signals of the formula have; empty if there are several, whose robustness is a
/// number without a meaning.
std::string unit_of(const Formula& formula, const Trace& trace);

}  // namespace tether::stl
