// Converts SDF's cameras, IMUs and lidars, with their noise. A lidar becomes a rangefinder whose x
// axis points to the middle of the scan.

#include "convert/sdf_convert.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tether::sim {

namespace {

Noise read_noise(const SdfSource& source, const sdf::Noise& noise, const WarningSink& warn) {
  if (noise.Type() == sdf::NoiseType::NONE) return {};
  if (noise.Type() == sdf::NoiseType::GAUSSIAN_QUANTIZED) {
    warn_at(source, noise.Element(), Consequence::kBehavesDifferent,
            "is quantized, which is not simulated; treated as gaussian", warn);
  }
  return {noise.Mean(),
          noise.StdDev(),
          noise.BiasMean(),
          noise.BiasStdDev(),
          noise.DynamicBiasStdDev(),
          noise.DynamicBiasCorrelationTime()};
}

uav::CameraModel read_intrinsics(const sdf::Camera& camera) {
  uav::CameraModel model = uav::CameraModel::from_horizontal_fov(
      static_cast<int>(camera.ImageWidth()), static_cast<int>(camera.ImageHeight()),
      camera.HorizontalFov().Radian());
  if (camera.HasLensIntrinsics()) {
    model.fx_px = camera.LensIntrinsicsFx();
    model.fy_px = camera.LensIntrinsicsFy();
    model.cx_px = camera.LensIntrinsicsCx();
    model.cy_px = camera.LensIntrinsicsCy();
  }
  model.k1 = camera.DistortionK1();
  model.k2 = camera.DistortionK2();
  model.k3 = camera.DistortionK3();
  model.p1 = camera.DistortionP1();
  model.p2 = camera.DistortionP2();
  return model;
}

/// None for a sensor that is no camera.
std::optional<uav::CameraKind> camera_kind(const sdf::Sensor& sensor) {
  switch (sensor.Type()) {
    case sdf::SensorType::CAMERA:
      return uav::CameraKind::kColor;
    case sdf::SensorType::DEPTH_CAMERA:
      return uav::CameraKind::kDepth;
    case sdf::SensorType::RGBD_CAMERA:
      return uav::CameraKind::kRgbd;
    case sdf::SensorType::SEGMENTATION_CAMERA:
      return uav::CameraKind::kSegmentation;
    default:
      return std::nullopt;
  }
}

/// <depth_camera> has limits of its own, or those of the camera.
void read_depth_limits(const SdfSource& source, const sdf::Camera& camera, CameraModel& model) {
  model.depth_min_m = camera.HasDepthNearClip() ? camera.DepthNearClip() : camera.NearClip();
  model.depth_max_m = camera.HasDepthFarClip() ? camera.DepthFarClip() : camera.FarClip();
  if (model.depth_min_m >= model.depth_max_m) {
    refuse(source, camera.Element()->FindElement("depth_camera"),
           "has a near plane that is not in front of its far plane");
  }
  if (model.kind == uav::CameraKind::kDepth) model.far_m = model.depth_max_m;
  model.depth_max_m = std::min(model.depth_max_m, model.far_m);
}

CameraModel read_camera(const SdfSource& source, const sdf::Camera& camera, uav::CameraKind kind,
                        const WarningSink& warn) {
  if (camera.NearClip() >= camera.FarClip()) {
    refuse(source, camera.Element()->FindElement("clip"),
           "has a near plane that is not in front of its far plane");
  }
  const sdf::PixelFormatType format = camera.PixelFormat();
  if (uav::has_color(kind) && format != sdf::PixelFormatType::RGB_INT8 &&
      format != sdf::PixelFormatType::UNKNOWN_PIXEL_FORMAT) {
    warn_at(source, camera.Element(), Effect(Consequence::kLooksDifferent, true),
            "has the image format " + camera.PixelFormatStr() + "; images are R8G8B8", warn);
  }
  CameraModel model{read_intrinsics(camera), camera.NearClip(), camera.FarClip(),
                    read_noise(source, camera.ImageNoise(), warn)};
  model.kind = kind;
  if (uav::has_depth(kind)) read_depth_limits(source, camera, model);
  const Noise& noise = model.pixel_noise;
  if (kind == uav::CameraKind::kSegmentation && (noise.stddev != 0.0 || noise.mean != 0.0)) {
    warn_at(source, camera.ImageNoise().Element(), Consequence::kBehavesDifferent,
            "is not added: labels have no noise", warn);
  }
  return model;
}

ImuModel read_imu(const SdfSource& source, const sdf::Imu& imu, const WarningSink& warn) {
  const auto noise = [&](const sdf::Noise& n) { return read_noise(source, n, warn); };
  return {{noise(imu.AngularVelocityXNoise()), noise(imu.AngularVelocityYNoise()),
           noise(imu.AngularVelocityZNoise())},
          {noise(imu.LinearAccelerationXNoise()), noise(imu.LinearAccelerationYNoise()),
           noise(imu.LinearAccelerationZNoise())}};
}

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
RangeModel read_range(const SdfSource& source, const sdf::Lidar& lidar, const WarningSink& warn) {
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

std::optional<Sensor> read_sensor(const SdfSource& source, const sdf::Sensor& sensor,
                                  const uav::Pose& X_BL, const WarningSink& warn) {
  Sensor result{sensor.Name(),
                X_BL * resolved_pose(source, sensor),
                sensor.UpdateRate(),
                {},
                source.where(sensor.Element())};
  const auto kind = camera_kind(sensor);
  if (const sdf::Camera* camera = sensor.CameraSensor(); camera != nullptr && kind) {
    result.X_BS = result.X_BS * to_pose(camera->RawPose());
    result.model = read_camera(source, *camera, *kind, warn);
    return result;
  }
  if (const sdf::Imu* imu = sensor.ImuSensor()) {
    result.model = read_imu(source, *imu, warn);
    return result;
  }
  if (const sdf::Lidar* lidar = sensor.LidarSensor()) {
    result.X_BS.q = result.X_BS.q * scan_middle(*lidar);
    result.model = read_range(source, *lidar, warn);
    return result;
  }
  return std::nullopt;
}

}  // namespace tether::sim
