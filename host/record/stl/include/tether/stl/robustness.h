#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tether/stl/formula.h>

/// The quantitative semantics of STL (Donzé and Maler, "Robust satisfaction of temporal logic over
/// real-valued signals", FORMATS 2010): by how much a trace satisfies (≥ 0) or violates (< 0) a
/// formula, in the unit of its signals.
///
/// Every subformula is a signal on the instants of the trace. An interval [a, b] at instant t means
/// the values in effect at some time in [t + a, t + b] (of the past: [t − b, t − a]), as far as the
/// trace goes. If it lies beyond the trace altogether, kEventually, kUntil, kOnce and kSince give
/// −∞ and kAlways and kHistorically give +∞.
namespace tether::stl {

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
