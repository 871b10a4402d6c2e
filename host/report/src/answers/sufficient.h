#pragma once

#include <string>
#include <vector>

#include <tether/report/verdict.h>

/// What would be fast enough, as far as the campaign's own flights show it. Pure functions.
namespace tether::report {

/// Whether it is fast enough, at least so far.
bool is_sufficient(Ruling ruling);

/// Of a scenario whose lead is not fast enough: the slowest of the conditions that are. Begins with
/// a space; empty: there is none.
std::string sufficient_condition(const Verdict& verdict);

/// Of a sweep over cpu_factor: for each condition and combination of the other values, the largest
/// factor up to which it is fast enough. @pre the points are of one scenario; not empty.
std::vector<Answer> sufficient_factors(const std::vector<Verdict>& points);

/// What to do next to find the threshold, with the command of `tether size` if it can fly this.
std::string faster_advice(const ConditionVerdict& lead);
std::string threshold_advice(const ConditionVerdict& lead);

}  // namespace tether::report
