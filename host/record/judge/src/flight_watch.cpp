#include "signals.h"

#include <algorithm>

#include <fmt/format.h>

#include <tether/judge/judge.h>

namespace tether::judge {
namespace {

using mission::Clause;

bool is_missed(const Clause& clause, double value) {
  const mission::Condition& condition = *clause.condition;
  const double bound = condition.unit->to_si(condition.bound);
  const bool holds = condition.at_most ? value <= bound : value >= bound;
  return holds == (clause.kind == Clause::Kind::kNever);
}

}  // namespace

std::optional<FlightWatch::Miss> FlightWatch::look() {
  for (; next_interaction_ < record_.interactions.size(); ++next_interaction_) {
    const record::Interaction& entry = record_.interactions[next_interaction_].message;
    if (entry.uav == uav_ && entry.kind == record::kFinish)
      finished_at_ = std::min(finished_at_, same_instant(entry.reply_at));
  }
  std::vector<const record::GroundTruth*> added;
  for (; next_truth_ < record_.ground_truth.size(); ++next_truth_) {
    const record::GroundTruth& truth = record_.ground_truth[next_truth_].message;
    if (truth.uav == uav_ && truth.at <= finished_at_) added.push_back(&truth);
  }
  if (added.empty()) return std::nullopt;
  if (!start_) start_ = *added.front();
  std::optional<Miss> first;
  for (const Clause& clause : mission_.clauses) {
    if (!clause.ends_flight) continue;
    const auto miss = first_miss(clause, added);
    if (miss && (!first || miss->at < first->at)) first = miss;
  }
  return first;
}

std::optional<FlightWatch::Miss> FlightWatch::first_miss(
    const Clause& clause, const std::vector<const record::GroundTruth*>& truths) const {
  const mission::Quantity& quantity = *clause.condition->quantity;
  const mission::Unit& unit = *clause.condition->unit;
  const auto reference = Reference::of(*clause.condition, *start_, record_);
  if (!reference) return std::nullopt;
  for (const record::GroundTruth* truth : truths) {
    const auto value = value_of(quantity, *truth, *reference);
    if (!value || !is_missed(clause, *value)) continue;
    return Miss{
        truth->at,
        fmt::format("the clause \"{}\" ended the flight of \"{}\" at ST {:.3f} s: {} {:.4g} {}",
                    clause.name, uav_, to_seconds(truth->at), quantity.name, unit.from_si(*value),
                    unit.name)};
  }
  return std::nullopt;
}

}  // namespace tether::judge
