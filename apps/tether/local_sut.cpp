#include "local_sut.h"

#include <fmt/format.h>

#include <tether/base/error.h>

namespace tether::app {

namespace {

/// Where a SUT may leave files of its own: the whole path.
std::string files_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(ErrorCode::kSetup, folder.string() + ": " + error.message());
  return std::filesystem::absolute(folder).lexically_normal().string();
}

}  // namespace

void require_sut_programs(const scenario::Scenario& scenario, const scenario::Condition&) {
  for (const scenario::UavSetup& uav : scenario.uavs) try {
      find_program(uav.sut.command.front());
    } catch (const Error& e) {
      throw Error(ErrorCode::kBadFile, {scenario.file.string()},
                  fmt::format("the SUT of UAV \"{}\": {}", uav.placement.name, e.what()));
    }
}

ChildCommand local_sut(const scenario::UavSetup& uav, const SutRun& run,
                       const std::filesystem::path& out, const std::filesystem::path& log) {
  auto environment = environment_of(uav.placement.name, run);
  environment.emplace_back("TETHER_OUT", files_folder(out));
  return {.arguments = command_line(uav.sut), .environment = std::move(environment), .log = log};
}

}  // namespace tether::app
