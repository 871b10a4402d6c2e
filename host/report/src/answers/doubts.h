#pragma once

#include <string>

#include <tether/report/verdict.h>

/// What limits the evidence of an answer, in sentences that begin with a space.
namespace tether::report {

/// A part of a sentence: "the program of uav1 waited 0.2 s for the disk, …".
std::string doubt_text(const FlightsInDoubt& doubt, const ConditionVerdict& condition);
std::string left_out_text(const ConditionVerdict& condition);
std::string doubtful_text(const ConditionVerdict& condition);
/// All of them. Empty: nothing limits it.
std::string doubts_text(const ConditionVerdict& condition);

}  // namespace tether::report
