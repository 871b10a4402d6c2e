#include "shared_boards.h"

#include <algorithm>
#include <map>
#include <utility>

#include <tether/base/error.h>

namespace tether::coordinator {
namespace {

void require(bool condition, const char* what) {
  if (!condition) throw Error(ErrorCode::kInternal, std::string("coordinator options: ") + what);
}

}  // namespace

// A core with pinned programs is theirs alone, the others share the rest.
SharedBoards::SharedBoards(const RunOptions& options) : seats_(options.uavs.size()) {
  if (options.policy == sync::SyncPolicy::kFreeRunning) return;
  for (std::size_t board = 0; board < options.boards.size(); ++board) {
    if (options.boards[board].is_real) continue;
    std::vector<std::size_t> free;
    std::map<int, std::vector<std::size_t>> pinned;
    for (std::size_t uav = 0; uav < options.uavs.size(); ++uav) {
      if (options.uavs[uav].board != board) continue;
      const auto& core = options.uavs[uav].pinned_core;
      (core ? pinned[*core] : free).push_back(uav);
      require(!core || (*core >= 0 && *core < options.boards[board].cores), "no such core");
    }
    const int rest = options.boards[board].cores - static_cast<int>(pinned.size());
    require(free.empty() || rest > 0, "every core has pinned programs");
    const bool waits_for_cores =
        free.size() > static_cast<std::size_t>(rest) ||
        std::ranges::any_of(pinned, [](const auto& core) { return core.second.size() > 1; });
    if (!waits_for_cores) continue;
    if (!free.empty()) seat(options, std::move(free), rest);
    for (auto& [core, uavs] : pinned) seat(options, std::move(uavs), 1);
  }
}

void SharedBoards::seat(const RunOptions& options, std::vector<std::size_t> uavs, int cores) {
  require(uavs.size() <= sync::SharedCores::kMostPrograms, "too many programs on a board");
  for (std::size_t i = 0; i < uavs.size(); ++i) {
    const auto& clock = options.uavs[uavs[i]].clock;
    require(clock.has_value(), "the clock on a shared board is needed");
    seats_[uavs[i]] = {.pool = pools_.size(),
                       .program = i,
                       .sends_progress = clock->kind == computer::ClockKind::kCpu};
  }
  sync::SharedCores shared(cores, uavs.size());
  pools_.push_back({std::move(shared), std::move(uavs)});
}

bool SharedBoards::has_request(std::size_t uav) const {
  return shares(uav) && !at(uav).messages.empty() &&
         std::holds_alternative<link::Request>(at(uav).messages.back().message);
}

bool SharedBoards::has_finish(std::size_t uav) const {
  if (!has_request(uav)) return false;
  const auto& request = std::get<link::Request>(at(uav).messages.back().message);
  return std::holds_alternative<link::Finish>(request.body);
}

void SharedBoards::progress(std::size_t uav, Duration work) {
  pools_[at(uav).pool].cores.progress(at(uav).program, work);
}

void SharedBoards::add(std::size_t uav, Stamped message) {
  seats_[uav]->messages.push_back(std::move(message));
  ask(uav);
}

// Annotations wait for the request after them, unless progress tells of the SUT's work meanwhile.
void SharedBoards::ask(std::size_t uav) {
  Seat& seat = *seats_[uav];
  if (seat.has_asked || seat.messages.empty() || !(has_request(uav) || seat.sends_progress)) return;
  pools_[seat.pool].cores.ask(seat.program, seat.messages.front().work);
  seat.has_asked = true;
}

void SharedBoards::resume(std::size_t uav, ExecTime when) {
  pools_[at(uav).pool].cores.resume(at(uav).program, when);
}

void SharedBoards::leave(std::size_t uav) {
  pools_[at(uav).pool].cores.leave(at(uav).program);
  seats_[uav]->messages.clear();
}

ExecTime SharedBoards::bound(std::size_t uav) const {
  return pools_[at(uav).pool].cores.bound(at(uav).program);
}

std::optional<SharedBoards::Sent> SharedBoards::next(std::size_t index, ExecTime until,
                                                     const Used& used) {
  Pool& pool = pools_[index];
  const auto stamp = pool.cores.next(until, [&](const sync::SharedCores::Use& use) {
    used(pool.uavs[use.program], use.from, use.to, use.cores);
  });
  if (!stamp) return std::nullopt;
  const std::size_t sender = pool.uavs[stamp->program];
  Seat& seat = *seats_[sender];
  Sent sent{sender, stamp->at, std::move(seat.messages.front())};
  seat.messages.pop_front();
  seat.has_asked = false;
  if (std::holds_alternative<link::Annotation>(sent.what.message)) {
    pool.cores.go_on(stamp->program);
    ask(sender);
  }
  return sent;
}

}  // namespace tether::coordinator
