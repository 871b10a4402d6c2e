#include "events.h"
#include "robustness.h"
#include "signals.h"
#include "spans.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/judge/judge.h>

// A clause is judged in its span: the part of the run that it is about. Clauses about quantities
// are formulas of STL; their inner part is evaluated at every instant, and the margin is its
// extremum in the span, which also shows where it is.
//
// Clauses share this work: margins of conditions that differ in their bounds only differ by a
// constant. They are computed for the bound 0, once, and so is the place of their extremum.
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
    if (clause.condition) verdict.limit = clause.condition->bound;
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

  void judge_deadline(const Clause& clause, const Span& span, ClauseVerdict& verdict) {
    const std::string missing = why_not_reached(clause);
    const SimTime deadline = *verdict.deadline;
    verdict.limit = to_seconds(deadline - span.from);
    const Duration left = deadline - span.to;
    verdict.met = missing.empty() && left >= Duration(0);
    verdict.decided_at = std::min(span.to, deadline);
    // Without the goal the margin is known only if the deadline has passed: it is no larger.
    if (missing.empty() || left < Duration(0)) verdict.margin = to_seconds(left);
    for (const SimTime at : {span.from, span.to})
      verdict.margins.push_back({at, to_seconds(deadline - at)});
    verdict.limited_by = missing.empty() ? time_taken_in(span) : missing;
  }

  const std::string& time_taken_in(const Span& span) {
    const auto [known, is_new] = times_taken_.try_emplace({span.from, span.to});
    if (is_new) known->second = time_taken(uav_, span, record_);
    return known->second;
  }

  /// What is added to margins for the bound 0 [SI].
  static double shift_of(const Clause& clause, double before = 0.0) {
    const Condition& condition = *clause.condition;
    const double bound = condition.unit->to_si(condition.bound) + before;
    return condition.at_most == (clause.kind == Kind::kNever) ? -bound : bound;
  }

  // Events.

  static constexpr std::size_t kQuantiles = 20;

  /// The events of a condition in a span, and their margins for the bound 0.
  struct Events {
    std::vector<Event> events;
    std::vector<double> margins;
    std::vector<double> sorted;  ///< their values
  };

  const Events& events_in(const Clause& clause, const Span& span) {
    const Condition& condition = *clause.condition;
    const bool grows = condition.at_most == (clause.kind == Kind::kNever);
    const auto [known, is_new] =
        events_.try_emplace({condition.quantity, condition.of, grows, span.from, span.to});
    Events& of = known->second;
    if (!is_new) return of;
    of.events = events_of(condition, uav_, span, record_);
    for (const Event& event : of.events) {
      of.margins.push_back(grows ? event.value : -event.value);
      of.sorted.push_back(event.value);
    }
    std::ranges::sort(of.sorted);
    return of;
  }

  // What of reaction times and ages is the program's.
  static void divide(const std::vector<Event>& events, const mission::Unit& unit,
                     ClauseVerdict& verdict) {
    std::vector<double> without_s, computing_s;
    for (const Event& event : events) {
      if (!event.reaction) return;
      const Reaction& reaction = *event.reaction;
      const Duration waiting = reaction.until_command - reaction.computing;
      without_s.push_back(to_seconds(reaction.until_had + waiting + reaction.until_effect));
      computing_s.push_back(to_seconds(reaction.computing));
    }
    std::ranges::sort(computing_s);
    verdict.least_without_computing = unit.from_si(std::ranges::min(without_s));
    verdict.median_of_computing = unit.from_si(computing_s[computing_s.size() / 2]);
  }

  void judge_events(const Clause& clause, const Span& span, ClauseVerdict& verdict) {
    const Condition& condition = *clause.condition;
    verdict.quantity = condition.quantity->name;
    verdict.sensor = condition.of;
    const Events& in_span = events_in(clause, span);
    const std::vector<Event>& events = in_span.events;
    const std::vector<double>& margins = in_span.margins;
    if (events.empty()) {
      verdict.limited_by = "there is no such command or read in this time";
      return;
    }
    for (std::size_t i = 0; i <= kQuantiles; ++i)
      verdict.quantiles.push_back(condition.unit->from_si(
          in_span.sorted[(i * (events.size() - 1) + kQuantiles - 1) / kQuantiles]));
    divide(events, *condition.unit, verdict);
    const double shift = shift_of(clause);
    const std::size_t place =
        place_in(margins, Pick::kAtShare, 0, margins.size() - 1, condition.share);
    settle(margins[place] + shift, clause, verdict);
    verdict.decided_at = span.to;
    if (!verdict.met && condition.share == 1.0) {
      const auto first_miss = std::ranges::find_if(
          margins, [&](double margin) { return !is_met(clause, margin + shift); });
      verdict.decided_at = events[static_cast<std::size_t>(first_miss - margins.begin())].at;
    }
    follow(
        clause, 0, margins.size() - 1, margins, shift, [&](std::size_t i) { return events[i].at; },
        verdict);
    const Event& least = events[place];
    verdict.limited_by = value_text(least.value, condition) + at_text(least.at);
    if (least.reaction) verdict.limited_by += text_of(*least.reaction);
  }

  static std::string text_of(const Reaction& reaction) {
    const auto ms = [](Duration time) { return 1e3 * to_seconds(time); };
    std::string text = fmt::format(
        ": {:.3g} ms from the measurement's instant until the program had it, {:.3g} ms until its "
        "command",
        ms(reaction.until_had), ms(reaction.until_command));
    if (reaction.until_effect > Duration(0))
      text += fmt::format(", {:.3g} ms until the effect", ms(reaction.until_effect));
    return text;
  }

  /// Index of the last of `count` margins, largest first, that a share must have.
  static std::size_t place_of(double share, std::size_t count) {
    const double needed = std::ceil(share * static_cast<double>(count) - 1e-9);
    return static_cast<std::size_t>(std::max(needed, 1.0)) - 1;
  }

  /// A bound belongs to its condition: at the bound the condition holds, and "never" is missed.
  static bool is_met(const Clause& clause, double margin_si) {
    return clause.kind == Kind::kNever ? margin_si > 0.0 : margin_si >= 0.0;
  }

  static void settle(double margin_si, const Clause& clause, ClauseVerdict& verdict) {
    verdict.margin = clause.condition->unit->from_si(margin_si);
    verdict.met = is_met(clause, margin_si);
  }

  /// "7.2 m ", with the digits in which it differs from the bound.
  static std::string value_text(double value_si, const Condition& condition) {
    const double value = condition.unit->from_si(value_si);
    return fmt::format("{} {} ", distinct_text(value, condition.bound, 4), condition.unit->name);
  }

  // Signals.

  /// Margins for the bound 0 at every instant.
  const std::vector<double>& margins_of(const Clause& clause, std::size_t signal) {
    const bool at_most = clause.condition->at_most, is_never = clause.kind == Kind::kNever;
    const auto [known, is_new] = margins_.try_emplace({signal, at_most, is_never, clause.hold});
    if (!is_new) return known->second;
    const Trace& trace = signals_.trace();
    return known->second =
               robustness({at_most, is_never, clause.hold}, trace.signals[signal], trace.at);
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
    std::size_t first = in_effect(span.from);
    const std::size_t last = in_effect(until - clause.hold);
    const std::size_t known_from = signals_.known_from(*signal);
    const bool is_ratio = clause.condition->quantity->name == "delivery_ratio";
    if (known_from > last) {
      verdict.limited_by = is_ratio ? "no message was sent until then" : "no message had arrived";
      return;
    }
    if (is_ratio) first = std::max(first, known_from);
    const std::vector<double>& margins = margins_of(clause, *signal);
    const double share = clause.condition->share;
    const std::size_t place =
        place_in(margins, is_eventually ? Pick::kBest : Pick::kAtShare, first, last, share);
    // Energy counts from the start of the span.
    const std::vector<double>& values = signals_.trace().signals[*signal];
    const double before = clause.condition->quantity->counts_from_start() ? values[first] : 0.0;
    const double shift = shift_of(clause, before);
    settle(margins[place] + shift, clause, verdict);
    follow(
        clause, first, last, margins, shift,
        [&](std::size_t i) { return std::max(at[i], span.from); }, verdict);
    const double value = values[place] - before;
    verdict.decided_at = decided_at(clause, verdict.met, margins, shift, {first, last}, until);
    verdict.limited_by =
        value_text(value, *clause.condition) + at_text(std::max(at[place], span.from));
  }

  /// How the margin developed over the instants or events first … last.
  template <class At>
  static void follow(const Clause& clause, std::size_t first, std::size_t last,
                     const std::vector<double>& margins, double shift, const At& at,
                     ClauseVerdict& verdict) {
    constexpr std::size_t kMost = 40;
    const std::size_t stride = (last - first) / kMost + 1;
    const bool is_eventually = clause.kind == Kind::kEventually;
    const bool restarts = clause.condition->share < 1.0;
    double extremum = margins[first];
    for (std::size_t i = first; i <= last; ++i) {
      extremum = is_eventually ? std::max(extremum, margins[i]) : std::min(extremum, margins[i]);
      if ((i - first) % stride != 0 && i != last) continue;
      verdict.margins.push_back({at(i), clause.condition->unit->from_si(extremum + shift)});
      if (restarts && i < last) extremum = margins[i + 1];
    }
  }

  enum class Pick { kBest, kAtShare };

  /// Index of the best of the margins first … last, or of the worst of the share that counts; the
  /// first of equal ones.
  std::size_t place_in(const std::vector<double>& margins, Pick pick, std::size_t first,
                       std::size_t last, double share) {
    const auto [known, is_new] = places_.try_emplace({&margins, pick, first, last, share});
    if (!is_new) return known->second;
    const auto begin = margins.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = margins.begin() + static_cast<std::ptrdiff_t>(last + 1);
    const auto found = pick == Pick::kBest ? std::max_element(begin, end)
                       : share == 1.0      ? std::min_element(begin, end)
                                           : std::find(begin, end, at_share(begin, end, share));
    return known->second = static_cast<std::size_t>(found - margins.begin());
  }

  template <class Iterator>
  static double at_share(Iterator begin, Iterator end, double share) {
    std::vector<double> sorted(begin, end);
    const auto place = static_cast<std::ptrdiff_t>(place_of(share, sorted.size()));
    std::nth_element(sorted.begin(), sorted.begin() + place, sorted.end(), std::greater<>());
    return sorted[static_cast<std::size_t>(place)];
  }

  /// A condition that must hold throughout is missed when it first does not; one that must hold at
  /// some time is met when it has held long enough.
  SimTime decided_at(const Clause& clause, bool met, const std::vector<double>& margins,
                     double shift, const std::pair<std::size_t, std::size_t>& places,
                     SimTime until) const {
    const bool is_eventually = clause.kind == Kind::kEventually;
    if (met != is_eventually || clause.condition->share < 1.0) return until;
    for (std::size_t i = places.first; i <= places.second; ++i) {
      if (is_met(clause, margins[i] + shift) == is_eventually)
        return std::min(until, signals_.trace().at[i] + clause.hold);
    }
    return until;
  }

  const mission::Mission& mission_;
  const std::string& uav_;
  const record::Record& record_;
  std::vector<TaskSpan> tasks_;
  Span whole_;
  Signals signals_;

  // What clauses share.
  std::map<std::tuple<SimTime, SimTime>, std::string> times_taken_;
  std::map<std::tuple<const mission::Quantity*, std::string, bool, SimTime, SimTime>, Events>
      events_;
  std::map<std::tuple<std::size_t, bool, bool, Duration>, std::vector<double>> margins_;
  std::map<std::tuple<const std::vector<double>*, Pick, std::size_t, std::size_t, double>,
           std::size_t>
      places_;
};

}  // namespace

Verdicts judge(const mission::Mission& mission, const std::string& uav,
               const record::Record& record) {
  return Judge(mission, uav, record).verdicts();
}

}  // namespace tether::judge
