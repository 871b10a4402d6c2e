#include "tables/read_computers.h"

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
    Target target = load_target(table.existing_file("file"));
    scenario.files.push_back(target.file);
    computer.clock = target.clock;
    computer.cpu_factor = target.cpu_factor;
    computer.cores = target.cores;
    // Those of a modelled computer are no cores of this machine.
    if (target.clock != Clock::kWall) target.cores = 0;
    computer.target = std::move(target);
  } else {
    constexpr std::array<std::string_view, 3> kOwnClocks = {"wall", "cpu", "scripted"};
    if (!table.has("clock"))
      table.fail("clock", "is missing. Add it, or a 'file' that specifies the clock.");
    computer.clock = static_cast<Clock>(table.choice("clock", kOwnClocks));
    read_computing_time(table, computer.clock, computer.cpu_factor, computer.computing);
  }
  computer.by_hand = table.boolean_or("by_hand", false);
  if (computer.clock == Clock::kWall) {
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

void read_computing_time(const toml::Table& table, Clock clock, double& cpu_factor,
                         Duration& computing) {
  constexpr toml::Range kFactor{.min = 1e-3, .max = 1e4};
  constexpr toml::Range kComputing_ms{.min = 1e-3, .max = 60'000.0};
  if (clock != Clock::kCpu && table.has("cpu_factor"))
    table.fail("cpu_factor",
               "scales CPU time, so it needs clock = \"cpu\". To scale the wall clock, set it in a "
               "target file.");
  cpu_factor = table.number_or("cpu_factor", kFactor, 1.0);
  if (clock == Clock::kScripted)
    computing = table.duration("computing_ms", kComputing_ms);
  else if (table.has("computing_ms"))
    table.fail("computing_ms",
               "replaces the measured computing time, so it needs clock = \"scripted\".");
}

void read_computers(const toml::Table& root, Scenario& scenario) {
  for (const toml::Table& table : root.tables_or_none(
           "target", {"name", "file", "clock", "cpu_factor", "computing_ms", "cores", "by_hand"})) {
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
    table.fail("target", "names a target, but the scenario has no table [[target]]. Add one.");
  Seat seat{.computer = table.choice("target", names)};
  if (table.has("pinned_core")) {
    seat.pinned_core =
        static_cast<int>(table.integer_or("pinned_core", 0, kMostSharedCores - 1, 0));
    const Computer& computer = scenario.computers[seat.computer];
    if (computer.clock == Clock::kWall)
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
    const bool is_scaled_wall = computer.clock == Clock::kWall && computer.cpu_factor != 1.0;
    if (is_scaled_wall || computer.clock == Clock::kCounted || computer.clock == Clock::kScripted)
      table.fail("policy",
                 fmt::format("is \"free_running\", which uses the wall clock, but the clock of "
                             "target \"{}\" is \"{}\". Add a 'clock' for this condition.",
                             computer.name, name(computer.clock)));
  }
}

}  // namespace tether::scenario
