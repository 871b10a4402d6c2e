#pragma once

#include <cstddef>
#include <string>
#include <variant>

#include <tether/sim/simulator.h>
#include <tether/sim/world.h>

/// Small worlds for the tests, built without a file.
namespace tether::sim::testing {

Visual box_visual(const uav::Vec3& size_m, const uav::Vec3& rgb);
Collision box_collision(const uav::Vec3& size_m);
/// A model of one link with one box, as visual and collision.
Model box_model(const std::string& name, const uav::Vec3& p_WM, const uav::Vec3& size_m,
                const uav::Vec3& rgb, bool is_static = true);

uav::CameraModel camera_intrinsics(int width_px, int height_px);
Sensor camera_sensor(const std::string& name, int width_px, int height_px);

/// A Hummingbird with a body of 0.4 × 0.4 × 0.1 m, carrying "camera" (160×120, 0.2 m ahead of the
/// centre), "imu" and "range" (both at the centre).
Uav test_uav(const std::string& name, const uav::Vec3& p_WB);

/// A lit floor at z = 0 with "alpha" hovering at (0, 0, 1).
World test_world();
/// The same with a battery of three cells, 12.6 V when it is full.
World world_with_battery(double charge, double resistance_ohm);

/// Measures a sensor of UAV 0 now; `S` is its sample type.
template <class S>
S measure_now(Simulator& simulator, std::size_t sensor, std::uint64_t index = 0,
              std::size_t uav = 0) {
  Snapshot snapshot;
  simulator.capture(snapshot);
  return std::get<S>(simulator.measure(snapshot, uav, sensor, index));
}

inline constexpr std::size_t kCamera = 0;
inline constexpr std::size_t kImu = 1;
inline constexpr std::size_t kRange = 2;

}  // namespace tether::sim::testing
