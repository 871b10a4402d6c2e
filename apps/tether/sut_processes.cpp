#include "sut_processes.h"

#include "local_sut.h"

#include <fstream>

#include <fmt/format.h>

namespace tether::app {

namespace {

// How long a SUT that has finished may take to leave.
constexpr Duration kLeaveLimit = std::chrono::seconds(2);
// How long a lost SUT's process may take to end once its connection has.
constexpr Duration kEndLimit = std::chrono::milliseconds(200);

}  // namespace

void SutProcesses::start(const scenario::Scenario& scenario, const SutRun& run,
                         const std::filesystem::path& folder) {
  for (const scenario::UavSetup& uav : scenario.uavs) {
    const std::string& name = uav.placement.name;
    const std::filesystem::path log = folder / fmt::format("sut-{}.log", name);
    const std::filesystem::path out = scenario.uavs.size() > 1 ? folder / name : folder;
    suts_.push_back(
        {name, log, std::make_unique<ChildProcess>(local_sut(uav, run, suts_.size(), out, log))});
  }
}

std::optional<std::string> SutProcesses::early_end() {
  for (Sut& sut : suts_)
    if (sut.process->poll()) return describe_end(sut);
  return std::nullopt;
}

std::string SutProcesses::post_mortem() {
  std::string text;
  for (Sut& sut : suts_)
    if (sut.process->wait(kEndLimit)) text += "; " + describe_end(sut);
  return text;
}

void SutProcesses::let_leave() {
  for (Sut& sut : suts_) sut.process->wait(kLeaveLimit);
}

std::string SutProcesses::describe_end(Sut& sut) {
  std::ifstream log(sut.log);
  std::string last;
  for (std::string line; std::getline(log, line);)
    if (!line.empty()) last = line;
  return fmt::format(
      "the SUT of UAV \"{}\" ({}) {}{}", sut.uav, sut.process->program(),
      sut.process->poll()->description,
      last.empty() ? "" : fmt::format("; its last words in {}: {}", sut.log.string(), last));
}

}  // namespace tether::app
