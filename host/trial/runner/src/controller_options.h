#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include <tether/coordinator/coordinator.h>
#include <tether/scenario/scenario.h>
#include <tether/sim/simulator.h>

namespace tether::runner {

/// The flight controller of a UAV of the simulator's world.
/// @throws Error(kBadFile), where the scenario has it, if the simulator cannot follow it.
/// `folder` is for its files, if it is a program of its own.
coordinator::ControllerOptions controller_options(const scenario::FlightController& controller,
                                                  const sim::Simulator& simulator, std::size_t uav,
                                                  std::uint64_t seed,
                                                  const std::filesystem::path& folder);

}  // namespace tether::runner
