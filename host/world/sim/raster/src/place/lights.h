#pragma once

#include "place/layer.h"
#include "place/shadow_map.h"

#include <vector>

namespace tether::raster {

/// Puts the scene's lights into the layer, as its camera sees them. `shadows` has two maps for
/// each light that casts shadows, in their order, or none at all.
void place_lights(const PreparedScene& scene, const std::vector<ShadowMap>& shadows, Layer& layer);

}  // namespace tether::raster
