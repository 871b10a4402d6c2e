#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tether/coordinator/coordinator.h>
#include <tether/link/messages.h>

namespace tether::coordinator {

/// Who may join, decided from the Hello alone: the UAV's index, or why not. `taken[i]` says that
/// UAV i has its SUT. Checks version, then token, then UAV, so that a stranger learns nothing about
/// the run.
std::variant<std::size_t, link::Refusal> admit(const link::Hello& hello, const std::string& token,
                                               const std::vector<std::string>& uavs,
                                               const std::vector<bool>& taken);

/// Why a SUT's clock is not the one that its condition asks for, or none that a concurrent SUT can
/// have; none if it is, or is scripted or (of a serial SUT) unstamped.
std::optional<std::string> clock_fault(const link::Hello& hello,
                                       const std::optional<ClockSetting>& wanted);

}  // namespace tether::coordinator
