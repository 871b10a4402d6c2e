#include "sdf_rules.h"

#include <map>
#include <numbers>

namespace tether::sim {

namespace {

bool is_positive(double value) {
  return value > 0.0;
}
bool is_not_negative(double value) {
  return value >= 0.0;
}
bool is_fraction(double value) {
  return value >= 0.0 && value <= 1.0;
}
bool is_field_of_view(double value) {
  return value > 0.0 && value < std::numbers::pi;
}
bool is_image_edge(double value) {
  return value >= 1.0 && value <= 4096.0;
}
const ValueRule kPositive{is_positive, "it must be greater than 0"};
const ValueRule kNotNegative{is_not_negative, "it must not be negative"};
const ValueRule kFraction{is_fraction, "it must be between 0 and 1"};
const ValueRule kFieldOfView{is_field_of_view,
                             "it must be between 0 and pi radians, both excluded"};
const ValueRule kImageEdge{is_image_edge, "it must be between 1 and 4096 pixels"};

const std::map<std::string, ValueRule, std::less<>> kRules = {
    {"physics/max_step_size", kPositive},
    {"inertial/mass", kPositive},
    {"inertia/ixx", kPositive},
    {"inertia/iyy", kPositive},
    {"inertia/izz", kPositive},
    {"box/size", kPositive},
    {"cylinder/radius", kPositive},
    {"cylinder/length", kPositive},
    {"sphere/radius", kPositive},
    {"capsule/radius", kPositive},
    {"capsule/length", kPositive},
    {"ellipsoid/radii", kPositive},
    {"plane/size", kPositive},
    {"mesh/scale", kPositive},
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
    {"light/intensity", kNotNegative},
    {"attenuation/constant", kNotNegative},
    {"attenuation/linear", kNotNegative},
    {"attenuation/quadratic", kNotNegative},
    {"spot/outer_angle", kNotNegative},
    {"spot/falloff", kNotNegative},
    {"sensor/update_rate", kNotNegative},
    {"camera/horizontal_fov", kFieldOfView},
    {"image/width", kImageEdge},
    {"image/height", kImageEdge},
    {"clip/near", kPositive},
    {"clip/far", kPositive},
    {"intrinsics/fx", kPositive},
    {"intrinsics/fy", kPositive},
    {"noise/stddev", kNotNegative},
    {"noise/bias_stddev", kNotNegative},
    {"noise/dynamic_bias_stddev", kNotNegative},
    {"noise/dynamic_bias_correlation_time", kNotNegative},
    {"range/min", kNotNegative},
    {"range/max", kPositive},
    {"range/resolution", kNotNegative},
    {"horizontal/samples", kPositive},
    {"vertical/samples", kPositive},
};

}  // namespace

const ValueRule* find_rule(const std::string& parent, const std::string& child) {
  const auto rule = kRules.find(parent + "/" + child);
  return rule == kRules.end() ? nullptr : &rule->second;
}

}  // namespace tether::sim
