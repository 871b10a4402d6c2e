#pragma once

#include <span>
#include <string>
#include <vector>

#include <tether/campaign/result.h>
#include <tether/record/reader.h>

/// Flights of several seeds that are one flight, because their seeds change nothing. Only distinct
/// flights are evidence of how often a goal is reached. Pure functions.
namespace tether::campaign {

/// Digest of the true states of all UAVs at each sample of the ground truth (FNV-1a, 64 bits, 16
/// hexadecimal digits): two runs have the same if every UAV moved in the same way, to the last bit.
/// Empty without a ground truth.
std::string flight_digest(const record::Record& record);

/// Whether both are one flight, flown twice: the same true states, outcome, metrics and clauses.
/// Results of earlier versions have no digest, and are never copies.
bool are_copies(const TrialResult& a, const TrialResult& b);

/// Those that have a result, each flight once, in their order. The trials must outlive it.
std::vector<const TrialResult*> distinct_flights(std::span<const TrialResult> trials);

}  // namespace tether::campaign
