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

/// Finds why each condition with the ruling kGoalMissed misses its goal, and rules by it. Whatever
/// is not known to be the same counts as different. @pre the conditions are of one scenario, and
/// differ in what a condition can change only.
void explain_misses(std::span<const ToExplain> conditions);

}  // namespace tether::report
