#include "convert/sdf_convert.h"

#include <algorithm>

#include <tether/sim_sdf/load_world.h>

namespace tether::sim {
namespace {

bool is_same_but_for_poses(const WorldRequest& a, const WorldRequest& b) {
  return a.world == b.world && a.anchors == b.anchors && a.options == b.options &&
         std::ranges::equal(a.uavs, b.uavs, [](const UavPlacement& c, const UavPlacement& d) {
           return c.name == d.name && c.model == d.model;
         });
}

}  // namespace

World WorldStore::load(const WorldRequest& request, const WarningSink& warn) {
  const Stored& stored = find(request);
  for (const Warning& warning : stored.warnings)
    if (warn) warn(warning);
  World world = stored.world;
  for (std::size_t i = 0; i < request.uavs.size(); ++i)
    world.uavs[i].X_WB = start_pose(request.uavs[i]);
  return world;
}

const WorldStore::Stored& WorldStore::find(const WorldRequest& request) {
  const auto known = std::ranges::find_if(stored_, [&](const Stored& stored) {
    return is_same_but_for_poses(stored.request, request);
  });
  if (known != stored_.end()) return *known;
  Stored read{request, {}, {}};
  read.world =
      load_world(request, [&](const Warning& warning) { read.warnings.push_back(warning); });
  stored_.push_back(std::move(read));
  return stored_.back();
}

}  // namespace tether::sim
