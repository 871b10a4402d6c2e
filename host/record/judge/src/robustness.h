#pragma once

#include <vector>

#include <tether/base/time.h>

/// The quantitative semantics of signal temporal logic (Donzé and Maler, "Robust satisfaction of
/// temporal logic over real-valued signals", FORMATS 2010), as far as clauses need it: by how much
/// a condition holds (≥ 0) or does not (< 0), in the unit of its signal. Pure.
namespace tether::judge {

/// Quantities as piecewise-constant functions of time: each value holds until the next instant. The
/// trace ends with its last instant.
struct Trace {
  std::vector<SimTime> at;                   ///< strictly increasing
  std::vector<std::vector<double>> signals;  ///< one value for each instant; none is NaN
};

/// A condition on a signal, with the bound 0.
struct Holds {
  bool at_most = false;   ///< ≤ 0, else ≥ 0
  bool is_never = false;  ///< its opposite
  Duration hold{0};       ///< for so long, the ends included, as far as the trace goes
};

/// At each instant of the trace, in time and memory that are linear in their number. @pre one value
/// for each instant; hold ≥ 0.
std::vector<double> robustness(const Holds& holds, const std::vector<double>& signal,
                               const std::vector<SimTime>& at);

}  // namespace tether::judge
