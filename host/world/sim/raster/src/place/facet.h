#pragma once

#include "place/layer.h"

#include <array>

namespace tether::raster {

/// The depth of a triangle with these corners in C. It is most exact near the middle of `seen`.
DepthPlane depth_of(const std::array<std::array<float, 3>, 3>& corners,
                    const Projection& projection, const FixedRect& seen);

/// The surface of a layer's triangle.
Facet make_facet(const PreparedScene& scene, const Layer& layer, const Coverage& coverage);

}  // namespace tether::raster
