#include "checks.h"
#include "growth.h"
#include "suts.h"

#include <string>

namespace tether::audit {
namespace {

using Entry = record::Logged<record::Interaction>;

struct History {
  WallTime last_wall_at_release;
  ExecTime last_reply_at{};   // a SUT begins with ET 0
  SimTime last_release_at{};  // at ST 0
  bool finished = false;
  WallTime wall_at_release_before{};  // of the reply before the last one
};

// Rule 5: between two interactions ET only grows.
void check_et(const Entry& entry, const History& sut, Report& report) {
  if (sut.finished) report.add(5, entry, "request after the SUT had finished");
  if (entry.message.request_at < sut.last_reply_at)
    report.add(5, entry, "request at ET {} is before the previous reply at ET {}",
               ns(entry.message.request_at), ns(sut.last_reply_at));
}

// Of the SUT's clock, since the previous reply.
Wide growth(const Entry& entry, const History& sut) {
  const record::Interaction& m = entry.message;
  return m.computed ? wide(*m.computed) : wide(m.request_at) - wide(sut.last_reply_at);
}

void check_growth(const Entry& entry, const record::SutInfo& info, const History& sut,
                  Report& report) {
  if (sut.last_wall_at_release == WallTime{} || entry.message.wall_at_arrival == WallTime{}) {
    return;
  }
  const Wide grown = growth(entry, sut);
  // A program as it is computes during its calls, each of which it can have sent as soon as it had
  // the reply before.
  const WallTime since = info.as_is ? sut.wall_at_release_before : sut.last_wall_at_release;
  const Wide elapsed = wide(entry.message.wall_at_arrival) - wide(since);
  if (const auto fault = growth_fault(info, grown, elapsed)) report.add(5, entry, "{}", *fault);
}

// Rule 5: each reading of a scripted clock takes its time, and the request is one.
void check_script(const Entry& entry, const record::SutInfo& info, const History& sut,
                  Report& report) {
  const Wide reading = wide(info.clock.computing);
  if (info.clock.kind != computer::ClockKind::kScripted || reading <= 0) return;
  const Wide grown = growth(entry, sut);
  if (grown < reading || grown % reading != 0)
    report.add(5, entry, "ET grew by {}, but the scripted clock grows by {} at a time", ns(grown),
               ns(reading));
}

// Rule 4: ST on arrival is not before the SUT's last release.
void check_arrival(const Entry& entry, const History& sut, Report& report) {
  if (entry.message.st_at_arrival < sut.last_release_at)
    report.add(4, entry, "arrived at ST {}, before the previous reply was sent at ST {}",
               ns(entry.message.st_at_arrival), ns(sut.last_release_at));
}

}  // namespace

void check_rows(const record::Record& record, Report& report) {
  for (const auto& [uav, row] : rows_of(record)) {
    if (row.info->concurrent) continue;
    History history{.last_wall_at_release = record.header.wall_at_start,
                    .wall_at_release_before = record.header.wall_at_start};
    for (const Entry* entry : row.interactions) {
      check_et(*entry, history, report);
      check_growth(*entry, *row.info, history, report);
      check_script(*entry, *row.info, history, report);
      check_arrival(*entry, history, report);
      history = {
          entry->message.wall_at_release, entry->message.reply_at, entry->message.st_at_release,
          history.finished || entry->message.kind == record::kFinish, history.last_wall_at_release};
    }
  }
}

}  // namespace tether::audit
