#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tether/scenario/scenario.h>

namespace tether::runner {

/// What starts a SUT on this host.
struct LocalSutCommand {
  std::vector<std::string> words;
  std::vector<std::filesystem::path> programs;  ///< what is run: launcher, SUT
};

/// A program in the target's folder, or behind a launcher, need not be one of this machine's.
/// @throws Error(kSetup) naming the program that cannot be found.
LocalSutCommand local_sut_command(const scenario::Sut& sut,
                                  const std::optional<scenario::Target>& target);

/// The CPUs for the SUT of that index, each on `cores` of those allowed, the last ones first: the
/// first are the busiest. Empty: all (`cores` is 0), or there are too few.
std::vector<int> cpus_for(const std::vector<int>& allowed, int cores, std::size_t index);

}  // namespace tether::runner
