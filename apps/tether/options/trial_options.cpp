#include "options/trial_options.h"

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

campaign::Settings versions_of(const scenario::Campaign& campaign, const ReadingOptions& reading) {
  campaign::Settings versions = {
      {"tether", std::string(version())},
      {"machine", os::describe_machine()},
      {"simulator", fmt::format("{}", fmt::join(runner::simulators(campaign), ", "))}};
  if (reading.tolerant) versions["reading of worlds"] = "tolerant";
  if (reading.missing_models != "error") versions["missing models"] = reading.missing_models;
  return versions;
}

}  // namespace tether::app
