#include "options/engine_option.h"

#include "options/refuse_option.h"
#include "options/trial_options.h"
#include "reading/file_kind.h"
#include "terminal/say.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include <tether/os/child_process.h>
#include <tether/runner/trial_request.h>
#include <tether/scenario/shipped_files.h>

namespace tether::app {

std::optional<shards::Engine> engine_of(const EngineOptions& options) {
  if (options.engine.empty()) {
    if (!options.settings.empty())
      refuse_option("--engine-option", "has no effect without --engine.");
    return std::nullopt;
  }
  const std::filesystem::path file = scenario::ShippedFiles::of_program(os::own_file())
                                         .find(scenario::ShippedKind::kEngine, options.engine);
  require_kind(file, FileKind::kEngine);
  shards::Engine engine = shards::load_engine(file);
  shards::set_options(engine, options.settings);
  return engine;
}

int jobs_of(const EngineOptions& options, const std::optional<shards::Engine>& engine) {
  return options.jobs.value_or(engine ? static_cast<int>(engine->shards) : 1);
}

void require_parallel_allowed(const scenario::Campaign& campaign,
                              const std::optional<shards::Engine>& engine, int jobs) {
  if (!engine) {
    campaign::require_jobs_allowed(campaign, jobs);
    return require_ports(campaign, jobs);
  }
  constexpr int kBesideAnother = 2;  // on one machine
  try {
    campaign::require_jobs_allowed(campaign, std::max(kBesideAnother, jobs));
    require_ports(campaign, kBesideAnother);
  } catch (const Error& error) {
    refuse_option("--engine",
                  fmt::format("flies trials beside each other, which these do not allow. Fly "
                              "without --engine, or one part at a time with --shard. ({})",
                              error.what()));
  }
}

shards::EngineSetup engine_setup(const shards::Engine& engine, int jobs,
                                 const std::filesystem::path& campaign,
                                 const std::vector<std::filesystem::path>& files) {
  return {
      .engine = engine,
      .shards = static_cast<std::size_t>(jobs),
      .campaign = campaign,
      .files = files,
      .shard_command = os::shell_word(os::own_file().string()) + " campaign --listed",
      .request = [](const campaign::TrialPlan& plan) { return to_json(runner::request_of(plan)); },
      .tell = [](const std::string& line) { say("{}\n", line); }};
}

}  // namespace tether::app
