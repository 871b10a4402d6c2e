#include "replayed_time.h"

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/timing/stage_table.h>

namespace tether::runner {
namespace {

timing::Timing read(const std::filesystem::path& file, const scenario::Scenario& scenario) {
  timing::Timing timing = timing::read_timing(file);
  if (timing.scenario != scenario.name)
    throw Error(ErrorCode::kBadFile, {file.string()},
                fmt::format("is of the scenario \"{}\", not of \"{}\". Record this scenario, and "
                            "write a file of its own.",
                            timing.scenario, scenario.name))
        .about(timing.scenario);
  return timing;
}

}  // namespace

ReplayedTime replayed_time(const TrialSpec& spec) {
  ReplayedTime time;
  if (!spec.condition.replay) return time;
  const scenario::ReplaySource& source = *spec.condition.replay;
  const timing::Timing timing = read(source.timing, spec.scenario);
  // In the order of the scenario's enumerators.
  timing::ReplaySetting setting{.mode = static_cast<timing::Mode>(source.mode),
                                .unknown = static_cast<timing::UnknownStages>(source.unknown),
                                .counted = {},
                                .slowdown = spec.condition.slowdown};
  if (!source.counted.empty()) {
    setting.counted = read(source.counted, spec.scenario);
    if (setting.counted->clock != "counted")
      throw Error(ErrorCode::kBadFile, {source.counted.string()},
                  fmt::format("is of runs under the clock \"{}\", but 'counted' needs \"counted\". "
                              "Fly under a counted target, and write its timing.",
                              setting.counted->clock))
          .about(setting.counted->clock);
  }
  try {
    for (const scenario::UavSetup& uav : spec.scenario.uavs)
      time.replays.emplace_back(timing, setting, uav.placement.name, spec.seed);
  } catch (const Error& e) {
    throw Error(e.code(), {source.timing.string()}, e.what()).about(e.subject());
  }
  time.from = {.timing = source.timing.filename().string(),
               .mode = std::string(name(setting.mode)),
               .recorded_at = timing.recorded_at,
               .board = timing.board,
               .build_id = timing.build_id};
  if (setting.mode != timing::Mode::kExact)
    time.warnings = timing::warnings(timing::stage_rows(timing));
  for (std::string& warning : time.warnings)
    warning = fmt::format("{}: {}", source.timing.string(), warning);
  return time;
}

}  // namespace tether::runner
