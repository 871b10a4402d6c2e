#include "tables/read_computers.h"

#include "files/named_file.h"
#include "files/scenario_keys.h"
#include "tables/read_clock.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace tether::scenario {
namespace {

constexpr std::int64_t kMostSharedCores = 1024;

Computer read_computer(const toml::Table& table, Scenario& scenario) {
  Computer computer;
  computer.name = table.identifier("name");
  computer.at = table.where("name");
  if (table.has("file")) {
    for (const char* key : {"clock", "cpu_factor", "computing_ms"})
      if (table.has(key))
        table.fail(key, "is specified by the target's file. Remove this key, or 'file'.");
    Target target = load_target(named_file(table, "file", ShippedKind::kTarget));
    scenario.files.push_back(target.file);
    computer.clock = target.clock;
    computer.cores = target.cores;
    // Those of a modelled computer are no cores of this machine.
    if (target.clock.kind != computer::ClockKind::kWall) target.cores = 0;
    computer.target = std::move(target);
  } else {
    using enum computer::ClockKind;
    if (!table.has("clock"))
      table.fail("clock", "is missing. Add it, or a 'file' that specifies the clock.");
    computer.clock = read_clock(table, {kWall, kCpu, kScripted});
  }
  computer.by_hand = table.boolean_or("by_hand", false);
  if (computer.clock.kind == computer::ClockKind::kWall) {
    if (table.has("cores"))
      table.fail("cores",
                 "is that of a modelled computer, but the clock is \"wall\". Remove this key; to "
                 "bind programs on this machine to fewer cores, set 'cores' in a target file.");
    computer.cores = 0;
  } else {
    computer.cores = static_cast<int>(
        table.integer_or("cores", 1, kMostSharedCores, std::max(1, computer.cores)));
  }
  return computer;
}

}  // namespace

void read_computers(const toml::Table& root, Scenario& scenario) {
  if (!root.has("target")) return;
  for (const toml::Table& table : root.tables("target", kComputerKeys)) {
    Computer computer = read_computer(table, scenario);
    if (std::ranges::count(scenario.computers, computer.name, &Computer::name) > 0)
      table.fail(
          "name",
          fmt::format("is \"{}\", which is also the name of another target. Names must be unique.",
                      computer.name));
    scenario.computers.push_back(std::move(computer));
  }
}

std::optional<Seat> read_seat(const toml::Table& table, const Scenario& scenario) {
  if (!table.has("target")) {
    if (table.has("pinned_core"))
      table.fail("pinned_core", "is a core of the UAV's 'target', which is missing.");
    return std::nullopt;
  }
  std::vector<std::string_view> names;
  for (const Computer& computer : scenario.computers) names.push_back(computer.name);
  if (names.empty())
    table.fail("target",
               fmt::format("is \"{}\", but the scenario has no table [[target]]. Add one.",
                           table.text("target")));
  Seat seat{.computer = table.choice("target", names)};
  if (table.has("pinned_core")) {
    seat.pinned_core =
        static_cast<int>(table.integer_or("pinned_core", 0, kMostSharedCores - 1, 0));
    const Computer& computer = scenario.computers[seat.computer];
    if (computer.clock.kind == computer::ClockKind::kWall)
      table.fail(
          "pinned_core",
          fmt::format("needs a modelled computer, but the clock of target \"{}\" is \"wall\". "
                      "Remove this key, or start the program with a launcher such as "
                      "taskset in a target file.",
                      computer.name));
    if (*seat.pinned_core >= computer.cores)
      table.fail("pinned_core",
                 fmt::format("is {}, but the last core of target \"{}\" has number {}.",
                             *seat.pinned_core, computer.name, computer.cores - 1));
  }
  return seat;
}

void require_users(const Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.computers.size(); ++i)
    if (std::ranges::none_of(scenario.uavs, [i](const UavSetup& uav) {
          return uav.seat && uav.seat->computer == i;
        }))
      throw Error(ErrorCode::kBadFile, scenario.computers[i].at,
                  fmt::format("no UAV runs on the target \"{}\". Name it with 'target' in a "
                              "[[uav]], or remove this table",
                              scenario.computers[i].name))
          .about(scenario.computers[i].name);
}

// Under this condition, each SUT runs on the [[target]] that its UAV names.
void read_seats(const toml::Table& table, Condition& condition, const Scenario& scenario) {
  for (const char* key : {"cpu_factor", "computing_ms"})
    if (table.has(key))
      table.fail(key, "is specified by the tables [[target]]. Remove this key, or add 'clock'.");
  for (const UavSetup& uav : scenario.uavs)
    if (!uav.seat)
      table.fail("clock",
                 fmt::format("is missing, and UAV \"{}\" names no 'target'. Add one of them.",
                             uav.placement.name));
  seat(scenario, condition, table.boolean_or("shared", true));
  for (const Computer& computer : condition.computers) {
    if (condition.policy != Policy::kFreeRunning) continue;
    if (computer.clock.needs_barrier())
      table.fail("policy",
                 fmt::format("is \"free_running\", which uses the wall clock, but the clock of "
                             "target \"{}\" is \"{}\". Add a 'clock' for this condition.",
                             computer.name, computer::name(computer.clock.kind)));
  }
}

}  // namespace tether::scenario
