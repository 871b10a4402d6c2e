#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <tether/report/verdict.h>

/// What would be fast enough, as far as the campaign's own flights show it. Pure functions.
namespace tether::report {

/// Before the answer of `tether size` that was interrupted.
inline constexpr const char* kSoFar = "Interrupted, so far: ";

/// Whether it is fast enough, at least so far.
bool is_sufficient(Ruling ruling);

/// What a point of a sweep has beside these keys: " with rate_hz = 10"; empty: nothing. Points with
/// the same beside the keys of the computer's speed are compared as conditions are.
std::string settings_beside(std::initializer_list<std::string_view> keys, const Verdict& point);

/// Of a sweep over cpu_factor: for each condition and combination of the other values, the largest
/// factor up to which it is fast enough. @pre the points are of one scenario; not empty.
std::vector<Answer> sufficient_factors(const std::vector<Verdict>& points);

/// What to do if all flights are one.
inline constexpr const char* kVarySeeds =
    "More flights show nothing new, because the seeds change nothing. Give the sensors noise or "
    "delays that vary (a profile), or let the world or the start vary.";

/// An answer that speed is sufficient, or is not, which rests on something doubtful.
bool is_in_doubt(const ConditionVerdict& condition);

inline constexpr const char* kNotAsWritten = ", but not everything is simulated as written";
inline constexpr const char* kDoubtful = ", but something is doubtful";

/// What the first words of an answer must say of the flights that reached the goal, on which it
/// rests: kNotAsWritten or kDoubtful; empty: nothing. Of others, it can be why they missed it.
std::string reservation_on(std::span<const campaign::TrialResult* const> trials);
std::vector<const campaign::TrialResult*> pointers_to(
    const std::vector<campaign::TrialResult>& trials);

}  // namespace tether::report
