#pragma once

#include <cstdint>
#include <vector>

#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>
#include <tether/uav/samples.h>

namespace tether::vision::testing {

/// An upright box in the world.
struct SceneBox {
  uav::Vec3 p_W;  ///< centre [m]
  double yaw_rad = 0.0;
  uav::Vec3 size_m;
  uav::Vec3 color_rgb;  ///< 0..1
};

/// Boxes in front of a grey wall above a brown floor, cast ray by ray through a camera model: slow,
/// small, and with a truth that is known exactly.
struct SyntheticScene {
  std::vector<SceneBox> boxes;
  double noise_stddev = 0.0;  ///< of each colour value, 0..255
  std::uint64_t seed = 1;     ///< of the noise, together with the image's index

  /// What a camera (optical frame C) at `X_WC` sees. Edges are smooth: 2 × 2 rays a pixel.
  uav::CameraSample render(const uav::CameraModel& camera, const uav::Pose& X_WC,
                           std::uint64_t index = 0) const;
};

/// Pose of a camera that stands at `p_W` and looks level along `yaw_rad`.
uav::Pose level_camera(const uav::Vec3& p_W, double yaw_rad);

}  // namespace tether::vision::testing
