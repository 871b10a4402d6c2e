#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {

void require_clock(const Scenario& scenario, const Condition& condition) {
  if (condition.clock == Clock::kWall) return;
  for (const UavSetup& uav : scenario.uavs) {
    if (!uav.sut.concurrent) continue;
    throw Error(
        ErrorCode::kBadFile, {scenario.file.string()},
        fmt::format("the SUT of UAV \"{}\" is concurrent, but condition \"{}\" has the clock "
                    "\"{}\". Several threads share a time line only with clock = \"wall\".",
                    uav.placement.name, condition.name, name(condition.clock)))
        .about(uav.placement.name);
  }
}

}  // namespace tether::scenario
