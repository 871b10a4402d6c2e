#pragma once

#include "options/common_options.h"

#include <filesystem>
#include <optional>
#include <vector>

#include <tether/shards/engine_flights.h>

namespace tether::app {

/// The engine of the options, with its options set; none: this process flies the trials.
/// @throws Error(kUsage) and Error(kBadFile) if there is no such engine, or a value is not one.
std::optional<shards::Engine> engine_of(const EngineOptions& options);

/// Of --jobs: what was given, or as many shards as the engine has, or 1.
int jobs_of(const EngineOptions& options, const std::optional<shards::Engine>& engine);

/// @throws Error(kUsage) about --engine or --jobs if the trials must not be flown beside others.
void require_parallel_allowed(const scenario::Campaign& campaign,
                              const std::optional<shards::Engine>& engine, int jobs);

/// How trials below `campaign` are flown by the engine.
shards::EngineSetup engine_setup(const shards::Engine& engine, int jobs,
                                 const std::filesystem::path& campaign,
                                 const std::vector<std::filesystem::path>& files);

}  // namespace tether::app
