#pragma once

#include "sensors/measurement.h"

#include <span>
#include <vector>

#include <tether/uav/math.h>
#include <tether/uav/samples.h>

/// The samples of lidars. Pure.
namespace tether::sim {

/// Where each ray of a scan points: unit vectors in S, column by column from the least azimuth,
/// each column from the lowest elevation.
std::vector<uav::Vec3> rays_of(const ScanModel& scan);

/// Of a column: how many steps before the scan's time its rays are measured. The last column has 0.
std::size_t steps_ago(const ScanModel& scan, int column, Duration step);

/// The largest distance that noise can turn into a reading within the limits [m].
double farthest_read_m(const ScanModel& scan);

/// The sample of a lidar from the true distances along `rays_of` [m] (infinite: no hit), with
/// dropouts, noise, resolution and limits: one bias for the whole scan, white noise for each ray.
/// `intensities`: of what each ray meets; empty: not known.
uav::ScanSample measure_scan(const ScanModel& scan, std::span<const double> distances_m,
                             const MeasurementKey& key, std::span<const float> intensities = {});

}  // namespace tether::sim
