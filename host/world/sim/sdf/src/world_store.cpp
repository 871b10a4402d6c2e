#include "convert/sdf_convert.h"
#include "files/lookups.h"
#include "files/model_path.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <tether/sim/world_parts.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::sim {
namespace {

bool is_same_but_for_poses(const WorldRequest& a, const WorldRequest& b) {
  return a.world == b.world && a.anchors == b.anchors && a.options == b.options &&
         std::ranges::equal(a.uavs, b.uavs, [](const UavPlacement& c, const UavPlacement& d) {
           return c.name == d.name && c.model == d.model;
         });
}

/// What a world depends on besides the files that are looked up: the start poses are set later.
std::string key_of(const WorldRequest& request) {
  WorldRequest placed_anywhere = request;
  for (UavPlacement& uav : placed_anywhere.uavs) uav.p_WB = {}, uav.yaw_rad = 0.0;
  ByteWriter key;
  std::error_code ignored;
  const std::string what = "world";
  const std::filesystem::path folder = std::filesystem::current_path(ignored);
  key(what, identity_of_program(), ModelPath::environment(), folder, placed_anywhere);
  return key.take();
}

/// @return whether the cache has a world that reading its files would give now as well
bool read_kept(const FileCache& cache, const std::string& key, World& world,
               std::vector<Warning>& warnings) try {
  const FileCache::Parts kept = cache.find(key);
  if (kept == nullptr) return false;
  ByteReader in(kept->front());
  Lookups::Answers answers;
  in(answers);
  if (!are_current(answers)) return false;
  World kept_world;
  std::vector<Warning> kept_warnings;
  in(kept_world, kept_warnings);
  world = std::move(kept_world);
  warnings = std::move(kept_warnings);
  return true;
} catch (const std::out_of_range&) {  // of another layout
  return false;
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
  stored_.push_back(make(request));
  return stored_.back();
}

WorldStore::Stored WorldStore::make(const WorldRequest& request) const {
  Stored made{request, {}, {}};
  const std::string key = cache_ ? key_of(request) : "";
  if (cache_ && read_kept(*cache_, key, made.world, made.warnings)) return made;
  const Lookups lookups(tick_);
  made.world =
      load_world(request, [&](const Warning& warning) { made.warnings.push_back(warning); });
  if (!cache_ || !lookups.are_certain()) return made;
  ByteWriter out;
  out(lookups.answers(), made.world, made.warnings);
  cache_->keep(key, out.take());
  return made;
}

}  // namespace tether::sim
