#include <tether/base/random.h>
#include <tether/base/units.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

double start_yaw_offset_rad(const UavSetup& uav, std::uint64_t seed) {
  KeyedRandom random({seed, random_stream(uav.placement.name, "", "start yaw"), 0});
  return uav.yaw_spread_rad * (2.0 * random.uniform() - 1.0);
}

}  // namespace

sim::WorldRequest world_request(const Scenario& scenario, std::uint64_t seed) {
  sim::WorldRequest request;
  request.world = scenario.world;
  for (const UavSetup& uav : scenario.uavs) {
    request.uavs.push_back(uav.placement);
    request.uavs.back().yaw_rad += start_yaw_offset_rad(uav, seed);
  }
  request.anchors = scenario.anchors;
  request.anchors_at = scenario.anchors_at;
  request.options = scenario.world_options;
  return request;
}

std::vector<Varied> start_yaws(const Scenario& scenario, std::uint64_t seed) {
  std::vector<Varied> varied;
  for (const UavSetup& uav : scenario.uavs) {
    const std::string& name = uav.placement.name;
    if (uav.yaw_spread_rad == 0.0) continue;
    varied.push_back({name + ".yaw_spread_deg", "the start yaw of " + name,
                      deg_from_rad(start_yaw_offset_rad(uav, seed))});
  }
  return varied;
}

}  // namespace tether::scenario
