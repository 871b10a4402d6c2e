#pragma once

#include <string>

#include <tether/campaign/result.h>

namespace tether::report {

/// A drawing (inline SVG) of the mission of one UAV over ST: a bar for each task; below, a lane for
/// each clause with its time, its deadline, when it was decided, and its margin. Empty if the trial
/// has no clauses for that UAV.
std::string mission_timeline(const campaign::TrialResult& trial, const std::string& uav);

}  // namespace tether::report
