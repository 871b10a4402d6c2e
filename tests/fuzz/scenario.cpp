#include "project_folder.h"

#include <cmath>
#include <set>

#include <tether/scenario/scenario.h>

/// Scenario files. Input: the file.
namespace tether::fuzz {
namespace {

void require_whole(const scenario::Condition& condition) {
  require(!condition.name.empty(), "a condition without a name");
  require(std::isfinite(condition.computers.front().clock.factor) &&
              condition.computers.front().clock.factor > 0.0,
          "a bad factor");
  const bool is_free = condition.policy == scenario::Policy::kFreeRunning;
  require(!is_free || condition.real_time_factor > 0.0, "free running without a factor");
}

/// What scenario.h promises.
void require_whole(const scenario::Scenario& scenario) {
  require(!scenario.name.empty() && scenario.file.is_absolute(), "a scenario without a name");
  require(scenario.time_limit > Duration(0) && scenario.step != Duration(0), "a bad limit");
  require(!scenario.uavs.empty() && !scenario.conditions.empty(), "a scenario of nothing");
  std::set<std::string> names;
  for (const scenario::UavSetup& uav : scenario.uavs) {
    require(names.insert(uav.placement.name).second, "two UAVs of one name");
    require(std::filesystem::is_regular_file(uav.placement.model), "a model that is not there");
    require(!uav.sut.command.empty(), "a SUT without a command");
  }
  std::set<std::string> slugs;
  for (const scenario::Condition& condition : scenario.conditions) {
    require(slugs.insert(scenario::slug(condition.name)).second, "two conditions of one folder");
    require_whole(condition);
  }
  for (const auto& file : scenario.files)
    require(file.is_absolute() && std::filesystem::is_regular_file(file),
            "a file that is not there");
  for (const std::uint64_t seed : {1u, 2u}) (void)scenario::world_request(scenario, seed);
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::ProjectFolder folder;
  const auto file = folder.write("input.toml", {data, size});
  if (const auto read = fuzz::read_or_refuse([&] { return scenario::load_scenario(file); }))
    fuzz::require_whole(*read);
  return 0;
}
