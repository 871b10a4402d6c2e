// A lidar becomes a rangefinder whose x axis points to the middle of the scan.

#include "sensors/sdf_sensor.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tether::sim {
namespace {

/// One axis of a scan: its angles, evenly spaced from the first to the last; a single one lies in
/// the middle.
std::vector<double> scan_angles(unsigned samples, double min_rad, double max_rad) {
  if (samples == 1) return {0.5 * (min_rad + max_rad)};
  std::vector<double> angles(samples);
  for (unsigned i = 0; i < samples; ++i) {
    angles[i] = min_rad + (max_rad - min_rad) * i / (samples - 1);
  }
  return angles;
}

bool is_single_ray(const sdf::Lidar& lidar) {
  return lidar.HorizontalScanSamples() <= 1 && lidar.VerticalScanSamples() <= 1;
}

/// Where a ray of these angles points.
uav::Quat ray_attitude(double azimuth_rad, double elevation_rad) {
  return uav::from_rpy(0.0, -elevation_rad, azimuth_rad);
}

/// Where the middle of a scan points. The sensor's x axis is turned there, so that what a profile
/// puts in place of the scan (a cone, another mounting) points where the scan did.
uav::Quat scan_middle(const sdf::Lidar& lidar) {
  return ray_attitude(
      0.5 * (lidar.HorizontalScanMinAngle().Radian() + lidar.HorizontalScanMaxAngle().Radian()),
      0.5 * (lidar.VerticalScanMinAngle().Radian() + lidar.VerticalScanMaxAngle().Radian()));
}

constexpr std::uint64_t kMaxRays = 1024;

/// The rays of a scan, in the frame that `scan_middle` turned.
std::vector<uav::Vec3> read_rays(const SdfSource& source, const sdf::Lidar& lidar) {
  if (is_single_ray(lidar)) return {{1.0, 0.0, 0.0}};
  const std::uint64_t count =
      std::uint64_t{lidar.HorizontalScanSamples()} * lidar.VerticalScanSamples();
  if (count > kMaxRays) {
    refuse(source, lidar.Element(),
           "has " + std::to_string(count) + " rays; at most " + std::to_string(kMaxRays) +
               " are simulated; reduce <samples>");
  }
  const uav::Quat to_middle = uav::inverse(scan_middle(lidar));
  std::vector<uav::Vec3> rays;
  for (const double elevation_rad :
       scan_angles(lidar.VerticalScanSamples(), lidar.VerticalScanMinAngle().Radian(),
                   lidar.VerticalScanMaxAngle().Radian())) {
    for (const double azimuth_rad :
         scan_angles(lidar.HorizontalScanSamples(), lidar.HorizontalScanMinAngle().Radian(),
                     lidar.HorizontalScanMaxAngle().Radian())) {
      const uav::Quat attitude = to_middle * ray_attitude(azimuth_rad, elevation_rad);
      rays.push_back(uav::rotate(attitude, {1.0, 0.0, 0.0}));
    }
  }
  return rays;
}

/// A rangefinder: the nearest hit of all the rays of the scan.
RangeModel read_model(const SdfSource& source, const sdf::Lidar& lidar, const WarningSink& warn) {
  if (lidar.RangeMin() >= lidar.RangeMax()) {
    refuse(source, lidar.Element()->FindElement("range"),
           "has a minimum that is not below its maximum");
  }
  if (!is_single_ray(lidar)) {
    warn_at(source, lidar.Element(), Consequence::kBehavesDifferent,
            "is a scan, of which only the nearest distance is measured", warn);
  }
  return {lidar.RangeMin(), lidar.RangeMax(), lidar.RangeResolution(),
          read_noise(source, lidar.LidarNoise(), warn), read_rays(source, lidar)};
}

}  // namespace

bool read_range(const SensorReading& reading) {
  const sdf::Lidar* lidar = reading.from.LidarSensor();
  if (lidar == nullptr) return false;
  reading.sensor.X_BS.q = reading.sensor.X_BS.q * scan_middle(*lidar);
  reading.sensor.model = read_model(reading.source, *lidar, reading.warn);
  return true;
}

}  // namespace tether::sim
