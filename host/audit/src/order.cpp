#include "checks.h"
#include "file_order.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <type_traits>
#include <vector>

namespace tether::audit {
namespace {

using Entry = record::Logged<record::Interaction>;

// A reply at an ST below one that the file has shown before has a timestamp in the past of the
// simulation. Either its request had that timestamp (rule 4), or the reply was sent too late
// (rule 3).
void check_file_order(const record::Record& record, Report& report) {
  Wide reached = 0;
  for_each_in_file_order(record, [&](const auto& entry) {
    if constexpr (std::is_same_v<std::decay_t<decltype(entry)>, Entry>) {
      const record::Interaction& message = entry.message;
      if (wide(message.st_at_release) < reached) {
        const bool immediate = message.reply_at == message.request_at;
        report.add(immediate ? 4 : 3, entry, "{} at ET {} when ST had already reached {}",
                   immediate ? "request" : "reply", ns(message.reply_at), ns(reached));
      }
    }
    reached = std::max(reached, wide(entry.at));
  });
}

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
    const record::Interaction& message = entry.message;
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
  check_file_order(record, report);
  check_wall_order(record, grid, report);
}

}  // namespace tether::audit
