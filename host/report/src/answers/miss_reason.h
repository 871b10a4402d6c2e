#pragma once

#include <span>
#include <string>

#include <tether/campaign/campaign_results.h>
#include <tether/report/verdict.h>

namespace tether::report {

struct ToExplain {
  ConditionVerdict* verdict;  ///< with its ruling
  const campaign::ConditionResults* results;
  std::string label;  ///< of the condition, for the others
};

/// Whether its flights say anything of a computer.
bool is_evidence(const ConditionVerdict& one);

/// The ruling's name, or that on the only flight; without what is doubtful.
std::string name_of_flown(const ConditionVerdict& condition);

/// The probability that flights which reach the goal equally often differ as much: Fisher's exact
/// test. If the seeds change nothing, chance has no part.
double chance_of(const ConditionVerdict& a, const ConditionVerdict& b);

/// Finds why each condition with the ruling kGoalMissed misses its goal, and rules by it. Whatever
/// is not known to be the same counts as different.
/// @param comparisons how many pairs of conditions and points of the scenario can be compared, here
///   and in other calls. @pre the conditions are of one scenario, and differ in what a condition
///   can change only.
void explain_misses(std::span<const ToExplain> conditions, std::size_t comparisons);

}  // namespace tether::report
