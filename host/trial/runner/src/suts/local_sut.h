#pragma once

#include "suts/sut_environment.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tether/os/child_process.h>
#include <tether/scenario/scenario.h>

/// SUTs as processes of this machine.
namespace tether::runner {

struct LocalSutCommand {
  std::vector<std::string> words;
  std::vector<std::filesystem::path> programs;  ///< that it runs: tether-exec, launcher, SUT
};

/// The command that starts a SUT on this machine. The program of a target with a launcher need not
/// be one of this machine.
/// @throws Error(kSetup) if a program does not exist; Error(kBadFile) at the target's file, about
/// the key, if that is its launcher.
LocalSutCommand local_sut_command(const scenario::Sut& sut,
                                  const std::optional<scenario::Target>& target,
                                  const std::string& group = "");

/// The CPUs for a SUT: `cores` of those allowed, the last ones first, because the first ones are
/// the busiest; so many are taken by others. Empty: all CPUs (`cores` is 0), or there are too few.
std::vector<int> cpus_for(const std::vector<int>& allowed, int cores, std::size_t taken);

/// All programs that start the SUTs of a condition here, each once; last the plugin that counts.
/// Those of SUTs that the user starts are among them only if they are counted. `by_user`: the user
/// starts all SUTs.
/// @throws Error(kBadFile) at the scenario's file, about the UAV whose program does not exist, or
/// as local_sut_command; Error(kSetup) without the plugin.
std::vector<std::filesystem::path> sut_programs(const scenario::Scenario& scenario,
                                                const scenario::Condition& condition,
                                                bool by_user = false);

/// Asks the programs: an emulator whether it has the target's CPU model, and the shipped program
/// whether it understands its options and its mission; other programs are not asked. Takes some
/// tens of milliseconds for each SUT, so once before several trials. `by_user` as above.
/// @throws Error(kBadFile) at the target's file, about `cpu_model`; at the scenario's, about the
/// UAV. @pre sut_programs does not throw.
void try_suts(const scenario::Scenario& scenario, const scenario::Condition& condition,
              bool by_user = false);

/// Checks that the SUTs can run here. `by_user` as above. @throws Error(kBadFile) as sut_programs;
/// at the target's file, about `cores`, if this machine has too few.
void require_sut_programs(const scenario::Scenario& scenario, const scenario::Condition& condition,
                          bool by_user = false);

/// How to start the SUT of `uav`, the run's SUT with that index. Its TETHER_OUT is `out`, and its
/// output goes to `log`. @throws Error(kSetup) if `out` cannot be created.
os::ChildCommand local_sut(const scenario::UavSetup& uav, const SutRun& run, std::size_t index,
                           const std::filesystem::path& out, const std::filesystem::path& log);
/// How to start the process of a group, which gets the environment and the CPUs of its SUTs.
os::ChildCommand local_group(const scenario::Scenario& scenario, const SutRun& run,
                             const SutGroup& group, const std::filesystem::path& log);

}  // namespace tether::runner
