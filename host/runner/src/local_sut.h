#pragma once

#include "sut_environment.h"

#include <filesystem>
#include <vector>

#include <tether/os/child_process.h>
#include <tether/scenario/scenario.h>

/// SUTs as processes of this machine.
namespace tether::runner {

/// What starts the SUTs of a condition here, each program once.
/// @throws Error(kBadFile) naming the scenario, the UAV and the program that cannot be found here.
std::vector<std::filesystem::path> sut_programs(const scenario::Scenario& scenario,
                                                const scenario::Condition& condition);

/// @throws Error(kBadFile) as sut_programs, and where this machine has too few cores.
void require_sut_programs(const scenario::Scenario& scenario, const scenario::Condition& condition);

/// How to start the SUT of `uav` here, the run's SUT of that index. It may leave files in `out`;
/// its output goes to `log`.
/// @throws Error(kSetup) when `out` cannot be made.
os::ChildCommand local_sut(const scenario::UavSetup& uav, const SutRun& run, std::size_t index,
                           const std::filesystem::path& out, const std::filesystem::path& log);

}  // namespace tether::runner
