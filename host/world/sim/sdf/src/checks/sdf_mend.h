#pragma once

#include "files/sdf_source.h"

namespace tether::sim {

/// Mends what would stop libsdformat, and warns of each change: names that occur twice in included
/// files get a number and, if the options are tolerant, impossible inertias become possible ones.
/// @throws Error(kBadFile) at the first inertia that no body can have, if the options are not
/// tolerant.
void mend(const SdfSource& source, const WarningSink& warn);

}  // namespace tether::sim
