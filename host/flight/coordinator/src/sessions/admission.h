#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tether/coordinator/coordinator.h>
#include <tether/link/messages.h>

namespace tether::coordinator {

/// Checks a Hello: the index of the UAV that its SUT controls, or the refusal. `taken[i]`: UAV i
/// has its SUT. Checks the version, then the token, then the UAV, so that a client without the
/// token learns nothing about the run.
std::variant<std::size_t, link::Refusal> admit(const link::Hello& hello, const std::string& token,
                                               const std::vector<std::string>& uavs,
                                               const std::vector<bool>& taken);

/// What is wrong with a SUT's clock: it is not that of its condition, or a concurrent SUT cannot
/// use it. None if nothing is.
std::optional<std::string> clock_fault(const link::Hello& hello,
                                       const std::optional<computer::Clock>& wanted);

/// Why the program cannot be given the time of `replay`: it is another build. None if it can.
std::optional<std::string> build_fault(const link::Hello& hello, const GivenTime* replay);

}  // namespace tether::coordinator
