#include "local_sut.h"

#include "local_program.h"

#include <algorithm>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/child_process.h>
#include <tether/os/machine.h>

namespace tether::runner {

namespace {

/// Where a SUT may leave files of its own: the whole path.
std::string files_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(ErrorCode::kSetup, folder.string() + ": " + error.message());
  return std::filesystem::absolute(folder).lexically_normal().string();
}

void require_cores(const scenario::Scenario& scenario, const scenario::Condition& condition) {
  const std::size_t allowed = os::allowed_cpus().size(), suts = scenario.uavs.size();
  const int cores = condition.target ? condition.target->cores : 0;
  if (static_cast<std::size_t>(cores) * suts <= allowed) return;
  throw Error(ErrorCode::kBadFile, {condition.target->file.string()},
              fmt::format("'cores' is {}, {}and this process may use {} of this machine's", cores,
                          suts > 1 ? fmt::format("for each of {} SUTs, ", suts) : "", allowed));
}

}  // namespace

std::vector<std::filesystem::path> sut_programs(const scenario::Scenario& scenario,
                                                const scenario::Condition& condition) {
  std::vector<std::filesystem::path> programs;
  for (const scenario::UavSetup& uav : scenario.uavs) try {
      for (const auto& program : local_sut_command(uav.sut, condition.target).programs)
        if (std::find(programs.begin(), programs.end(), program) == programs.end())
          programs.push_back(program);
    } catch (const Error& e) {
      throw Error(ErrorCode::kBadFile, {scenario.file.string()},
                  fmt::format("the SUT of UAV \"{}\": {}", uav.placement.name, e.what()));
    }
  return programs;
}

void require_sut_programs(const scenario::Scenario& scenario,
                          const scenario::Condition& condition) {
  sut_programs(scenario, condition);
  require_cores(scenario, condition);
}

os::ChildCommand local_sut(const scenario::UavSetup& uav, const SutRun& run, std::size_t index,
                           const std::filesystem::path& out, const std::filesystem::path& log) {
  const auto& target = run.condition.target;
  auto environment = environment_of(uav.placement.name, run);
  environment.emplace_back("TETHER_OUT", files_folder(out));
  return {.arguments = local_sut_command(uav.sut, target).words,
          .environment = std::move(environment),
          .log = log,
          .cpus = cpus_for(os::allowed_cpus(), target ? target->cores : 0, index)};
}

}  // namespace tether::runner
