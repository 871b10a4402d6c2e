#pragma once

#include <tether/campaign/campaign_results.h>
#include <tether/report/verdict.h>

namespace tether::report {

/// Replaces "not fast enough" where the conditions of the scenario show that speed is not the
/// reason. They do so only if their computing times are known. @pre the rulings of all conditions,
/// which are in the order of the scenario's.
void find_other_reasons(std::vector<ConditionVerdict>& conditions,
                        const campaign::ScenarioResults& scenario);

}  // namespace tether::report
