#pragma once

#include "answers/miss_reason.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

// What the conditions of one scenario differ in, and which of two computes faster.
namespace tether::report {

inline constexpr double kSameCost = 1.1;  ///< of an image, from flight to flight

struct Compared {
  ConditionVerdict* verdict;
  std::vector<const campaign::TrialResult*> flights;  ///< distinct; not empty
  std::string label;

  const std::optional<Pace>& pace() const { return verdict->pace; }
};

struct Costs {
  std::string what;  ///< "an image costs"
  double own_s = 0.0, other_s = 0.0;
};

bool is_of_other_architecture(const Speed::Program& one, const Speed::Program& other);
/// What two conditions differ in besides speed, as a part of a sentence on one of them; empty:
/// nothing. @pre The pace of both is known.
std::string difference_of(const Compared& one, const Compared& other);
bool differ_in_speed_only(const Compared& a, const Compared& b);
/// Whether times of one are measured and those of the other set by the scenario: what a program
/// does on purpose for some time takes none of these.
bool has_times_of_another_kind(const Compared& a, const Compared& b);
/// What an image costs under both or, without a camera, the largest stage of the first that the
/// other has, too.
std::optional<Costs> costs_of(const Pace& one, const Pace& other);
/// How many times slower `one` computes than `other`; none: not known.
std::optional<double> slowdown_of(const Compared& one, const Compared& other);
bool is_faster(const Compared& other, const Compared& missed);
/// Whether a slower computer than this one, too, would have missed the goal for another reason.
/// @pre is_faster
bool is_much_faster(const Compared& other, const Compared& missed);
bool is_instant(const Compared& one);
/// Whether chance does not explain that `a` reaches the goal more often, with Bonferroni's
/// correction for that many comparisons.
bool reaches_more_often(const ConditionVerdict& a, const ConditionVerdict& b,
                        std::size_t comparisons);
/// The first limit that `missed` does not meet and the other one always does; empty: there is none.
std::string met_by(const ConditionVerdict& other, const ConditionVerdict& missed);
/// A limit that both miss, but each flight of the faster one by clearly less than each of the other
/// one; empty: there is none.
std::string nearer_to(const Compared& faster, const Compared& missed);
bool is_equally_fast_and_reaches(const Compared& other, const Compared& missed,
                                 std::size_t comparisons);
/// @pre the pace of both is known.
bool is_equally_fast_with_other_sensors(const Compared& other, const Compared& missed);
/// Why one that reaches the goal is not compared with one that misses it, as a part of a sentence;
/// empty: the two do not differ in what they fly with, or it is not known.
std::string why_not_compared(const Compared& other, const Compared& missed);

}  // namespace tether::report
