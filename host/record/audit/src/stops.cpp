#include "checks.h"
#include "growth.h"
#include "suts.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tether::audit {
namespace {

using Entry = record::Logged<record::Interaction>;
using Stop = record::Logged<record::Stop>;

// One concurrent SUT: its requests in the order of their sequence, its replies in the order of the
// file, and its stops. A stop divides the others: by ST and wall time the requests, by the order of
// the file the replies.
class ConcurrentCheck {
 public:
  ConcurrentCheck(const SutRow& row, const record::Record& record, const Boundaries& grid,
                  Report& report)
      : row_(row),
        wall_at_start_(record.header.wall_at_start),
        finished_(record.footer && record.footer->end == "finished"),
        grid_(grid),
        report_(report),
        requests_(row.interactions) {
    std::ranges::stable_sort(requests_, {},
                             [](const Entry* entry) { return entry->message.sequence; });
  }

  void run() {
    check_requests();
    check_finish();
    check_stops();
    check_replies();
    check_replies_of_stops();
    check_growth();
  }

 private:
  // In the order of sequence, neither timestamps (rule 5) nor ST on arrival (rule 4) decrease.
  void check_requests() {
    const Entry* last = nullptr;
    for (const Entry* entry : requests_) {
      if (last && entry->message.request_at < last->message.request_at)
        report_.add(5, *entry, "request at ET {} is before request {} at ET {}",
                    ns(entry->message.request_at), last->message.sequence,
                    ns(last->message.request_at));
      if (last && entry->message.st_at_arrival < last->message.st_at_arrival)
        report_.add(4, *entry, "arrived at ST {}, before request {} at ST {}",
                    ns(entry->message.st_at_arrival), last->message.sequence,
                    ns(last->message.st_at_arrival));
      last = entry;
    }
  }

  // Rule 5: no reply follows that to a finish.
  void check_finish() {
    const auto is_finish = [](const Entry* entry) {
      return entry->message.kind == record::kFinish;
    };
    auto entry = std::ranges::find_if(row_.interactions, is_finish);
    if (entry == row_.interactions.end()) return;
    while (++entry != row_.interactions.end())
      report_.add(5, **entry, "reply after the SUT had finished");
  }

  // Rule 5: the ET of a stop is not before the previous stop, nor before a request that had
  // arrived. Rule 4: ST had not passed it.
  void check_stops() {
    const Stop* last = nullptr;
    for (const Stop* stop : row_.stops) {
      const ExecTime at = stop->message.at;
      if (last && at < last->message.at)
        report_.add(5, *stop, "stop at ET {} after a stop at ET {}", ns(at), ns(last->message.at));
      if (wide(stop->at) > grid_.at_or_before(wide(at)))
        report_.add(4, *stop, "ST had reached {} at the stop at ET {}", ns(stop->at), ns(at));
      check_against_requests(*stop);
      last = stop;
    }
  }

  void check_against_requests(const Stop& stop) {
    const auto first_later = std::ranges::partition_point(
        requests_, [&](const Entry* entry) { return arrived_before(*entry, stop); });
    if (first_later != requests_.begin()) {
      const record::Interaction& last = (*std::prev(first_later))->message;
      if (last.request_at > stop.message.at)
        report_.add(5, stop, "stop at ET {} after request {} at ET {}", ns(stop.message.at),
                    last.sequence, ns(last.request_at));
    }
    const auto known_later = std::ranges::find_if(
        first_later, requests_.end(), [&](const auto* e) { return arrived_after(*e, stop); });
    if (known_later != requests_.end() && (*known_later)->message.request_at < stop.message.at)
      report_.add(5, **known_later, "request at ET {} after a stop at ET {}",
                  ns((*known_later)->message.request_at), ns(stop.message.at));
  }

  // Whether the request arrived before the stop was reported: by ST, else by the host's clock.
  static bool arrived_before(const Entry& entry, const Stop& stop) {
    const record::Interaction& m = entry.message;
    if (m.st_at_arrival != stop.at) return m.st_at_arrival < stop.at;
    return m.wall_at_arrival != WallTime{} && m.wall_at_arrival < stop.message.wall;
  }
  static bool arrived_after(const Entry& entry, const Stop& stop) {
    const record::Interaction& m = entry.message;
    if (m.st_at_arrival != stop.at) return m.st_at_arrival > stop.at;
    return stop.message.wall != WallTime{} && m.wall_at_arrival > stop.message.wall;
  }

