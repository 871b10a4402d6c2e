#include "events.h"
#include "signals.h"
#include "spans.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <tether/judge/judge.h>
#include <tether/stl/robustness.h>

// A clause is judged in its span: the part of the run that it is about. Clauses about quantities
// are formulas of STL; their inner part is evaluated at every instant, and the margin is its
// extremum in the span, which also shows where it is.
namespace tether::judge {
namespace {

using mission::Clause;
using mission::Condition;
using mission::OnMiss;
using Kind = Clause::Kind;

std::string at_text(SimTime at) {
  return fmt::format("at ST {:.3f} s", to_seconds(at));
}

class Judge {
 public:
  Judge(const mission::Mission& mission, const std::string& uav, const record::Record& record)
      : mission_(mission),
        uav_(uav),
        record_(record),
        tasks_(task_spans(mission, uav, record)),
        whole_(mission_span(uav, record)),
        signals_(uav, record) {}

  Verdicts verdicts() {
    Verdicts verdicts{tasks_, {}};
    for (const Clause& clause : mission_.clauses) verdicts.clauses.push_back(judge(clause));
    return verdicts;
  }

 private:
  const TaskSpan* find(std::size_t task) const {
    const auto found = std::ranges::find(tasks_, mission_.tasks[task].name, &TaskSpan::task);
    return found == tasks_.end() ? nullptr : &*found;
  }

  // Spans.

  /// None, with the reason in the verdict: a task did not run.
  std::optional<Span> span_of(const Clause& clause, ClauseVerdict& verdict) const {
    if (!clause.during && !clause.after) return whole_;
    const std::size_t first = clause.after ? *clause.after : clause.during->first;
    const std::size_t last = clause.after ? first : clause.during->second;
    const TaskSpan *begin = find(first), *end = find(last);
    for (const std::size_t task : {first, last}) {
      if (find(task) == nullptr)
        verdict.limited_by = fmt::format("the task '{}' did not run", mission_.tasks[task].name);
    }
    if (begin == nullptr || end == nullptr) return std::nullopt;
    if (!clause.after) return Span{begin->from, end->to};
    if (begin->status == "unfinished") {
      verdict.limited_by = fmt::format("the task '{}' did not end", begin->task);
      return std::nullopt;
    }
    return Span{begin->to, std::max(begin->to, whole_.to)};
  }

  ClauseVerdict judge(const Clause& clause) {
    ClauseVerdict verdict{.uav = uav_, .name = clause.name};
    verdict.unit = clause.condition ? clause.condition->unit->name : "s";
    const std::optional<Span> span = span_of(clause, verdict);
    if (!span) return verdict;
    verdict.from = span->from;
    verdict.to = span->to;
    if (clause.within) verdict.deadline = span->from + *clause.within;
    if (clause.before) verdict.deadline = SimTime(*clause.before);
    if (clause.kind == Kind::kDeadline)
      judge_deadline(clause, *span, verdict);
    else if (clause.condition->quantity->is_event)
      judge_events(clause, *span, verdict);
    else
      judge_signal(clause, *span, verdict);
    return verdict;
  }

  // Deadlines.

  /// Why the goals of a span were not reached; empty if they were.
  std::string why_not_reached(const Clause& clause) const {
    const std::size_t first = clause.during ? clause.during->first : 0;
    const std::size_t last = clause.during ? clause.during->second : mission_.tasks.size() - 1;
    for (std::size_t i = first; i <= last; ++i) {
      if (i != last && mission_.tasks[i].on_miss.kind == OnMiss::Kind::kContinue) continue;
      const TaskSpan* task = find(i);
      if (task == nullptr) return fmt::format("the task '{}' did not run", mission_.tasks[i].name);
      if (task->status != "reached")
        return fmt::format("the task '{}' ended {}{}{}", task->task, task->status,
                           task->reason.empty() ? "" : ": ", task->reason);
    }
    return "";
  }

  void judge_deadline(const Clause& clause, const Span& span, ClauseVerdict& verdict) const {
    const std::string missing = why_not_reached(clause);
    const SimTime deadline = *verdict.deadline;
    const Duration left = deadline - span.to;
    verdict.met = missing.empty() && left >= Duration(0);
    verdict.decided_at = std::min(span.to, deadline);
    // Without the goal the margin is known only if the deadline has passed: it is no larger.
    if (missing.empty() || left < Duration(0)) verdict.margin = to_seconds(left);
    verdict.limited_by = missing.empty() ? time_taken(uav_, span, record_) : missing;
  }

  // Events.

  static double margin_of(const Condition& condition, double value) {
    const double bound = condition.bound * condition.unit->si;
    return condition.at_most ? bound - value : value - bound;
  }

  void judge_events(const Clause& clause, const Span& span, ClauseVerdict& verdict) const {
    const Condition& condition = *clause.condition;
    const double sign = clause.kind == Kind::kNever ? -1.0 : 1.0;
    struct Margin {
      double value;
      const Event* event;
    };
    const std::vector<Event> events = events_of(condition, uav_, span, record_);
    std::vector<Margin> margins;
    for (const Event& event : events)
      margins.push_back({sign * margin_of(condition, event.value), &event});
    if (margins.empty()) {
      verdict.limited_by = "there is no such command or read in this time";
      return;
    }
    const auto first_miss =
        std::ranges::find_if(margins, [](const Margin& margin) { return margin.value < 0.0; });
    const SimTime missed_at = first_miss == margins.end() ? span.to : first_miss->event->at;
    const std::size_t place = place_of(condition.share, margins.size());
    std::nth_element(margins.begin(), margins.begin() + static_cast<std::ptrdiff_t>(place),
                     margins.end(), [](const Margin& a, const Margin& b) {
                       return std::pair(-a.value, a.event) < std::pair(-b.value, b.event);
                     });
    const Event& least = *margins[place].event;
    settle(margins[place].value, condition, verdict);
    verdict.decided_at = verdict.met || condition.share < 1.0 ? span.to : missed_at;
    verdict.limited_by = fmt::format("{:.4g} {} {}", least.value / condition.unit->si,
                                     condition.unit->name, at_text(least.at));
    if (least.reaction) verdict.limited_by += text_of(*least.reaction);
  }

