#include <tether/base/random.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {

sim::WorldRequest world_request(const Scenario& scenario, std::uint64_t seed) {
  sim::WorldRequest request;
  request.world = scenario.world;
  for (const UavSetup& uav : scenario.uavs) {
    KeyedRandom random({seed, random_stream(uav.placement.name, "", "start yaw"), 0});
    request.uavs.push_back(uav.placement);
    request.uavs.back().yaw_rad += uav.yaw_spread_rad * (2.0 * random.uniform() - 1.0);
  }
  request.anchors = scenario.anchors;
  request.anchors_at = scenario.anchors_at;
  request.options = scenario.world_options;
  return request;
}

}  // namespace tether::scenario
