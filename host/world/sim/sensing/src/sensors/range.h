#pragma once

#include "sensors/measurement.h"

#include <span>

#include <tether/uav/samples.h>

namespace tether::sim {

/// The largest distance that noise can turn into a reading within the limits [m].
double farthest_read_m(const RangeModel& range);

/// The sample of a rangefinder from the true distances along its rays [m] (infinite: no hit): the
/// nearest of them, with dropouts, noise, resolution and limits. Pure.
uav::RangeSample measure_range(const RangeModel& range, std::span<const double> distances_m,
                               const MeasurementKey& key);

}  // namespace tether::sim
