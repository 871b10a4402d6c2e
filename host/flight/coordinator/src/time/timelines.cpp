#include "time/timelines.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include <tether/base/error.h>
#include <tether/radio/medium.h>

namespace tether::coordinator {
namespace {

void require(bool condition, const char* what) {
  if (!condition) throw Error(ErrorCode::kInternal, std::string("coordinator options: ") + what);
}

}  // namespace

Timelines::Timelines(const RunOptions& options, StepGrid grid)
    : policy_(options.policy),
      grid_(grid),
      least_delay_(radio::least_delay(options.radio)),
      barrier_(grid),
      pool_of_(options.uavs.size()),
      is_in_group_(options.uavs.size()) {
  for (std::size_t uav = 0; uav < options.uavs.size(); ++uav)
    timelines_.push_back(std::make_unique<Timeline>(uav));
  if (policy_ == sync::SyncPolicy::kConservativeBarrier)
    for (std::size_t board = 0; board < options.boards.size(); ++board) divide(options, board);
  else
    require(options.real_time_factor > 0.0, "free running needs a real-time factor");
}

// On a modelled board, a core with pinned programs is theirs alone, and the others share the rest.
// If no program ever waits for a core, its own time is the board's.
void Timelines::divide(const RunOptions& options, std::size_t board) {
  std::vector<std::size_t> free;
  std::map<int, std::vector<std::size_t>> pinned;
  for (std::size_t uav = 0; uav < options.uavs.size(); ++uav) {
    if (options.uavs[uav].board != board) continue;
    is_in_group_[uav] = options.boards[board].is_real;
    if (is_in_group_[uav]) continue;
    const auto& core = options.uavs[uav].pinned_core;
    (core ? pinned[*core] : free).push_back(uav);
    require(!core || (*core >= 0 && *core < options.boards[board].cores), "no such core");
  }
  const int rest = options.boards[board].cores - static_cast<int>(pinned.size());
  require(free.empty() || rest > 0, "every core has pinned programs");
  const bool waits_for_cores =
      std::cmp_greater(free.size(), rest) ||
      std::ranges::any_of(pinned, [](const auto& core) { return core.second.size() > 1; });
  if (!waits_for_cores) return;
  if (!free.empty()) add_pool(options, free, rest);
  for (const auto& [core, uavs] : pinned) add_pool(options, uavs, 1);
}

void Timelines::add_pool(const RunOptions& options, const std::vector<std::size_t>& uavs,
                         int cores) {
  require(uavs.size() <= sync::SharedCores::kMostPrograms, "too many programs on a board");
  for (const std::size_t uav : uavs) {
    require(options.uavs[uav].clock.has_value(), "the clock on a shared board is needed");
    pool_of_[uav] = pools_.size();
  }
  pools_.emplace_back(cores, uavs.size());
}

std::optional<std::string> Timelines::fault_of(std::size_t uav, const link::Hello& hello) const {
  if (hello.concurrent || !is_in_group_[uav]) return std::nullopt;
  return "the SUT shares its board with others, so it must be stopped together with them: start "
         "all of them under tether-exec --group";
}

void Timelines::begin(std::size_t uav, const link::Hello& hello, int cores, WallTime now) {
  const SutStart sut{uav, hello, cores, now, barrier_, least_delay_};
  std::unique_ptr<Timeline>& time = timelines_[uav];
  if (policy_ == sync::SyncPolicy::kFreeRunning) {
    time = std::make_unique<FreeTime>(free_calls_, grid_, uav, hello.concurrent);
  } else if (hello.concurrent) {
    time = make_concurrent_time(sut, is_in_group_[uav]);
  } else if (const auto pool = pool_of_[uav]) {
    time = pools_[*pool].add(sut);
  } else if (hello.clock.kind == computer::ClockKind::kUnstamped) {
    time = make_unstamped_time(sut);
    timed_.push_back(time.get());
  } else {
    time = std::make_unique<OwnTime>(sut);
  }
}

std::optional<sync::TimeAdvanceGrant> Timelines::release(
    SimTime st, const std::optional<sync::SutTime>& message) {
  if (free_calls_.empty() || free_calls_.begin()->due > st) return barrier_.release(st, message);
  const FreeCall call = *free_calls_.begin();
  free_calls_.erase(free_calls_.begin());
  return sync::TimeAdvanceGrant{call.uav, same_instant(st), st, call.id};
}

bool Timelines::repeats() const {
  return std::ranges::all_of(timelines_, [](const auto& time) { return time->facts().repeats; });
}

void Timelines::read_timers(WallTime now) {
  for (Timeline* timeline : timed_) timeline->read_timer(now);
}

bool Timelines::settle(const std::function<std::optional<sync::SutTime>()>& next_message,
                       const Pool::Used& used, const std::function<void(Sent)>& handle) {
  bool has_changed = false;
  for (Pool& pool : pools_) {
    while (auto sent = pool.next(undisturbed_until(pool, next_message()), used)) {
      has_changed = true;
      handle(std::move(*sent));
    }
    has_changed = pool.raise_bounds() || has_changed;
  }
  return has_changed;
}

// Until when no message from outside can end the wait of a SUT of the pool: when the next one may
// arrive, or be sent and arrive. What the pool's own SUTs send is known at their stamps, beyond
// which its time line does not go on before that is handled.
ExecTime Timelines::undisturbed_until(const Pool& pool,
                                      const std::optional<sync::SutTime>& message) const {
  ExecTime until = ExecTime::max();
  if (!pool.awaits_message()) return until;
  if (message) until = message->at;
  for (std::size_t uav = 0; uav < timelines_.size(); ++uav)
    if (!timelines_[uav]->has_left() && !pool.has(uav))
      until = std::min(until, timelines_[uav]->bound() + least_delay_);
  return until;
}

}  // namespace tether::coordinator
