#pragma once

#include <vector>

#include <tether/campaign/result.h>

namespace tether::campaign {

/// Of the UAVs whose record has a battery; `tasks`: those of all UAVs.
std::vector<UavEnergy> energy_of(const record::Record& record,
                                 const std::vector<judge::TaskSpan>& tasks);

}  // namespace tether::campaign
