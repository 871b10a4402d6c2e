#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/os/child_process.h>
#include <tether/scenario/scenario.h>

/// What a SUT is started with, wherever it runs.
namespace tether::runner {

/// What a SUT needs to know of its run.
struct SutRun {
  std::string address;  ///< of the coordinator, host:port
  std::string token;
  scenario::Condition condition;
};

/// The SUT's program with its parameters as options: max_frames = 5 becomes --max-frames 5.
std::vector<std::string> command_line(const scenario::Sut& sut);
/// A SUT's command line, and which of its words is its program.
struct SutCommand {
  std::vector<std::string> words;
  std::size_t program = 0;
};
/// The same where that target is: after its launcher, the program in its folder; all of it under
/// tether-exec where the SUT is concurrent. Looks at no file.
SutCommand sut_command(const scenario::Sut& sut, const std::optional<scenario::Target>& target);
/// What joins the SUT of that UAV to the run, as the client library takes it.
os::Environment environment_of(const std::string& uav, const SutRun& run);

/// For a person who starts the SUTs: a command line for each, with its environment.
std::string sut_instructions(const scenario::Scenario& scenario, const SutRun& run);

}  // namespace tether::runner
