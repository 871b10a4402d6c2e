#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>

/// What a SUT knows of its UAV and the world: the sensors, and the anchors "known in advance with
/// some useful properties" (paper, Section III). Positions are not included: the SUT measures them.
namespace tether::uav {

enum class SensorKind { kCamera, kImu, kRange };
std::string_view name(SensorKind kind);

struct CameraProperties {
  CameraModel model;
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
  std::variant<CameraProperties, ImuProperties, RangeProperties> properties;

  SensorKind kind() const { return static_cast<SensorKind>(properties.index()); }
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

  /// nullptr if there is none of that name.
  const SensorDescription* find_sensor(std::string_view sensor) const;
  const Anchor* find_anchor(std::string_view anchor) const;
};

}  // namespace tether::uav
