#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>
#include <tether/uav/setpoint.h>

/// Sensors that say where a UAV is. Each has what its catalogue says of it (`…Properties`) and what
/// it measures (`…Sample`).
namespace tether::uav {

/// Satellite navigation.
struct NavSatProperties {};
struct NavSatSample {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  SimTime sampled_at;
  std::uint64_t index = 0;       ///< number of this measurement of the sensor
  bool has_fix = false;          ///< without a fix, the numbers below are NaN
  double latitude_deg = kNone;   ///< WGS 84, of the sensor's own origin
  double longitude_deg = kNone;  ///< east of Greenwich
  double altitude_m = kNone;     ///< above the ellipsoid
  Vec3 velocity_ENU_m_s{kNone, kNone, kNone};
  double horizontal_accuracy_m = kNone;  ///< standard deviation along each axis
  double vertical_accuracy_m = kNone;
  double speed_accuracy_m_s = kNone;
};

struct MagnetometerProperties {};
struct MagnetometerSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  Vec3 field_T;  ///< magnetic flux density in S [T]
};

struct BarometerProperties {};
struct BarometerSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  double pressure_Pa = 0.0;
  double altitude_m = 0.0;  ///< of that pressure in the standard atmosphere (ISO 2533)
};

/// What a state estimator gives: an estimate, not the truth.
struct OdometryProperties {};
struct OdometrySample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  Vec3 p_WS;  ///< of the sensor's frame; without a mounting, that is the body's
  Quat q_WS;
  Vec3 v_WS_m_s;             ///< in W
  Vec3 w_WS_rad_s;           ///< in S
  Vec3 position_stddev_m;    ///< along W's axes
  Vec3 attitude_stddev_rad;  ///< about W's axes
  Vec3 velocity_stddev_m_s;  ///< along W's axes
};

/// Most rays of a scan.
inline constexpr std::size_t kMaxScanRays = 1u << 18;

/// Where the rays of a lidar point: rows of one elevation, each with columns of one azimuth, evenly
/// spaced from the first to the last; a single one lies in the middle.
struct ScanProperties {
  int columns = 1;
  int rows = 1;
  double min_azimuth_rad = 0.0;  ///< about S's z, from its x
  double max_azimuth_rad = 0.0;
  double min_elevation_rad = 0.0;  ///< up from S's x-y plane
  double max_elevation_rad = 0.0;
  double min_m = 0.0;
  double max_m = 0.0;
  /// From the first column to the last; all at once: 0. The last one is measured at `sampled_at`,
  /// column c so much earlier: sweep_s·(columns − 1 − c)/(columns − 1).
  double sweep_s = 0.0;
};

/// One scan of a lidar.
struct ScanSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  /// Row by row from the lowest elevation; +inf: nothing within range, −inf: closer than the
  /// minimum (REP-117).
  std::vector<float> ranges_m;
  /// Of each range, how much of the light comes back; 0 where it is not finite. Empty: not known.
  std::vector<float> intensities{};
};

// What a SUT knows of its UAV and the world: the sensors, and the anchors "known in advance with
// some useful properties" (paper, Section III). Positions are not included: the SUT measures them.

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