  static std::string text_of(const Reaction& reaction) {
    const auto ms = [](Duration time) { return 1e3 * to_seconds(time); };
    return fmt::format(
        ": {:.3g} ms from the image's instant until the program had it, {:.3g} ms until its "
        "command, {:.3g} ms until the effect",
        ms(reaction.until_had), ms(reaction.until_command), ms(reaction.until_effect));
  }

  /// Index of the last of `count` margins, largest first, that a share must have.
  static std::size_t place_of(double share, std::size_t count) {
    const double needed = std::ceil(share * static_cast<double>(count) - 1e-9);
    return static_cast<std::size_t>(std::max(needed, 1.0)) - 1;
  }

  static void settle(double margin_si, const Condition& condition, ClauseVerdict& verdict) {
    verdict.margin = margin_si / condition.unit->si;
    verdict.met = margin_si >= 0.0;
  }

  // Signals.

  stl::Formula inner(const Clause& clause, std::size_t signal) const {
    const Condition& condition = *clause.condition;
    const double bound = condition.bound * condition.unit->si;
    const stl::Formula holds = condition.at_most ? stl::Formula::at_most(signal, bound)
                                                 : stl::Formula::at_least(signal, bound);
    if (clause.kind == Kind::kNever) return stl::Formula::negation(holds);
    if (clause.hold == Duration(0)) return holds;
    return stl::Formula::always({Duration(0), clause.hold}, holds);
  }

  void judge_signal(const Clause& clause, const Span& span, ClauseVerdict& verdict) {
    const std::optional<std::size_t> signal = signals_.find(*clause.condition);
    const std::vector<SimTime>& at = signals_.trace().at;
    if (!signal || at.empty() || at.front() > span.from) {
      verdict.limited_by =
          fmt::format("the record does not have {}", clause.condition->quantity->name);
      return;
    }
    const bool is_eventually = clause.kind == Kind::kEventually;
    const SimTime until =
        is_eventually ? std::min(span.to, verdict.deadline.value_or(span.to)) : span.to;
    if (until - clause.hold < span.from) {
      verdict.decided_at = until;
      verdict.limited_by = "the time ended before the condition could hold that long";
      return;
    }
    const auto in_effect = [&](SimTime time) {
      return static_cast<std::size_t>(std::ranges::upper_bound(at, time) - at.begin() - 1);
    };
    const std::size_t first = in_effect(span.from), last = in_effect(until - clause.hold);
    stl::Evaluator evaluator(signals_.trace());
    const std::vector<double> margins = evaluator.robustness(inner(clause, *signal));
    const std::size_t place = is_eventually ? best(margins, first, last)
                              : clause.condition->share < 1.0
                                  ? at_share(margins, first, last, clause.condition->share)
                                  : worst(margins, first, last);
    settle(margins[place], *clause.condition, verdict);
    const double value = signals_.trace().signals[*signal].values[place];
    verdict.decided_at = decided_at(clause, verdict.met, margins, first, last, until);
    verdict.limited_by =
        fmt::format("{:.4g} {} {}", value / clause.condition->unit->si,
                    clause.condition->unit->name, at_text(std::max(at[place], span.from)));
  }

  static std::size_t best(const std::vector<double>& margins, std::size_t first, std::size_t last) {
    std::size_t place = first;
    for (std::size_t i = first; i <= last; ++i)
      if (margins[i] > margins[place]) place = i;
    return place;
  }
  static std::size_t worst(const std::vector<double>& margins, std::size_t first,
                           std::size_t last) {
    std::size_t place = first;
    for (std::size_t i = first; i <= last; ++i)
      if (margins[i] < margins[place]) place = i;
    return place;
  }
  static std::size_t at_share(const std::vector<double>& margins, std::size_t first,
                              std::size_t last, double share) {
    std::vector<std::size_t> places;
    for (std::size_t i = first; i <= last; ++i) places.push_back(i);
    const auto place = static_cast<std::ptrdiff_t>(place_of(share, places.size()));
    std::nth_element(places.begin(), places.begin() + place, places.end(),
                     [&](std::size_t a, std::size_t b) {
                       return std::pair(-margins[a], a) < std::pair(-margins[b], b);
                     });
    return places[static_cast<std::size_t>(place)];
  }

  /// A condition that must hold throughout is missed when it first does not; one that must hold at
  /// some time is met when it has held long enough.
  SimTime decided_at(const Clause& clause, bool met, const std::vector<double>& margins,
                     std::size_t first, std::size_t last, SimTime until) const {
    const bool is_eventually = clause.kind == Kind::kEventually;
    if (met != is_eventually || clause.condition->share < 1.0) return until;
    for (std::size_t i = first; i <= last; ++i) {
      const bool decides = is_eventually ? margins[i] >= 0.0 : margins[i] < 0.0;
      if (decides) return std::min(until, signals_.trace().at[i] + clause.hold);
    }
    return until;
  }

  const mission::Mission& mission_;
  const std::string& uav_;
  const record::Record& record_;
  std::vector<TaskSpan> tasks_;
  Span whole_;
  Signals signals_;
};

}  // namespace

Verdicts judge(const mission::Mission& mission, const std::string& uav,
               const record::Record& record) {
  return Judge(mission, uav, record).verdicts();
}

}  // namespace tether::judge
