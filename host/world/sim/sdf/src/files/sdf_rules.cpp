#include "files/sdf_rules.h"

#include <cmath>
#include <map>

namespace tether::sim {

namespace {

/// As kMaxLength_m.
constexpr double kMaxMass_kg = 1e6;

bool is_positive(double value) {
  return value > 0.0;
}
bool is_not_negative(double value) {
  return value >= 0.0;
}
bool is_length(double value) {
  return value > 0.0 && value <= kMaxLength_m;
}
bool is_coordinate(double value) {
  return std::abs(value) <= kMaxLength_m;
}

constexpr const char* kPositiveText = "it must be greater than 0";
constexpr const char* kNotNegativeText = "it must not be negative";

const ValueRule kPositive{is_positive, kPositiveText};
const ValueRule kSeconds{is_positive, kPositiveText, "seconds"};
const ValueRule kFocalLength{[](double v) { return v > 1e-4 && v < 1e6; },
                             "it must be greater than 0.0001 and less than 1000000 pixels",
                             "pixels"};
const ValueRule kPrincipalPoint{[](double v) { return std::abs(v) < 3e4; },
                                "it must be within 30000 pixels of the image's corner", "pixels"};
const ValueRule kDistortion{[](double v) { return std::abs(v) < 1e3; },
                            "it must be greater than -1000 and less than 1000"};
const ValueRule kIntensity{[](double v) { return v >= 0.0 && v <= 1e6; },
                           "it must be at least 0 and at most 1000000"};
const ValueRule kConeAngle{[](double v) { return v >= 0.0 && v <= 3.1416; },
                           "it must be at least 0 and at most 3.1416: a cone is no wider than a "
                           "half space",
                           "radians"};
const ValueRule kInertia{is_positive, kPositiveText, "kg m^2"};
const ValueRule kNotNegative{is_not_negative, kNotNegativeText};
const ValueRule kRate{is_not_negative, kNotNegativeText, "hertz"};
const ValueRule kFraction{[](double v) { return v >= 0.0 && v <= 1.0; },
                          "it must be between 0 and 1"};
const ValueRule kLength{is_length, "it must be greater than 0 and at most 100000 m", "metres"};
const ValueRule kNearPlane{[](double v) { return v >= 1e-4 && v <= kMaxLength_m; },
                           "it must be at least 0.0001 and at most 100000 m", "metres"};
const ValueRule kDistance{[](double v) { return v >= 0.0 && v <= kMaxLength_m; },
                          "it must be at least 0 and at most 100000 m", "metres"};
const ValueRule kGround{[](double v) { return v > 0.0 && v <= 10.0 * kMaxLength_m; },
                        "it must be greater than 0 and at most 1000000 m", "metres"};
const ValueRule kScale{is_length, "it must be greater than 0 and at most 100000"};
const ValueRule kMass{[](double v) { return v > 0.0 && v <= kMaxMass_kg; },
                      "it must be greater than 0 and at most 1000000 kg", "kilograms"};
const ValueRule kFieldOfView{[](double v) { return v >= 0.005 && v <= 3.14; },
                             "it must be at least 0.005 and at most 3.14 radians", "radians"};
const ValueRule kImageEdge{[](double v) { return v >= 1.0 && v <= 4096.0; },
                           "it must be at least 1 and at most 4096 pixels", "pixels"};
const ValueRule kPose{is_coordinate, "it must be within 100000 m of its frame's origin",
                      "metres and radians", 3};
const ValueRule kLatitude{[](double v) { return std::abs(v) <= 90.0; },
                          "it must be between -90 and 90", "degrees"};
const ValueRule kLongitude{[](double v) { return std::abs(v) <= 360.0; },
                           "it must be between -360 and 360", "degrees"};
/// Where the standard atmosphere of the barometer holds, a flight's height included.
const ValueRule kElevation{[](double v) { return v >= -1000.0 && v <= 10000.0; },
                           "it must be between -1000 and 10000 m", "metres"};
const ValueRule kPosition{is_coordinate, "it must be within 100000 m of its frame's origin",
                          "metres"};

const std::map<std::string, ValueRule, std::less<>> kRules = {
    {"physics/max_step_size", kSeconds},
    {"inertial/mass", kMass},
    {"inertia/ixx", kInertia},
    {"inertia/iyy", kInertia},
    {"inertia/izz", kInertia},
    {"box/size", kLength},
    {"cylinder/radius", kLength},
    {"cylinder/length", kLength},
    {"sphere/radius", kLength},
    {"capsule/radius", kLength},
    {"capsule/length", kLength},
    {"ellipsoid/radii", kLength},
    {"plane/size", kGround},
    {"mesh/scale", kScale},
    {"ode/mu", kNotNegative},
    {"visual/transparency", kFraction},
    {"scene/ambient", kFraction},
    {"scene/background", kFraction},
    {"material/ambient", kFraction},
    {"material/diffuse", kFraction},
    {"material/specular", kFraction},
    {"material/emissive", kFraction},
    {"light/diffuse", kFraction},
    {"light/specular", kFraction},
    {"light/intensity", kIntensity},
    {"attenuation/constant", kNotNegative},
    {"attenuation/linear", kNotNegative},
    {"attenuation/quadratic", kNotNegative},
    {"attenuation/range", kDistance},
    {"spot/inner_angle", kConeAngle},
    {"spot/outer_angle", kConeAngle},
    {"spot/falloff", kNotNegative},
    {"sensor/update_rate", kRate},
    {"camera/horizontal_fov", kFieldOfView},
    {"image/width", kImageEdge},
    {"image/height", kImageEdge},
    {"clip/near", kNearPlane},
    {"clip/far", kLength},
    {"intrinsics/fx", kFocalLength},
    {"intrinsics/fy", kFocalLength},
    {"intrinsics/cx", kPrincipalPoint},
    {"intrinsics/cy", kPrincipalPoint},
    {"distortion/k1", kDistortion},
    {"distortion/k2", kDistortion},
    {"distortion/k3", kDistortion},
    {"distortion/p1", kDistortion},
    {"distortion/p2", kDistortion},
    {"noise/stddev", kNotNegative},
    {"noise/bias_stddev", kNotNegative},
    {"noise/dynamic_bias_stddev", kNotNegative},
    {"noise/dynamic_bias_correlation_time", kNotNegative},
    {"range/min", kDistance},
    {"range/max", kLength},
    {"range/resolution", kDistance},
    {"spherical_coordinates/latitude_deg", kLatitude},
    {"spherical_coordinates/longitude_deg", kLongitude},
    {"spherical_coordinates/elevation", kElevation},
    {"air_pressure/reference_altitude", kElevation},
    {"rotor/position_m", kPosition},
    {"horizontal/samples", kPositive},
    {"vertical/samples", kPositive},
};

}  // namespace

const ValueRule* find_rule(const std::string& parent, const std::string& child) {
  if (child == "pose") return &kPose;
  const auto rule = kRules.find(parent + "/" + child);
  return rule == kRules.end() ? nullptr : &rule->second;
}

}  // namespace tether::sim
