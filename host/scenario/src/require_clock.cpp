#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {

void require_clock(const Scenario& scenario, const Condition& condition) {
  if (condition.clock == Clock::kWall) return;
  for (const UavSetup& uav : scenario.uavs) {
    if (!uav.sut.concurrent) continue;
    throw Error(ErrorCode::kBadFile, {scenario.file.string()},
                fmt::format("the SUT of UAV \"{}\" is concurrent, and condition \"{}\" measures by "
                            "the clock \"{}\": several threads have one time line by clock = "
                            "\"wall\" only",
                            uav.placement.name, condition.name, name(condition.clock)));
  }
}

}  // namespace tether::scenario