  // Rule 5: a reply is sent while the SUT is stopped, at the reply's timestamp or later, and the
  // SUT did not resume from an earlier stop at which the reply was due.
  void check_replies() {
    std::pair<ExecTime, std::uint64_t> last{ExecTime::min(), 0};
    for (const Entry* entry : row_.interactions) {
      const record::Interaction& m = entry->message;
      const std::size_t stops = stops_before(*entry);
      if (stops == 0 || row_.stops[stops - 1]->message.at < m.reply_at) {
        report_.add(5, *entry, "reply at ET {} without a stop", ns(m.reply_at));
      } else if (stops > 1 && was_due(m, row_.stops[stops - 2]->message)) {
        report_.add(5, *entry, "reply at ET {} was missing when the SUT resumed at ET {}",
                    ns(m.reply_at), ns(row_.stops[stops - 2]->message.at));
      }
      const std::pair own{m.reply_at, m.sequence};
      if (own < last && !may_be_moved_up(m))
        report_.add(5, *entry, "reply at ET {} after the reply at ET {}", ns(m.reply_at),
                    ns(last.first));
      last = std::max(last, own);
    }
  }

  // A request with the timestamp of the stop may have arrived after the stop. So may the message
  // that moved a reply up, and the SUT may have resumed before it heard of that.
  static bool was_due(const record::Interaction& m, const record::Stop& stop) {
    if (may_be_moved_up(m)) return false;
    return m.reply_at < stop.at || (m.reply_at == stop.at && m.request_at < stop.at);
  }

  static bool may_be_moved_up(const record::Interaction& m) {
    return m.received && m.receive_until && m.reply_at < *m.receive_until;
  }

  std::size_t stops_before(const Entry& entry) const {
    const auto later = std::ranges::partition_point(
        row_.stops, [&](const Stop* stop) { return stop->order < entry.order; });
    return static_cast<std::size_t>(later - row_.stops.begin());
  }

  // Rule 0: a stop names its reply, the earliest one that the SUT knew of. Replies that a message
  // moved up may come before it. It is unknown whether one was due at the last stop of an
  // interrupted run.
  void check_replies_of_stops() {
    std::vector<std::vector<const record::Interaction*>> replies(row_.stops.size());
    for (const Entry* entry : row_.interactions)
      if (const std::size_t stops = stops_before(*entry); stops > 0)
        replies[stops - 1].push_back(&entry->message);
    for (std::size_t i = 0; i < row_.stops.size(); ++i) {
      const std::optional<ExecTime>& named = row_.stops[i]->message.reply_at;
      std::optional<ExecTime> earliest;  // of those that were due when the stop was reported
      bool was_sent = false;
      for (const record::Interaction* reply : replies[i]) {
        was_sent |=
            named == reply->reply_at || (may_be_moved_up(*reply) && named == reply->receive_until);
        if (!may_be_moved_up(*reply))
          earliest = std::min(earliest.value_or(reply->reply_at), reply->reply_at);
      }
      const bool unknown = i + 1 == row_.stops.size() && !finished_ && !earliest;
      const bool fits = named ? was_sent && (!earliest || *named <= *earliest) : !earliest;
      if (!unknown && !fits)
        report_.add(0, *row_.stops[i], "stop for {}, but the next was {}", text(named),
                    text(earliest));
    }
  }

  static std::string text(const std::optional<ExecTime>& reply_at) {
    return reply_at ? "a reply at ET " + ns(*reply_at) : "no reply";
  }

  // Rule 5: the SUT resumes after the last reply of its stop was sent. From then on, its ET grows
  // no faster than the host's clock allows.
  void check_growth() {
    std::vector<WallTime> resumed_at(row_.stops.size());
    for (std::size_t i = 0; i < row_.stops.size(); ++i) resumed_at[i] = row_.stops[i]->message.wall;
    for (const Entry* entry : row_.interactions) {
      const std::size_t stops = stops_before(*entry);
      if (stops > 0)
        resumed_at[stops - 1] = std::max(resumed_at[stops - 1], entry->message.wall_at_release);
    }
    if (!row_.stops.empty()) check_growth(ExecTime{}, wall_at_start_, *row_.stops.front());
    for (std::size_t i = 1; i < row_.stops.size(); ++i) {
      const record::Stop& before = row_.stops[i - 1]->message;
      if (!before.reply_at || before.wall == WallTime{}) continue;
      check_growth(before.at, resumed_at[i - 1], *row_.stops[i]);
    }
  }

  void check_growth(ExecTime since, WallTime resumed_at, const Stop& stop) {
    if (stop.message.wall == WallTime{} || resumed_at == WallTime{}) return;
    const Wide grown = wide(stop.message.at) - wide(since);
    const Wide elapsed = wide(stop.message.wall) - wide(resumed_at);
    if (const auto fault = growth_fault(*row_.info, grown, elapsed))
      report_.add(5, stop, "{}", *fault);
  }

  const SutRow& row_;
  WallTime wall_at_start_;
  bool finished_;
  const Boundaries& grid_;
  Report& report_;
  std::vector<const Entry*> requests_;
};

}  // namespace

void check_stops(const record::Record& record, const Boundaries& grid, Report& report) {
  for (const auto& [uav, row] : rows_of(record)) {
    if (row.info->concurrent) ConcurrentCheck(row, record, grid, report).run();
  }
}

}  // namespace tether::audit
