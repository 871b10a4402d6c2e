#include "back_ends.h"
#include "commands/commands.h"
#include "reading/world_options.h"
#include "terminal/print.h"

#include <vector>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/os/child_process.h>
#include <tether/os/interrupt.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::app {

namespace {

struct WorldCheckOptions {
  std::filesystem::path world;
  ReadingOptions reading;
};

/// Reads a world as a run does, and prints what of it is not simulated as written.
int check_world(const WorldCheckOptions& options, const std::stop_token&) {
  // libsdformat takes half a minute for some worlds, and cannot be stopped.
  const os::Interrupt::EndsAtOnce reading;
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  std::vector<Warning> warnings;
  const auto collect = [&](const Warning& warning) { warnings.push_back(warning); };
  sim::World world = sim::WorldStore(sim::FileCache::of_user())
                         .load({.world = shipped.find(scenario::ShippedKind::kWorld, options.world),
                                .uavs = {},
                                .anchors = {},
                                .options = world_options(options.reading, shipped)},
                               collect);
  const std::string file = world.file.string();
  const auto models = world.models.size(), lights = world.lights.size();
  const std::string step =
      fmt::format("step {} ms{}", 1e3 * to_seconds(world.step), sim::set_at(world));
  find_back_end("mujoco").prepare(std::move(world), collect);
  print(fmt::format("{}: can be used ({}, {}, {}); {}", file, counted(models, "model"),
                    counted(lights, "light"), step, as_written_text(warnings)));
  return 0;
}

Options world_check_rows(WorldCheckOptions& o) {
  return concatenated(
      {{{"world", "Name of a shipped world, or a file (SDF)", &o.world, required()}},
       reading_options(o.reading)});
}

}  // namespace

Command world_check_command() {
  return make_command("world check",
                      "Read a world, and print the parts that are not simulated as written",
                      world_check_rows,
                      R"(Exit codes: 0 the world can be used, 2 it cannot, or wrong use.

Examples:
  tether world check room
  tether world check warehouse.sdf --strict)",
                      check_world);
}

}  // namespace tether::app
