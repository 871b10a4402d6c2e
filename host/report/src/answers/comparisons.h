#pragma once

#include <string>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/report/report.h>

/// Comparisons and problems in sentences. Pure functions.
namespace tether::report {

/// How the other conditions differ from the first. Two conditions differ significantly in a metric
/// if the rank test gives p < 0.05 and the interval of the difference does not contain zero.
std::vector<std::string> difference_sentences(const campaign::ScenarioResults& scenario);

/// A comparison of `optimism` as a sentence: "Without synchronisation, “target” appears 5.3 s
/// faster than it is (time required; 95 % interval 4.7 to 5.8)." If the interval contains zero, the
/// sentence reports no significant difference.
std::string optimism_sentence(const Comparison& comparison, const campaign::MetricValue& metric);

/// What makes the numbers incomplete or doubtful, one line each: trials that failed, have no result
/// or lack a value; failed audits; causality violations; warnings and notes of trials.
std::vector<std::string> problems(const campaign::CampaignResults& results);

}  // namespace tether::report
