// A lidar with one ray is a rangefinder; with more, it gives scans.

#include "sensors/sdf_sensor.h"

#include <cstdint>
#include <string>

namespace tether::sim {
namespace {

uav::ScanProperties read_rays(const SdfSource& source, const sdf::Lidar& lidar) {
  const std::uint64_t count =
      std::uint64_t{lidar.HorizontalScanSamples()} * lidar.VerticalScanSamples();
  if (count > uav::kMaxScanRays) {
    refuse(source, lidar.Element(),
           "has " + std::to_string(count) + " rays; at most " + std::to_string(uav::kMaxScanRays) +
               " are simulated; reduce <samples>");
  }
  return {.columns = static_cast<int>(lidar.HorizontalScanSamples()),
          .rows = static_cast<int>(lidar.VerticalScanSamples()),
          .min_azimuth_rad = lidar.HorizontalScanMinAngle().Radian(),
          .max_azimuth_rad = lidar.HorizontalScanMaxAngle().Radian(),
          .min_elevation_rad = lidar.VerticalScanMinAngle().Radian(),
          .max_elevation_rad = lidar.VerticalScanMaxAngle().Radian(),
          .min_m = lidar.RangeMin(),
          .max_m = lidar.RangeMax()};
}

/// A rangefinder's x axis points along its ray, so that what a profile puts in its place (a cone,
/// another mounting) points there, too.
void read_single_ray(const SensorReading& reading, const sdf::Lidar& lidar) {
  const double azimuth_rad =
      0.5 * (lidar.HorizontalScanMinAngle().Radian() + lidar.HorizontalScanMaxAngle().Radian());
  const double elevation_rad =
      0.5 * (lidar.VerticalScanMinAngle().Radian() + lidar.VerticalScanMaxAngle().Radian());
  reading.sensor.X_BS.q = reading.sensor.X_BS.q * uav::from_rpy(0.0, -elevation_rad, azimuth_rad);
  reading.sensor.model = RangeModel{lidar.RangeMin(), lidar.RangeMax(), lidar.RangeResolution(),
                                    read_noise(reading.source, lidar.LidarNoise(), reading.warn)};
}

}  // namespace

bool read_range(const SensorReading& reading) {
  const sdf::Lidar* lidar = reading.from.LidarSensor();
  if (lidar == nullptr) return false;
  if (lidar->RangeMin() >= lidar->RangeMax()) {
    refuse(reading.source, lidar->Element()->FindElement("range"),
           "has a minimum that is not below its maximum");
  }
  if (lidar->HorizontalScanMinAngle() > lidar->HorizontalScanMaxAngle() ||
      lidar->VerticalScanMinAngle() > lidar->VerticalScanMaxAngle()) {
    refuse(reading.source, lidar->Element()->FindElement("scan"),
           "has a min_angle that is above its max_angle");
  }
  if (lidar->HorizontalScanSamples() <= 1 && lidar->VerticalScanSamples() <= 1) {
    read_single_ray(reading, *lidar);
  } else {
    ScanModel scan{read_rays(reading.source, *lidar), lidar->RangeResolution(), {}};
    scan.noise = read_noise(reading.source, lidar->LidarNoise(), reading.warn);
    reading.sensor.model = scan;
  }
  return true;
}

}  // namespace tether::sim
