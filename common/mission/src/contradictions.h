#pragma once

#include <tether/mission/mission.h>

namespace tether::mission {

/// @throws Error(kBadFile) at the later of two clauses that cannot both be met: one needs a
/// quantity in a range at some time, in which the other forbids it.
void require_no_contradictions(const Mission& mission);

}  // namespace tether::mission
