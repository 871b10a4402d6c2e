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

// One concurrent SUT: what it asked, in the order in which it did, and where it stood still.
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
    check_what_for();
    check_growth();
  }

 private:
  // Rule 5: in the order of sequence no stamp goes back. Rule 4: nor does ST on arrival.
  void check_requests() {
    const Entry* last = nullptr;
    for (const Entry* entry : requests_) {
      if (last && entry->message.request_at < last->message.request_at) {
        report_.add(5, *entry,
                    "requested at ET " + ns(wide(entry->message.request_at)) + ", before request " +
                        std::to_string(last->message.sequence) + " at ET " +
                        ns(wide(last->message.request_at)));
      }
      if (last && entry->message.st_at_arrival < last->message.st_at_arrival) {
        report_.add(4, *entry,
                    "arrived at ST " + ns(wide(entry->message.st_at_arrival)) +
                        ", before request " + std::to_string(last->message.sequence) + " at ST " +
                        ns(wide(last->message.st_at_arrival)));
      }
      last = entry;
    }
  }

  // Rule 5: a finish is the last that it is told.
  void check_finish() {
    const auto is_finish = [](const Entry* entry) {
      return entry->message.kind == record::kFinish;
    };
    auto entry = std::ranges::find_if(row_.interactions, is_finish);
    if (entry == row_.interactions.end()) return;
    while (++entry != row_.interactions.end()) {
      report_.add(5, **entry, "replied after the SUT had finished");
    }
  }

  // Rule 5: ET does not go back where it stands still, nor behind what it had asked by then. Rule
  // 4: ST had not passed it.
  void check_stops() {
    const Stop* last = nullptr;
    for (const Stop* stop : row_.stops) {
      const Wide at = wide(stop->message.at);
      if (last && at < wide(last->message.at)) {
        add(5, *stop,
            "stopped at ET " + ns(at) + ", after a stop at " + ns(wide(last->message.at)));
      }
      if (wide(stop->at) > grid_.at_or_before(at)) {
        add(4, *stop, "ST had reached " + ns(wide(stop->at)) + " when it stopped at ET " + ns(at));
      }
      check_against_requests(*stop);
      last = stop;
    }
  }

  void check_against_requests(const Stop& stop) {
    const auto first_later = std::ranges::partition_point(
        requests_, [&](const Entry* entry) { return arrived_before(*entry, stop); });
    if (first_later != requests_.begin()) {
      const record::Interaction& last = (*std::prev(first_later))->message;
      if (last.request_at > stop.message.at) {
        add(5, stop,
            "stopped at ET " + ns(wide(stop.message.at)) + ", after request " +
                std::to_string(last.sequence) + " at " + ns(wide(last.request_at)));
      }
    }
    const auto known_later = std::ranges::find_if(
        first_later, requests_.end(), [&](const auto* e) { return arrived_after(*e, stop); });
    if (known_later != requests_.end() && (*known_later)->message.request_at < stop.message.at) {
      report_.add(5, **known_later,
                  "requested at ET " + ns(wide((*known_later)->message.request_at)) +
                      ", after it had stopped at " + ns(wide(stop.message.at)));
    }
  }

  // Whether the request was there when the stop became known: by ST, else by the host's clock.
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

  // Rule 5: a reply leaves while it stands still, at the reply's timestamp or later, and it does
  // not stand still elsewhere before a reply that it was to wait for.
  void check_replies() {
    std::pair<ExecTime, std::uint64_t> last{ExecTime::min(), 0};
    for (const Entry* entry : row_.interactions) {
      const record::Interaction& m = entry->message;
      const std::size_t stops = stops_before(*entry);
      if (stops == 0 || row_.stops[stops - 1]->message.at < m.reply_at) {
        report_.add(5, *entry,
                    "replied at ET " + ns(wide(m.reply_at)) + ", where it had not stopped");
      } else if (stops > 1 && was_due(m, row_.stops[stops - 2]->message)) {
        report_.add(5, *entry,
                    "had not its reply of ET " + ns(wide(m.reply_at)) +
                        " when it went on from its stop at " +
                        ns(wide(row_.stops[stops - 2]->message.at)));
      }
      if (std::pair(m.reply_at, m.sequence) < last) {
        report_.add(5, *entry,
                    "replied at ET " + ns(wide(m.reply_at)) + " after the reply of ET " +
                        ns(wide(last.first)));
      }
      last = {m.reply_at, m.sequence};
    }
  }

  // A request stamped just where it stood still may have come after the stop.
  static bool was_due(const record::Interaction& m, const record::Stop& stop) {
    return m.reply_at < stop.at || (m.reply_at == stop.at && m.request_at < stop.at);
  }

  std::size_t stops_before(const Entry& entry) const {
    const auto later = std::ranges::partition_point(
        row_.stops, [&](const Stop* stop) { return stop->order < entry.order; });
    return static_cast<std::size_t>(later - row_.stops.begin());
  }

  // Rule 0: a stop says for which reply it was. Whether one was due at the last stop of a run that
  // broke off cannot be known.
  void check_what_for() {
    std::vector<std::optional<ExecTime>> earliest(row_.stops.size());
    for (const Entry* entry : row_.interactions) {
      const std::size_t stops = stops_before(*entry);
      if (stops == 0) continue;
      std::optional<ExecTime>& least = earliest[stops - 1];
      least = std::min(least.value_or(entry->message.reply_at), entry->message.reply_at);
    }
    for (std::size_t i = 0; i < row_.stops.size(); ++i) {
      const bool unknown = i + 1 == row_.stops.size() && !finished_ && !earliest[i];
      if (unknown || row_.stops[i]->message.reply_at == earliest[i]) continue;
      add(0, *row_.stops[i],
          "a stop for " + text(row_.stops[i]->message.reply_at) + ", the next to leave was " +
              text(earliest[i]));
    }
  }

  static std::string text(const std::optional<ExecTime>& reply_at) {
    return reply_at ? "a reply of ET " + ns(wide(*reply_at)) : "no reply";
  }

  // Rule 5: it may go on when the last request was known, and the last reply had left, for which it
  // stood still; from then on its ET grows no faster than the host's clock.
  void check_growth() {
    std::vector<WallTime> goes_on(row_.stops.size());
    for (std::size_t i = 0; i < row_.stops.size(); ++i) goes_on[i] = row_.stops[i]->message.wall;
    for (const Entry* entry : row_.interactions) {
      const std::size_t stops = stops_before(*entry);
      if (stops > 0)
        goes_on[stops - 1] = std::max(goes_on[stops - 1], entry->message.wall_at_release);
    }
    if (!row_.stops.empty()) check_growth(ExecTime{}, wall_at_start_, *row_.stops.front());
    for (std::size_t i = 1; i < row_.stops.size(); ++i) {
      const record::Stop& before = row_.stops[i - 1]->message;
      if (!before.reply_at || before.wall == WallTime{}) continue;
      check_growth(before.at, goes_on[i - 1], *row_.stops[i]);
    }
  }

  void check_growth(ExecTime since, WallTime went_on, const Stop& stop) {
    if (stop.message.wall == WallTime{} || went_on == WallTime{}) return;
    const Wide grown = wide(stop.message.at) - wide(since);
    const Wide elapsed = wide(stop.message.wall) - wide(went_on);
    if (const auto fault = growth_fault(*row_.info, grown, elapsed)) add(5, stop, *fault);
  }

  void add(int rule, const Stop& stop, std::string what) {
    report_.add({rule, stop.message.uav, 0, stop.at, std::move(what)});
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
    if (row.info->concurrent) {
      ConcurrentCheck(row, record, grid, report).run();
    }
  }
}

}  // namespace tether::audit
