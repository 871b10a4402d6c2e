#include "options/trial_options.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/os/machine.h>
#include <tether/runner/campaign_trials.h>

namespace tether::app {

void require_ports(const scenario::Campaign& campaign, int jobs) {
  const char* master = std::getenv("GAZEBO_MASTER_URI");
  if (jobs == 1 || !master || !*master || !runner::simulators(campaign).contains("gazebo")) return;
  throw Error(ErrorCode::kUsage,
              fmt::format("--jobs {}: each parallel trial needs a port, but GAZEBO_MASTER_URI "
                          "selects one ({}). Unset it, or use --jobs 1",
                          jobs, master))
      .about("GAZEBO_MASTER_URI");
}

campaign::Settings versions_of(const scenario::Campaign& campaign, const ReadingOptions& reading,
                               bool by_engine) {
  campaign::Settings versions = {
      {"tether", std::string(version())},
      {"simulator", fmt::format("{}", fmt::join(runner::simulators(campaign), ", "))}};
  const auto is_measured = [](const scenario::CampaignScenario& entry) {
    return std::ranges::any_of(entry.conditions, [&](const std::string& name) {
      return !campaign::repeats(*entry.scenario.find_condition(name));
    });
  };
  if (std::ranges::any_of(campaign.scenarios, is_measured))
    versions["machine"] = by_engine ? "chosen by an engine" : os::describe_machine();
  if (reading.strict) versions["reading of worlds"] = "strict";
  if (reading.tolerant) versions["reading of UAVs"] = "tolerant";
  return versions;
}

}  // namespace tether::app
