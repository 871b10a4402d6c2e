#include "checks.h"
#include "file_order.h"
#include "suts.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tether::audit {
namespace {

using record::Interaction;
using Entry = record::Logged<Interaction>;

// A reply at an ST below one that the file has shown before has a timestamp in the past of the
// simulation. Either its request had that timestamp (rule 4), or the reply was sent too late
// (rule 3).
void check_file_order(const record::Record& record, Report& report) {
  Wide reached = 0;
  for_each_in_file_order(record, [&](const auto& entry) {
    if constexpr (std::is_same_v<std::decay_t<decltype(entry)>, Entry>) {
      const Interaction& message = entry.message;
      if (wide(message.st_at_release) < reached) {
        const bool immediate = message.reply_at == message.request_at;
        report.add(immediate ? 4 : 3, entry, "{} at ET {} when ST had already reached {}",
                   immediate ? "request" : "reply", ns(message.reply_at), ns(reached));
      }
    }
    reached = std::max(reached, wide(entry.at));
  });
}

// A reply, for its order among those that were sent at the same ST: by (timestamp, index of the
// SUT).
struct Sent {
  const Entry* entry = nullptr;
  std::size_t sut = 0;
  auto key() const { return std::pair(entry->message.reply_at, sut); }
};

// Rule 3: of replies that can be sent at the same ST, the one with the smallest (timestamp, index)
// is sent first. A reply can be sent once its request has arrived, to a concurrent SUT once it has
// stopped: whatever other SUT could still forbid it forbids each one with a later timestamp, too.
class ReleaseOrder {
 public:
  ReleaseOrder(const record::Record& record, Report& report)
      : record_(record), report_(report), rows_(rows_of(record)) {
    for (const record::SutInfo& sut : record.header.suts)
      indices_.emplace(sut.uav, indices_.size());
  }

  void run() {
    for (const Entry& entry : record_.interactions) {
      const auto sut = indices_.find(entry.message.uav);
      if (sut == indices_.end()) continue;
      if (!ahead_.empty() &&
          ahead_.back().entry->message.st_at_release != entry.message.st_at_release)
        ahead_.clear();
      const Sent sent{&entry, sut->second};
      check(sent);
      while (!ahead_.empty() && ahead_.back().key() <= sent.key()) ahead_.pop_back();
      ahead_.push_back(sent);
    }
  }

 private:
  void check(const Sent& later) {
    // A message may have moved its reply up after others were sent.
    if (later.entry->message.kind == record::kReceive) return;
    const auto first = std::ranges::partition_point(
        ahead_,
        [&, since = sendable_since(later)](const Sent& sent) { return !since(*sent.entry); });
    if (first == ahead_.end() || first->sut == later.sut || first->key() < later.key()) return;
    report_.add(3, *later.entry, "reply at ET {} was sent after that of \"{}\" at ET {}",
                ns(later.entry->message.reply_at), first->entry->message.uav,
                ns(first->entry->message.reply_at));
  }

  // Whether the reply could be sent when another one at the same ST was: once true, true for all
  // that were sent after that one.
  std::function<bool(const Entry&)> sendable_since(const Sent& reply) const {
    const Interaction& m = reply.entry->message;
    const SutRow& row = rows_.at(m.uav);
    if (row.info->concurrent) return stopped_since(*reply.entry, row);
    // The barrier waits for a request at the boundary itself before it sends a later reply.
    const bool is_awaited = wide(m.request_at) <= wide(m.st_at_release) && !ahead_.empty() &&
                            m.request_at < ahead_.front().entry->message.reply_at;
    // Without wall times, replies are in this order in any case.
    // On a shared board, a request comes before its instant is known.
    if (m.computed && !is_awaited) return [](const Entry&) { return false; };
    if (is_awaited || m.st_at_arrival < m.st_at_release || m.wall_at_arrival == WallTime{})
      return [](const Entry&) { return true; };
    return [&m](const Entry& sent) { return m.wall_at_arrival < sent.message.wall_at_release; };
  }

  // A request with the timestamp of the stop may have arrived after it.
  static std::function<bool(const Entry&)> stopped_since(const Entry& reply, const SutRow& row) {
    const auto later = std::ranges::partition_point(
        row.stops, [&](const auto* stop) { return stop->order < reply.order; });
    if (later == row.stops.begin()) return [](const Entry&) { return false; };
    const auto& stop = **std::prev(later);
    const bool is_for =
        stop.message.at >= reply.message.reply_at && stop.message.at > reply.message.request_at;
    return [is_for, &stop](const Entry& sent) { return is_for && stop.order < sent.order; };
  }

  const record::Record& record_;
  Report& report_;
  std::map<std::string, SutRow> rows_;
  std::map<std::string, std::size_t> indices_;
  std::vector<Sent>
      ahead_;  // at the same ST, with decreasing keys: none after it has a greater one
};

struct Release {
  WallTime wall;
  Wide st = 0;
};

// Releases by wall time, each with the largest ST so far.
std::vector<Release> releases_by_wall(const record::Record& record) {
  std::vector<Release> releases;
  for (const Entry& entry : record.interactions) {
    if (entry.message.wall_at_release != WallTime{}) {
      releases.push_back({entry.message.wall_at_release, wide(entry.message.st_at_release)});
    }
  }
  std::ranges::stable_sort(releases, {}, &Release::wall);
  for (std::size_t i = 1; i < releases.size(); ++i) {
    releases[i].st = std::max(releases[i].st, releases[i - 1].st);
  }
  return releases;
}

// When a request arrives after a reply was sent, ST is at least the ST of that reply. This shows
// whether ST passed a computing SUT, independent of the recorded ST on arrival.
void check_wall_order(const record::Record& record, const Boundaries& grid, Report& report) {
  const std::vector<Release> releases = releases_by_wall(record);
  for (const Entry& entry : record.interactions) {
    const Interaction& message = entry.message;
    const auto later =
        std::ranges::lower_bound(releases, message.wall_at_arrival, {}, &Release::wall);
    if (message.wall_at_arrival == WallTime{} || later == releases.begin()) {
      continue;
    }
    const Wide reached = std::prev(later)->st;
    if (reached > grid.at_or_before(wide(message.request_at))) {
      report.add(4, entry,
                 "a reply was sent at ST {} before the request with timestamp ET {} arrived",
                 ns(reached), ns(message.request_at));
    } else if (reached > wide(message.st_at_arrival)) {
      report.add(4, entry, "arrived at ST {}, although a reply was sent before at ST {}",
                 ns(message.st_at_arrival), ns(reached));
    }
  }
}

}  // namespace

void check_order(const record::Record& record, const Boundaries& grid, Report& report) {
  ReleaseOrder(record, report).run();
  check_file_order(record, report);
  check_wall_order(record, grid, report);
}

}  // namespace tether::audit
