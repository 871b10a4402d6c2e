#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/scenario/scenario.h>
#include <tether/sync/shared_cores.h>

// The computers of a fleet, and which SUTs share them.
namespace tether::scenario {
namespace {

[[noreturn]] void fail(const Computer& computer, const std::string& what) {
  throw Error(ErrorCode::kBadFile, computer.at,
              fmt::format("target \"{}\": {}", computer.name, what))
      .about(computer.name);
}

void require_sharable(const Condition& condition, std::size_t index) {
  const Computer& computer = condition.computers[index];
  if (computer.clock.kind == computer::ClockKind::kWall) return;  // nothing is modelled
  std::size_t suts = 0;
  std::set<int> pinned;
  for (const Seat& seat : condition.seats) {
    if (seat.computer != index) continue;
    ++suts;
    if (seat.pinned_core) pinned.insert(*seat.pinned_core);
  }
  if (suts > sync::SharedCores::kMostPrograms)
    fail(computer, fmt::format("{} UAVs name it. At most {} can share a target", suts,
                               sync::SharedCores::kMostPrograms));
  if (!pinned.empty() && *pinned.rbegin() >= computer.cores)
    fail(computer, fmt::format("core {} has pinned programs, but there are {} cores, from 0 on. "
                               "Lower 'pinned_core', or raise 'cores'",
                               *pinned.rbegin(), computer.cores));
  const bool has_free = std::ranges::any_of(condition.seats, [&](const Seat& seat) {
    return seat.computer == index && !seat.pinned_core;
  });
  if (has_free && pinned.size() == static_cast<std::size_t>(computer.cores))
    fail(computer,
         fmt::format("each core has pinned programs (cores = {}), and none is left for the "
                     "UAVs without 'pinned_core'. Raise 'cores', or pin these too",
                     computer.cores));
}

void require_other_addresses(const Condition& condition) {
  std::map<std::string, const Computer*> at;
  for (const Computer& computer : condition.computers) {
    if (!computer.target || !computer.target->ssh) continue;
    const auto [other, is_new] = at.emplace(to_string(*computer.target->ssh), &computer);
    if (!is_new)
      fail(computer, fmt::format("its address is {}, which is also that of \"{}\". Let the UAVs "
                                 "name one target, or correct the address",
                                 other->first, other->second->name));
  }
}

}  // namespace

const Computer& computer_of(const Condition& condition, std::size_t uav) {
  return condition.computers[condition.seats.empty() ? 0 : condition.seats[uav].computer];
}

bool is_shared(const Condition& condition, std::size_t computer) {
  return std::ranges::count(condition.seats, computer, &Seat::computer) > 1;
}

std::vector<RealBoard> real_boards(const Condition& condition, std::size_t uavs) {
  std::vector<RealBoard> boards;
  for (std::size_t i = 0; i < condition.computers.size(); ++i) {
    const Computer& computer = condition.computers[i];
    if (computer.clock.kind != computer::ClockKind::kWall || !is_shared(condition, i)) continue;
    RealBoard& board = boards.emplace_back();
    board.name = computer.name;
    for (std::size_t uav = 0; uav < condition.seats.size(); ++uav)
      if (condition.seats[uav].computer == i) board.uavs.push_back(uav);
  }
  const auto& target = condition.computers.front().target;
  const bool is_one_for_all = condition.seats.empty() && target && target->ssh;
  if (!is_one_for_all || uavs < 2) return boards;
  boards.push_back({target->name, std::vector<std::size_t>(uavs)});
  std::iota(boards.back().uavs.begin(), boards.back().uavs.end(), std::size_t{0});
  return boards;
}

void seat(const Scenario& scenario, Condition& condition, bool shared) {
  condition.computers.clear();
  condition.seats.clear();
  if (shared) condition.computers = scenario.computers;
  for (const UavSetup& uav : scenario.uavs) {
    condition.seats.push_back(*uav.seat);
    if (shared) continue;
    Computer own = scenario.computers[uav.seat->computer];
    own.name += "-" + uav.placement.name;
    condition.computers.push_back(std::move(own));
    condition.seats.back().computer = condition.computers.size() - 1;
  }
  require_other_addresses(condition);
  for (std::size_t i = 0; i < condition.computers.size(); ++i) require_sharable(condition, i);
}

}  // namespace tether::scenario
