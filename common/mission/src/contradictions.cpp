#include "contradictions.h"

#include <algorithm>
#include <limits>

namespace tether::mission {
namespace {

using Kind = Clause::Kind;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The values of a quantity that a clause allows, in SI units. Of kNever, those beyond the bound,
/// without the bound itself.
struct Allowed {
  double least = -kInfinity;
  double most = kInfinity;
};
Allowed allowed(const Clause& clause) {
  const Condition& condition = *clause.condition;
  const double bound = condition.unit->to_si(condition.bound);
  const bool is_upper = condition.at_most != (clause.kind == Kind::kNever);
  return is_upper ? Allowed{-kInfinity, bound} : Allowed{bound, kInfinity};
}

bool is_throughout(const Clause& clause) {
  return clause.kind == Kind::kAlways || clause.kind == Kind::kNever;
}

/// Whether all that `inner` is about is part of what `outer` is about.
bool covers(const Clause& outer, const Clause& inner) {
  if (!outer.during && !outer.after) return true;
  if (outer.after || inner.after) return outer.after == inner.after;
  return inner.during && outer.during->first <= inner.during->first &&
         inner.during->second <= outer.during->second;
}

bool contradict(const Clause& a, const Clause& b) {
  if (!a.condition || !b.condition) return false;
  if (a.condition->quantity != b.condition->quantity || a.condition->of != b.condition->of)
    return false;
  if (a.condition->share < 1.0 || b.condition->share < 1.0) return false;
  const bool meet = (is_throughout(a) && covers(a, b)) || (is_throughout(b) && covers(b, a));
  const Allowed of_a = allowed(a), of_b = allowed(b);
  const double least = std::max(of_a.least, of_b.least), most = std::min(of_a.most, of_b.most);
  // Each clause has one bound, so equal ones are of both.
  const bool is_empty_at_bound = a.kind == Kind::kNever || b.kind == Kind::kNever;
  return meet && (least > most || (least == most && is_empty_at_bound));
}

}  // namespace

void require_no_contradictions(const Mission& mission) {
  for (std::size_t later = 1; later < mission.clauses.size(); ++later) {
    for (std::size_t earlier = 0; earlier < later; ++earlier) {
      const Clause &a = mission.clauses[earlier], &b = mission.clauses[later];
      if (!contradict(a, b)) continue;
      throw Error(ErrorCode::kBadFile, b.where,
                  "the clause \"" + b.name + "\" contradicts \"" + a.name + "\" in line " +
                      std::to_string(a.where.line) +
                      ": no value meets both. Change a bound, or 'during'.")
          .about(b.name);
    }
  }
}

}  // namespace tether::mission
