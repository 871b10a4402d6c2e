#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>
#include <tether/uav/sensors/navigation.h>
#include <tether/uav/sensors/scan.h>
#include <tether/uav/setpoint.h>

/// What a SUT knows of its UAV and the world: the sensors, and the anchors "known in advance with
/// some useful properties" (paper, Section III). Positions are not included: the SUT measures them.
namespace tether::uav {

/// Longest name in a catalogue [bytes].
inline constexpr std::size_t kMaxNameBytes = 256;
/// Most sensors, and most anchors, of a catalogue.
inline constexpr std::size_t kMaxCatalogueEntries = 1024;
/// Most models whose names the properties of a segmentation camera have: its labels are 16 bits.
inline constexpr std::size_t kMaxModels = 65535;

enum class SensorKind {
  kCamera,
  kImu,
  kRange,
  kNavSat,
  kMagnetometer,
  kBarometer,
  kOdometry,
  kScan,
  kJointState
};
std::string_view name(SensorKind kind);

/// What a camera measures in each pixel.
enum class CameraKind { kColor, kDepth, kRgbd, kSegmentation };
std::string_view name(CameraKind kind);
/// The arrays of CameraSample that a camera of this kind fills.
constexpr bool has_color(CameraKind kind) {
  return kind == CameraKind::kColor || kind == CameraKind::kRgbd;
}
constexpr bool has_depth(CameraKind kind) {
  return kind == CameraKind::kDepth || kind == CameraKind::kRgbd;
}

struct CameraProperties {
  CameraModel model;
  CameraKind kind = CameraKind::kColor;
  double min_m = 0.0;  ///< of depths; 0 for a camera without
  double max_m = 0.0;
  std::vector<std::string> models{};  ///< of kSegmentation: those that labels 1, 2, … show
};
struct ImuProperties {};
struct RangeProperties {
  double min_m = 0.0;
  double max_m = 0.0;
};

struct SensorDescription {
  std::string name;  ///< unique within the UAV
  Pose X_BS;  ///< mounting; a camera's S is body-style (x forward), its optical frame C follows by
              ///< q_body_from_optical()
  double rate_hz = 0.0;  ///< of a periodic sensor; 0 for one that measures on demand
  /// In the order of SensorKind.
  std::variant<CameraProperties, ImuProperties, RangeProperties, NavSatProperties,
               MagnetometerProperties, BarometerProperties, OdometryProperties, ScanProperties,
               JointStateProperties>
      properties;
  /// Its samples have the stamps of a clock that is not exactly the SUT's: they can be later than
  /// the read.
  bool own_stamps = false;
  /// It is behind so many joints of the UAV: X_BS is its mounting while they are at 0.
  std::uint32_t joints = 0;

  SensorKind kind() const { return static_cast<SensorKind>(properties.index()); }
  /// Of a camera; else none.
  std::optional<CameraKind> camera_kind() const;
  /// "camera", "depth camera", "imu", …
  std::string_view kind_name() const;
};

enum class AnchorShape { kBox, kCylinder, kSphere };
std::string_view name(AnchorShape shape);

struct Anchor {
  std::string name;
  AnchorShape shape = AnchorShape::kBox;
  Vec3 size_m;     ///< box: edge lengths along its own axes; cylinder: diameter, diameter, length;
                   ///< sphere: diameter ×3
  Vec3 color_rgb;  ///< each 0..1, sRGB
};

struct Catalogue {
  std::string uav;
  std::vector<SensorDescription> sensors;
  std::vector<Anchor> anchors;
  double battery_capacity_C = 0.0;  ///< [A s]; 0: its battery cannot be read
  FlightLimits limits{};            ///< of what it can be commanded

  /// nullptr if there is none of that name.
  const SensorDescription* find_sensor(std::string_view sensor) const;
  const Anchor* find_anchor(std::string_view anchor) const;
};

}  // namespace tether::uav
