#include "sensors/sdf_sensor.h"

#include <algorithm>

namespace tether::sim {
namespace {

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

CameraModel read_model(const SdfSource& source, const sdf::Camera& camera, uav::CameraKind kind,
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

}  // namespace

bool read_camera(const SensorReading& reading) {
  const auto kind = camera_kind(reading.from);
  const sdf::Camera* camera = reading.from.CameraSensor();
  if (camera == nullptr || !kind) return false;
  reading.sensor.X_BS = reading.sensor.X_BS * to_pose(camera->RawPose());
  reading.sensor.model = read_model(reading.source, *camera, *kind, reading.warn);
  return true;
}

}  // namespace tether::sim
