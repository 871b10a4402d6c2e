#pragma once

#include <string>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/report/report.h>

/// What results mean, in sentences. Pure functions.
namespace tether::report {

/// One paragraph: who reached the goal how often, and in what the other conditions differ from the
/// first. Two conditions differ in a metric where the rank test says p < 0.05 and the interval of
/// the difference does not hold zero.
std::string verdict(const campaign::ScenarioResults& scenario);

/// One of `optimism`'s comparisons as a sentence: "Without synchronisation the target looks 5.3 s
/// faster than it is (time required; 95 % interval 4.7 to 5.8)." Where the interval holds zero, it
/// says that there is nothing to be told.
std::string optimism_sentence(const Comparison& comparison, const campaign::MetricValue& metric);

/// Whatever keeps the numbers from being whole or sound, each named: trials that failed, have no
/// result, or lack a value; failed audits; causality violations.
std::vector<std::string> problems(const campaign::CampaignResults& results);

}  // namespace tether::report
