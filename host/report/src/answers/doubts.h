#pragma once

#include <string>
#include <vector>

#include <tether/report/verdict.h>

/// What limits the evidence of an answer, in sentences that begin with a space.
namespace tether::report {

/// A part of a sentence: "the program of uav1 waited 0.2 s for the disk, …".
std::string doubt_text(const FlightsInDoubt& doubt, const ConditionVerdict& condition);
/// The first of several lines, as far as a sentence can name them.
std::string named(const std::vector<std::string>& lines);
std::string left_out_text(const ConditionVerdict& condition);
/// All of them. Empty: nothing limits it.
std::string doubts_text(const ConditionVerdict& condition);

}  // namespace tether::report
