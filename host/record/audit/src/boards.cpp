#include "checks.h"
#include "suts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

// Rule 5 on boards that several SUTs share. On a real one all of them stop at one ET: one that went
// on would have the cores of one that is held. On a virtual one, while n compute, each gets min(1,
// cores / n) of a core.
// The record says from when to when each SUT computed, and how much. So the number of computing
// SUTs is known at every instant, and with it what each could have computed: nothing is scheduled
// here.
namespace tether::audit {
namespace {

using Entry = record::Logged<record::Interaction>;

// Beyond that, multiples of the shares do not fit.
constexpr std::size_t kMostSuts = 40;

// A SUT computes from `begin` on, until its request.
struct Span {
  Wide begin = 0;
  const Entry* entry = nullptr;  // null: its request is not in the record
  Wide end() const { return wide(entry->message.request_at); }
};

class PoolCheck {
 public:
  PoolCheck(Wide cores, std::size_t suts, Report& report)
      : cores_(cores), has_cores_for_all_(cores >= static_cast<Wide>(suts)), report_(report) {
    for (Wide n = 2; n <= static_cast<Wide>(suts); ++n) per_ns_ = per_ns_ / gcd(per_ns_, n) * n;
  }

  void add(const SutRow& row) {
    Wide resumed = 0;
    for (const Entry* entry : row.interactions) {
      spans_.push_back({resumed, entry});
      resumed = wide(entry->message.reply_at);
      if (entry->message.kind == record::kFinish) return;
    }
    known_until_ = std::min(known_until_.value_or(resumed), resumed);
  }

  void run() {
    for (const Span& span : spans_) {
      if (span.end() < span.begin) return;  // check_rows reports it
      changes_[span.begin] += 1;
      changes_[span.end()] -= 1;
    }
    add_up();
    for (const Span& span : spans_) check(span);
  }

 private:
  static Wide gcd(Wide a, Wide b) { return b == 0 ? a : gcd(b, a % b); }

  // From `at` on, until the next point.
  struct Point {
    Wide at = 0;
    Wide share = 0;     // of each computing SUT, in units a ns
    Wide computed = 0;  // by a SUT that computes all the time, up to here, in units
  };

  void add_up() {
    Wide computing = 0;
    for (const auto& [at, change] : changes_) {
      computing += change;
      const Wide before = points_.empty() ? 0 : computed_until(at);
      points_.push_back(
          {at, per_ns_ * std::min(cores_, computing) / std::max<Wide>(computing, 1), before});
    }
  }

  Wide computed_until(Wide at) const {
    const auto after = std::ranges::upper_bound(points_, at, {}, &Point::at);
    const Point& point = *std::prev(after);
    return point.computed + (at - point.at) * point.share;
  }

  // It had computed all of its work at its request, and not a nanosecond before.
  void check(const Span& span) {
    if (known_until_ && span.end() > *known_until_)
      return;  // a SUT computes of which no more is known
    const auto& computed = span.entry->message.computed;
    if (!computed && has_cores_for_all_) return;  // all of it
    if (!computed || *computed < Duration(0))
      return report_.add(5, *span.entry, "computed an unknown time on a shared board");
    const Wide work = wide(*computed) * per_ns_, begin = computed_until(span.begin);
    if (computed_until(span.end()) - begin < work)
      return report_.add(5, *span.entry, "computed {} between ET {} and {}, more than its share",
                         ns(*computed), ns(span.begin), ns(span.end()));
    if (span.end() > span.begin && computed_until(span.end() - 1) - begin >= work)
      report_.add(5, *span.entry, "computed only {} between ET {} and {}, less than its share",
                  ns(*computed), ns(span.begin), ns(span.end()));
  }

  Wide cores_;
  bool has_cores_for_all_;  // each SUT has a core whenever it computes
  Report& report_;
  Wide per_ns_ = 1;  // units of work: divisible by each number of SUTs
  std::vector<Span> spans_;
  std::optional<Wide> known_until_;
  std::map<Wide, Wide> changes_;  // of the number of computing SUTs, by ET
  std::vector<Point> points_;
};

// Each SUT of a real board has stopped whenever another one has, up to its own last stop. Later
// ones are not its own if it had finished, or are missing because the run ended.
void check_equal_stops(const record::BoardInfo& board, const std::map<std::string, SutRow>& rows,
                       Report& report) {
  std::map<ExecTime, const record::Logged<record::Stop>*> stops;
  for (const auto& [uav, row] : rows)
    if (row.info->board == board.name)
      for (const auto* stop : row.stops) stops.try_emplace(stop->message.at, stop);
  for (const auto& [uav, row] : rows) {
    if (row.info->board != board.name) continue;
    if (!row.info->concurrent)
      report.add("the SUT of \"" + uav + "\" shares the board \"" + board.name +
                 "\", but is not stopped with its other SUTs");
    std::set<ExecTime> own;
    for (const auto* stop : row.stops) own.insert(stop->message.at);
    for (const auto& [at, stop] : stops)
      if (!own.empty() && at <= *own.rbegin() && !own.contains(at))
        report.add(5, *stop, "stop at ET {}, at which \"{}\" did not stop on the same board",
                   ns(at), uav);
  }
}

// The header's list, its SUTs and their messages name the same boards.
void check_names(const record::Record& record, const std::map<std::string, SutRow>& rows,
                 Report& report) {
  std::set<std::string> known, used;
  for (const record::BoardInfo& board : record.header.boards) known.insert(board.name);
  for (const auto& [uav, row] : rows) {
    const std::string& board = row.info->board;
    if (!board.empty() && !known.contains(board))
      report.add("the SUT of \"" + uav + "\" is on the board \"" + board +
                 "\", which the header does not have");
    used.insert(board);
    for (const Entry* entry : row.interactions)
      if (board.empty() && entry->message.computed)
        report.add(5, *entry, "computed {} as on a shared board, by a SUT that shares none",
                   ns(*entry->message.computed));
  }
  for (const std::string& board : known)
    if (!used.contains(board)) report.add("no SUT is on the board \"" + board + "\"");
}

}  // namespace

void check_boards(const record::Record& record, Report& report) {
  const auto rows = rows_of(record);
  check_names(record, rows, report);
  for (const record::BoardInfo& board : record.header.boards) {
    if (board.is_real) {
      check_equal_stops(board, rows, report);
      continue;
    }
    std::map<std::optional<int>, std::vector<const SutRow*>> pools;  // by the pinned core
    for (const auto& [uav, row] : rows)
      if (row.info->board == board.name) pools[row.info->pinned_core].push_back(&row);
    const bool has_free = pools.contains(std::nullopt);
    for (const auto& [core, suts] : pools) {
      if (suts.size() > kMostSuts) {
        report.add("too many SUTs share the board \"" + board.name + "\"");
        continue;
      }
      const auto pinned = static_cast<Wide>(pools.size()) - (has_free ? 1 : 0);
      const Wide cores = core ? 1 : Wide{board.cores} - pinned;
      if (cores < 1) {
        report.add("no core of the board \"" + board.name +
                   "\" is left for SUTs that are not pinned");
        continue;
      }
      PoolCheck pool(cores, suts.size(), report);
      for (const SutRow* row : suts) pool.add(*row);
      pool.run();
    }
  }
}

}  // namespace tether::audit
